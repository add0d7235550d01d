/** Jogging: by increments, and for as long as a button is held. */
import type { Page } from "@playwright/test";
import type { HistoryRows } from "../../web/src/api/client";
import type { ConsolePage } from "./console_page";
import { expect, test } from "./fixtures";

const title = "Probe rotation";

test.use({ clock: "slow" });

const larger = (page: Page) =>
  page.getByRole("button", { name: `Hold to jog ${title} towards larger positions`, exact: true });

/** For which the app keeps a jog that is not renewed, and what its 30 looks a second add: in ms of the kernel's clock. */
const LEASE_MS = 200;
const LOOK_MS = 34;
/** Ticks that one row of the history tells together. */
const ROW_TICKS = 33;

/** With the pedal held, presses the button that jogs the axis upwards, and keeps it down. */
async function holdJog(robot: ConsolePage, page: Page): Promise<void> {
  await robot.unlockRobot();
  await robot.axis(title).enable();
  await robot.pressPedal();
  await larger(page).hover();
  await page.mouse.down();
}

test("a step proposes a move by the chosen increment, from where the axis is to go", async ({ robot }) => {
  const axis = robot.axis(title);
  await robot.unlockRobot();
  await axis.enable();
  await axis.row.getByRole("combobox", { name: `Increment of ${title}` }).selectOption("5");
  await robot.button(`Step ${title} by +5 degrees`).click();
  await expect(robot.proposal(1)).toContainText("approved");
  await robot.button(`Step ${title} by +5 degrees`).click();
  await expect(robot.proposal(2)).toContainText(/to (9\.9|10\.0)/);
  await expect(robot.proposal(1)).toContainText("aborted");
});

test("a held button jogs while the pedal is held, and letting it go ends the jog", async ({
  robot,
  page,
}) => {
  const axis = robot.axis(title);
  await holdJog(robot, page);
  await expect.poll(() => axis.counts()).toBeGreaterThan(20);
  await page.mouse.up();
  await expect(robot.proposal(1)).toContainText("aborted");
  const stoppedAt = await axis.restingCounts();
  await robot.expectMode("MOTION");
  expect(Math.abs((await axis.restingCounts()) - stoppedAt)).toBeLessThanOrEqual(1);
});

/** What a browser tells a page whose tab is no longer in front. */
function leaveTab(page: Page): Promise<void> {
  return page.evaluate(() => {
    Object.defineProperty(document, "hidden", { configurable: true, get: () => true });
    document.dispatchEvent(new Event("visibilitychange"));
  });
}

/** The browser takes the pointer away from the button, as it does for a gesture of its own; the next move tells the page. */
async function losePointer(page: Page): Promise<void> {
  await larger(page).evaluate((button) => {
    for (let pointer = 0; pointer < 10; pointer++)
      if (button.hasPointerCapture(pointer)) button.releasePointerCapture(pointer);
  });
  await page.mouse.move(5, 400);
}

for (const [way, loss] of [
  ["another window takes the focus", (page) => page.evaluate(() => window.dispatchEvent(new Event("blur")))],
  ["another tab takes its place", leaveTab],
  ["the pointer is lost", losePointer],
  ["nobody answers its renewals", (page) => page.route("**/api/jog/*", () => undefined)],
  ["STOP is pressed by key", (page) => page.keyboard.press("Escape")],
] as const satisfies readonly [string, (page: Page) => Promise<unknown>][]) {
  test(`a held jog ends when ${way}, though button and pedal stay down`, async ({ robot, page }) => {
    const axis = robot.axis(title);
    await holdJog(robot, page);
    await expect.poll(() => axis.counts()).toBeGreaterThan(10);
    await loss(page);
    await expect(robot.proposal(1)).toContainText("aborted");
    const stoppedAt = await axis.restingCounts();
    expect(Math.abs((await axis.restingCounts()) - stoppedAt)).toBeLessThanOrEqual(1);
    await expect(robot.proposal(2)).toHaveCount(0);
  });
}

test("a held jog ends within its lease of the kernel's ticks when the network is cut", async ({
  robot,
  other,
  stack,
  page,
}) => {
  await other.logIn("admin", stack.password);
  await holdJog(robot, page);
  await expect.poll(() => robot.axis(title).counts()).toBeGreaterThan(10);
  await page.context().setOffline(true);
  const cutAt = await other.page.evaluate(
    async () => (await (await fetch("/api/status")).json()) as { tick: number },
  );
  await expect(other.proposal(1)).toContainText("aborted");
  const drivenUntil = await lastDrivenTick(other.page);
  expect(drivenUntil).toBeGreaterThan(0);
  expect(drivenUntil).toBeLessThanOrEqual(cutAt.tick + LEASE_MS + LOOK_MS + ROW_TICKS);
});

/** The last tick of the last row of the history in which the axis was driven; the kernel's tick takes a millisecond. */
async function lastDrivenTick(page: Page): Promise<number> {
  const drivenNow = () =>
    page.evaluate(async (name) => {
      const motors = (await (await fetch("/api/motors")).json()) as { title: string; slot: number }[];
      const slot = motors.find(({ title }) => title === name)?.slot;
      const rows = (await (await fetch("/api/history?after=0")).json()) as HistoryRows;
      const drive = rows.axes.find((axis) => axis.slot === slot)?.drive;
      const driven = rows.last_tick.filter((_, row) => (drive?.greatest[row] ?? 0) !== 0);
      return { driven: driven.at(-1) ?? 0, newest: rows.last_tick.at(-1) ?? 0 };
    }, title);
  // The row in which the drive ended is complete once a later one has come.
  await expect
    .poll(async () => {
      const { driven, newest } = await drivenNow();
      return newest - driven;
    })
    .toBeGreaterThan(ROW_TICKS);
  return (await drivenNow()).driven;
}

test("a key that is held jogs, and who is not in control cannot", async ({ robot, page }) => {
  const axis = robot.axis(title);
  await robot.unlockRobot();
  await axis.enable();
  await robot.pressPedal();
  await larger(page).focus();
  await page.keyboard.down("Space");
  await expect.poll(() => axis.counts()).toBeGreaterThan(10);
  await page.keyboard.up("Space");
  await expect(robot.proposal(1)).toContainText("aborted");
  await robot.button("Release control").click();
  await expect(larger(page)).toBeDisabled();
});

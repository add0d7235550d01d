/** Jogging: by increments, and for as long as a button is held. */
import type { Page } from "@playwright/test";
import type { ConsolePage } from "./console_page";
import { expect, test } from "./fixtures";

const title = "Probe rotation";

/** With the pedal held, presses the button that jogs the axis upwards, and keeps it down. */
async function holdJog(robot: ConsolePage, page: Page): Promise<void> {
  await robot.unlockRobot();
  await robot.axis(title).enable();
  await robot.latchPedal();
  await robot.button(`Hold to jog ${title} towards larger positions`).hover();
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

for (const [way, loss] of [
  ["another window takes the focus", (page) => page.evaluate(() => window.dispatchEvent(new Event("blur")))],
  ["the network is cut", (page) => page.route("**/api/jog/*", () => undefined)],
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

test("a key that is held jogs, and who does not hold the authority cannot", async ({ robot, page }) => {
  const axis = robot.axis(title);
  await robot.unlockRobot();
  await axis.enable();
  await robot.latchPedal();
  const larger = robot.button(`Hold to jog ${title} towards larger positions`);
  await larger.focus();
  await page.keyboard.down("Space");
  await expect.poll(() => axis.counts()).toBeGreaterThan(10);
  await page.keyboard.up("Space");
  await expect(robot.proposal(1)).toContainText("aborted");
  await robot.button("Release").click();
  await expect(larger).toBeDisabled();
});

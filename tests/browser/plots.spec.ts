/** What has been: axes over time, single ticks from the black box, and how long the kernel's loop takes. */
import { readFileSync } from "node:fs";
import type { Download, Page } from "@playwright/test";
import type { ConsolePage } from "./console_page";
import { expect, test } from "./fixtures";

const chart = (page: Page, panel: string, title: string) =>
  page
    .getByRole("region", { name: panel, exact: true })
    .getByRole("figure", { name: title })
    .getByRole("img");

/** Lets an axis follow a setpoint, then shows its plots. */
async function moveAndPlot(robot: ConsolePage, page: Page): Promise<void> {
  const axis = robot.axis("Lateral");
  await robot.unlockRobot();
  await axis.enable();
  await robot.pressPedal();
  await axis.propose("-3");
  await expect(robot.proposal(1)).toContainText("done");
  await openPlots(robot, page, "Lateral");
}

async function openPlots(robot: ConsolePage, page: Page, axis: string): Promise<void> {
  await robot.open("Plots");
  await page.getByRole("combobox", { name: "Axis", exact: true }).selectOption(axis);
}

/** A capture has the second before its trigger only where the kernel has run for one. */
async function secondOfTicks(page: Page): Promise<void> {
  const newestTick = (): Promise<number> =>
    page.evaluate(async () => {
      const answer = await fetch("/api/history?after=0");
      const { last_tick: ticks } = (await answer.json()) as { last_tick: number[] };
      return ticks.at(-1) ?? 0;
    });
  await expect.poll(newestTick).toBeGreaterThan(1000);
}

/** The rows of a file that the page made, by the names of its first line. */
async function tableOf(download: Download): Promise<Record<string, number>[]> {
  const [head = "", ...lines] = readFileSync(await download.path(), "utf8")
    .trim()
    .split("\n");
  const names = head.split(",");
  return lines.map((line) =>
    Object.fromEntries(line.split(",").map((text, index) => [names[index] ?? "", Number(text)])),
  );
}

test("a move is in the plots and in their table", async ({ robot, page }) => {
  await moveAndPlot(robot, page);
  for (const title of ["Position", "Error", "Velocity", "Drive"])
    await expect(chart(page, "Plots", title)).toBeVisible();
  await expect(chart(page, "Plots", "Position")).toHaveAttribute("aria-label", /measured -[23]\./);
  await page.getByLabel("Last").selectOption("120");
  const downloaded = page.waitForEvent("download");
  await robot.panel("Plots").getByRole("button", { name: "CSV" }).click();
  const rows = await tableOf(await downloaded);
  const lowest = Math.min(...rows.map((row) => row["Position: measured (mm) least"] ?? 0));
  expect(lowest).toBeLessThan(-2.9);
  expect(rows.some((row) => (row["Drive: sent (words) least"] ?? 0) < 0)).toBe(true);
  const ticks = rows.map(({ tick }) => tick ?? 0);
  expect(ticks).toEqual([...ticks].sort((a, b) => a - b));
});

test("nothing is saved before the whole history is there", async ({ robot, page }) => {
  let incomplete = true;
  await page.route("**/api/history*", async (route) => {
    if (!incomplete) return route.continue();
    const answer = await route.fetch();
    await route.fulfill({ response: answer, json: { ...(await answer.json()), more: true } });
  });
  const answered = () => page.waitForResponse((answer) => answer.url().includes("/api/history"));
  await openPlots(robot, page, "Yaw");
  await answered();
  await answered();
  const save = robot.panel("Plots").getByRole("button", { name: "CSV" });
  await expect(save).toBeDisabled();
  incomplete = false;
  await expect(save).toBeEnabled();
});

test("pause and zoom hold the plots; a double click follows the robot again", async ({ robot, page }) => {
  await openPlots(robot, page, "Yaw");
  const position = chart(page, "Plots", "Position");
  const pause = robot.panel("Plots").getByRole("button", { name: /Pause/ });
  await expect(position).toHaveAttribute("aria-label", /measured -?\d/);
  await pause.click();
  await expect(pause).toHaveText("Paused · follow again");
  await pause.click();
  await expect(pause).toHaveText("Pause");
  const box = await position.boundingBox();
  if (box === null) throw new Error("the chart is not visible");
  await page.mouse.move(box.x + box.width * 0.5, box.y + 30);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.8, box.y + 30, { steps: 5 });
  await page.mouse.up();
  await expect(pause).toHaveText("Paused · follow again");
  await position.dblclick({ position: { x: box.width / 2, y: 30 } });
  await expect(pause).toHaveText("Pause");
  await position.press("+");
  await expect(pause).toHaveText("Paused · follow again");
});

test("a capture has every single tick", async ({ robot, page }) => {
  await openPlots(robot, page, "Yaw");
  const panel = robot.panel("Capture");
  const state = panel.getByRole("status", { name: "Capture state" });
  await expect(state).toHaveText("Nothing captured yet.");
  await panel.getByLabel("Length").selectOption("1");
  await expect(async () => {
    await robot.button("Capture now").click();
    await expect(state).toHaveText(/Yaw: 1000 ticks, \d+ to \d+\./, { timeout: 2000 });
  }).toPass();
  await expect(chart(page, "Capture", "Since the tick before")).toBeVisible();
  const downloaded = page.waitForEvent("download");
  await robot.button("CSV of the capture").click();
  const rows = await tableOf(await downloaded);
  expect(rows).toHaveLength(1000);
  expect((rows.at(-1)?.tick ?? 0) - (rows[0]?.tick ?? 0)).toBe(999);
});

test.describe("of a robot with a needle", () => {
  test.use({ robotName: "prostate" });

  test("both forces are in the plots, in a capture and in its table", async ({ robot, page }) => {
    await robot.open("Plots");
    await expect(chart(page, "Plots", "Force")).toHaveAttribute("aria-label", /hand -?\d\S* .*needle -?\d/);
    await robot.button("Capture now").click();
    await expect(chart(page, "Capture", "Force")).toHaveAttribute("aria-label", /hand .*needle /);
    const downloaded = page.waitForEvent("download");
    await robot.button("CSV of the capture").click();
    const rows = await tableOf(await downloaded);
    expect(rows.every((row) => Math.abs(row["Force: needle (N)"] ?? Number.NaN) < 1)).toBe(true);
  });
});

test("a trigger captures the ticks around it by itself", async ({ robot, page }) => {
  await openPlots(robot, page, "Yaw");
  const panel = robot.panel("Capture");
  const state = panel.getByRole("status", { name: "Capture state" });
  await expect(chart(page, "Plots", "Position")).toHaveAttribute("aria-label", /measured -?\d/);
  await secondOfTicks(page);
  await panel.getByRole("combobox", { name: "Trigger", exact: true }).selectOption("Position");
  await panel.getByLabel("Trigger when").selectOption("below");
  await panel.getByLabel(/^Trigger level/).fill("-0.5");
  await panel.getByRole("button", { name: "Arm" }).click();
  await expect(state).toContainText("Armed since tick");
  const pushed = await page.evaluate(
    async () =>
      (await fetch("/api/bench/push", { method: "POST", body: JSON.stringify({ slot: 0, counts: -40 }) }))
        .status,
  );
  expect(pushed).toBe(200);
  await expect(state).toHaveText(/Yaw: 2000 ticks/);
  await expect(panel.getByRole("button", { name: "Arm" })).toBeVisible();
  const downloaded = page.waitForEvent("download");
  await robot.button("CSV of the capture").click();
  const positions = (await tableOf(await downloaded)).map(
    (row) => row["Position: measured (°)"] ?? Number.NaN,
  );
  expect(positions[0]).toBeGreaterThan(-0.5);
  expect(positions.at(-1)).toBeLessThan(-0.5);
});

test("a page that nobody sees asks for nothing, and catches up", async ({ robot, page }) => {
  await openPlots(robot, page, "Yaw");
  await expect(chart(page, "Plots", "Position")).toHaveAttribute("aria-label", /measured -?\d/);
  let asked = 0;
  page.on("request", (request) => {
    if (request.url().includes("/api/history")) asked += 1;
  });
  const show = (hidden: boolean) =>
    page.evaluate((value) => {
      Object.defineProperty(document, "hidden", { configurable: true, get: () => value });
      document.dispatchEvent(new Event("visibilitychange"));
    }, hidden);
  await show(true);
  const statusAnswered = () => page.waitForResponse((answer) => answer.url().endsWith("/api/status"));
  await statusAnswered();
  const before = asked;
  await statusAnswered();
  await statusAnswered();
  expect(asked).toBe(before);
  await show(false);
  await expect.poll(() => asked).toBeGreaterThan(before);
});

test("the loop time names the phase that takes longest", async ({ robot }) => {
  await robot.open("Plots");
  const panel = robot.panel("Loop time");
  const rows = panel.getByRole("table", { name: "Loop time by phase" }).getByRole("row");
  await expect(rows).toHaveCount(5);
  await expect(panel).toContainText("The clock is simulated: no deadline, so no wake time.");
  await expect(rows.filter({ hasText: "wake" })).toContainText("–");
  await expect(rows.filter({ hasText: "bus" })).toContainText(/\d (µs|ms)/);
  await expect(rows.filter({ hasText: "▲" })).toHaveCount(1);
  await expect(panel.getByRole("img", { name: /^Histogram of each phase/ })).toBeVisible();
});

test("plots of an app that is silent are greyed, then covered", async ({ robot, page, stack }) => {
  await openPlots(robot, page, "Yaw");
  await expect(robot.panel("Plots").getByText("live", { exact: true })).toBeVisible();
  stack.signalApp("SIGSTOP");
  try {
    await expect(page.getByRole("heading", { name: /No data for/ })).toBeVisible();
    await expect(page.locator("main > .panels")).toHaveAttribute("inert", "");
  } finally {
    stack.signalApp("SIGCONT");
  }
  await expect(page.getByRole("heading", { name: /No data for/ })).toHaveCount(0);
});

test("nothing scrolls sideways at 1280 x 800", async ({ robot, page }) => {
  await openPlots(robot, page, "Yaw");
  await expect(chart(page, "Plots", "Drive")).toBeVisible();
  const [inside, window] = await page.evaluate(() => [
    document.documentElement.scrollWidth,
    document.documentElement.clientWidth,
  ]);
  expect(inside).toBe(window);
});

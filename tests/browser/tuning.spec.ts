/** An axis measured under the pedal, and what follows for the robot's file. */
import { readFileSync } from "node:fs";
import path from "node:path";
import type { ConsolePage } from "./console_page";
import { expect, test } from "./fixtures";

const YAW = 0;
const INSERTION = 3;

/** Motors of which the robot's file knows nothing. */
const slowMotors = readFileSync(path.join(process.cwd(), "../models/plant/neuro.toml"), "utf8")
  .replace("full_speed_counts_per_s = 1000", "full_speed_counts_per_s = 800")
  .replace("dead_zone_fraction = 0.015", "dead_zone_fraction = 0.02");

/** Yaw at its switch's home, the probe declared to be out. */
async function homed(robot: ConsolePage): Promise<void> {
  const { page } = robot;
  const post = async (place: string, data: object = {}): Promise<boolean> =>
    (await page.request.post(new URL(`/api/${place}`, page.url()).href, { data })).ok();
  await robot.unlockRobot();
  await expect.poll(() => post(`motors/${INSERTION}/set-home`, { override_switch: true })).toBe(true);
  for (const title of ["Probe insertion", "Yaw"]) await robot.axis(title).enable();
  await expect.poll(() => post("proposals", { kind: "home", slot: YAW })).toBe(true);
  await robot.pressPedal();
  await expect(robot.proposal(1)).toContainText("done");
  await robot.releasePedal();
}

test.describe("with motors that nobody described", () => {
  test.use({ clock: "fast", plant: slowMotors });

  test("an axis is measured under the pedal, shown with its line, and leads to a file to look at", async ({
    page,
    robot,
  }) => {
    await homed(robot);
    await robot.open("Tuning");
    const ask = robot.panel("Measure an axis");
    const send = ask.getByRole("button", { name: "Propose measurement" });
    await ask.getByRole("combobox", { name: "Axis" }).selectOption({ label: "Yaw" });
    await expect(send).toBeDisabled();
    await ask.getByRole("checkbox").check();
    await send.click();
    const run = robot.panel("Measurement 2");
    await expect(run).toContainText("Waits for somebody to approve it.");
    await expect(run).toContainText(/Between .*° and .*°/);
    await expect(ask.getByRole("checkbox")).not.toBeChecked();
    await robot.approve(2);
    await robot.pressPedal();
    await expect(run).toContainText(/[1-9]\d* of at most 20 drives measured/);
    await robot.releasePedal();
    await expect(run).toContainText("press and hold the pedal within 60 s to go on");
    await robot.pressPedal();

    const figures = page.getByRole("table", { name: "What Yaw does" });
    await expect(figures).toBeVisible();
    await robot.releasePedal();
    await expect(figures.getByRole("row", { name: /^Full speed/ })).toContainText(/(79|80)\d counts\/s/);
    await expect(figures.getByRole("row", { name: /^Switch hysteresis/ })).toContainText("not measured here");
    await expect(
      page.getByRole("img", { name: /^Speed of Yaw by drive: 100\.0 %: (79|80)\d up/ }),
    ).toBeVisible();
    const file = robot.panel("What follows for the robot’s file");
    await expect(file.getByRole("row", { name: /full_speed_counts_per_s/ })).toContainText(
      /1000\s*80\d|1000\s*79\d/,
    );
    const difference = file.getByRole("region", { name: "Difference" });
    await expect(difference).toContainText("--- a/neuro.toml");
    const [download] = await Promise.all([
      page.waitForEvent("download"),
      file.getByRole("button", { name: "Download neuro.toml" }).click(),
    ]);
    expect(download.suggestedFilename()).toBe("neuro.toml");
    const text = readFileSync(await download.path(), "utf8");
    expect(text).toMatch(/full_speed_counts_per_s = (79|80)\d/);
    await page.screenshot({ path: test.info().outputPath("tuning-wide.png"), fullPage: true });
    await page.setViewportSize({ width: 390, height: 844 });
    await expect
      .poll(() => page.evaluate(() => document.documentElement.scrollWidth))
      .toBeLessThanOrEqual(390);
    await page.screenshot({ path: test.info().outputPath("tuning-narrow.png"), fullPage: true });
  });
});

test("what stands against a measurement is said where it is asked for", async ({ robot }) => {
  await robot.unlockRobot();
  await robot.openCase();
  await robot.open("Tuning");
  const ask = robot.panel("Measure an axis");
  await ask.getByRole("checkbox").check();
  await ask.getByRole("button", { name: "Propose measurement" }).click();
  await expect(ask.getByRole("alert")).toContainText("CASE");
  await expect(ask.getByRole("alert")).toContainText("close the case");
});

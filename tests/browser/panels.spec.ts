/** The main job of each panel beside the motors. */
import { expect, test } from "./fixtures";

for (const robotName of ["neuro", "prostate"] as const) {
  test.describe(robotName, () => {
    test.use({ robotName });

    test("the status panel has ten cards, and names the one that is unplugged", async ({ robot }) => {
      const status = robot.panel("Status");
      const slots = status.getByRole("table", { name: "Cards" }).getByRole("row");
      await expect(slots).toHaveCount(11);
      await expect(slots.nth(1)).toContainText("yes");
      await expect(slots.nth(1)).toContainText("live");
      const lastFrame = slots.nth(1).getByRole("cell").nth(3);
      await expect(lastFrame).toHaveText(/^\d+ ms$/);
      await expect(status).toContainText("LOCKED by BOOT");
      await expect(status).toContainText("Power off");
      await robot.panel("Bench").getByText("More faults").click();
      const card = robot.panel("Bench").getByRole("group", { name: "Faults of a card" });
      await card.getByLabel("Card").selectOption("0");
      await card.getByRole("button", { name: "Unplug card" }).click();
      await expect(slots.nth(1)).toContainText("✕ NO");
      await expect(slots.nth(1)).toContainText("SILENT");
      await expect(lastFrame).toHaveText(/^\d+\.\d s$/);
      await card.getByRole("button", { name: "Unplug card" }).click();
      await expect(slots.nth(1)).not.toContainText("✕");
    });

    test("nothing scrolls sideways at 1280 x 800, on any page", async ({ robot, page }) => {
      await robot
        .axis((await firstTitle(page)) ?? "")
        .row.getByRole("button", { name: /^Why/ })
        .click();
      await robot.panel("Bench").getByText("More faults").click();
      for (const name of ["Robot", "Targeting", "Codes", "Users", "Audit", "Account"] as const) {
        await robot.open(name);
        await expect(page.getByRole("main")).toBeVisible();
        const [inside, window] = await page.evaluate(() => [
          document.documentElement.scrollWidth,
          document.documentElement.clientWidth,
        ]);
        expect(inside, `width of the page ${name}`).toBe(window);
      }
    });
  });
}

async function firstTitle(page: import("@playwright/test").Page): Promise<string | undefined> {
  const label = await page
    .getByRole("listitem", { name: /^Axis / })
    .first()
    .getAttribute("aria-label");
  return label?.replace("Axis ", "");
}

test("causes, modes and verdicts lead to their place in the catalog, once there is a login", async ({
  front,
  stack,
  page,
}) => {
  await expect(page.getByRole("banner").getByText("BOOT")).toBeVisible();
  await expect(page.getByRole("banner").getByRole("link")).toHaveCount(0);
  await front.logIn("admin", stack.password);
  await front.takeControl();
  await expect(front.panel("Status").getByRole("link", { name: "LOCKED" })).toBeVisible();
  await expect(front.panel("Status").getByRole("link", { name: "BOOT" })).toBeVisible();
  await page.getByRole("banner").getByRole("link", { name: "BOOT" }).click();
  await expect(page.getByRole("article", { name: "BOOT" })).toBeInViewport();
  await front.open("Robot");
  await front.unlockRobot();
  await front.axis("Lateral").propose("1");
  const refusal = await front.axis("Lateral").expectRefusal("DISABLED");
  await expect(refusal.getByRole("link", { name: "DISABLED" })).toHaveAttribute(
    "href",
    "#/codes/verdict/DISABLED",
  );
});

test("power comes with Unlock and goes with the next lock, in status and API", async ({ robot, page }) => {
  const status = robot.panel("Status");
  const answer = () => page.evaluate(async () => (await fetch("/api/status")).json());
  await robot.unlockRobot();
  await expect(status).toContainText("Power on");
  expect(await answer()).toMatchObject({ power: "on", consent: 0 });
  const presses = new Set<number>();
  for (let press = 1; press <= 2; press++) {
    await robot.pressPedal();
    await robot.expectMode("MOTION");
    presses.add((await answer()).consent);
    await robot.releasePedal();
  }
  expect(presses.size).toBe(2);
  expect(presses).not.toContain(0);
  await robot.button("Pull E-stop").click();
  await robot.expectMode("LOCKED");
  await expect(status).toContainText("Power off");
});

test("corrupted frames are counted at their card", async ({ robot }) => {
  const slot = robot.panel("Status").getByRole("row").nth(3);
  await robot.panel("Bench").getByText("More faults").click();
  const card = robot.panel("Bench").getByRole("group", { name: "Faults of a card" });
  await card.getByLabel("Card").selectOption("2");
  await card.getByRole("button", { name: "corrupt the next 1 frames of slot 2" }).click();
  await expect(slot.getByRole("cell").last()).toHaveText("1");
});

test("the mode selector homes, and manual mode ends it", async ({ robot, page }) => {
  await robot.unlockRobot();
  for (const title of ["Yaw", "Pitch", "Probe insertion", "Lateral", "Axial head"]) {
    await robot.axis(title).enable();
  }
  await robot.axis("Axial feet").setHome();
  const mode = page.getByRole("status", { name: "Robot mode now" });
  const change = robot.button("Change the robot mode");
  await expect(mode).toHaveText("manual");
  await expect(change).toBeDisabled();
  await page.getByLabel("Robot mode", { exact: true }).selectOption("home");
  await change.click();
  await robot.approve(1);
  await expect(mode).toHaveText("home");
  await expect(robot.panel("Homing progress")).toBeVisible();
  await page.getByLabel("Robot mode", { exact: true }).selectOption("manual");
  await change.click();
  await expect(mode).toHaveText("manual");
  await expect(robot.proposal(1)).toContainText("aborted");
});

test("the communication panel names both browsers, and disconnects one", async ({ robot, other, stack }) => {
  await other.logIn("admin", stack.password);
  const rows = robot.panel("Communication").getByRole("row").filter({ hasText: "console" });
  await expect(rows).toHaveCount(2);
  await expect(rows.first()).toContainText("admin");
  await expect(rows.first()).toContainText(new URL(stack.url).port);
  const returned = other.page.waitForEvent("websocket");
  await rows
    .last()
    .getByRole("button", { name: /^Disconnect/ })
    .click();
  await returned;
  await expect(rows).toHaveCount(2);
});

test("the log tells what happens, from a chosen level on, and can be paused", async ({ robot, page }) => {
  const log = robot.panel("Log");
  const lines = log.getByRole("listitem");
  await expect(lines.first()).toBeVisible();
  await log.getByLabel("App logs from").selectOption("debug");
  await robot.button("Set the level of the app's log").click();
  await expect(robot.button("Set the level of the app's log")).toHaveCount(0);
  await log.getByRole("button", { name: "Pause" }).click();
  const paused = await lines.count();
  await robot.unlockRobot();
  await robot.button("Pull E-stop").click();
  await robot.expectMode("LOCKED");
  await expect(log.getByRole("button", { name: /Paused · [1-9]/ })).toBeVisible();
  expect(await lines.count()).toBe(paused);
  await log.getByRole("button", { name: /Paused/ }).click();
  await expect.poll(() => lines.count()).toBeGreaterThan(paused);
  await log.getByLabel("Show from").selectOption("critical");
  await expect(page.getByText("No line of this level yet.")).toBeVisible();
});

test("the log is searched", async ({ robot, page }) => {
  await page.evaluate(() => fetch("/api/stop", { method: "POST" }));
  const log = robot.panel("Log");
  await log.getByRole("searchbox", { name: "Search the log" }).fill("admin stop");
  await expect(log.getByRole("listitem").filter({ hasText: "STOP by admin" })).toHaveCount(1);
  await expect(log.getByRole("listitem")).toHaveCount(1);
  await log.getByRole("searchbox").fill("no such words");
  await expect(log.getByText("No line has these words.")).toBeVisible();
});

test("a pedal contact that sticks is seen as channels that disagree", async ({ robot }) => {
  const bench = robot.panel("Bench");
  await bench.getByText("More faults").click();
  await bench.getByLabel("Pedal contact NO").selectOption("closed");
  await expect(robot.pedalState).toContainText("CHANNELS DISAGREE");
  await expect(bench.getByLabel("Pedal contact NO")).toHaveValue("closed");
  await robot.button("End every fault").click();
  await expect(robot.pedalState).toContainText("released");
  await expect(bench.getByLabel("Pedal contact NO")).toHaveValue("free");
});

test("the simulated motor is read and changed at the bench, marked as simulation, and restored", async ({
  robot,
}) => {
  const bench = robot.panel("Bench");
  await bench.getByText("Plant parameters").click();
  const motor = bench.getByRole("form", { name: "Simulated motor" });
  const coast = motor.getByRole("status", { name: "Coast of the simulated motor" });
  await expect(motor).toContainText("SIMULATION");
  await motor.getByLabel("Simulated motor of").selectOption("Lateral");
  await expect(coast).toHaveText("coasts 5 counts from full speed");
  await motor.getByLabel("Lag, ms").fill("30");
  await motor.getByRole("button", { name: "Set the simulated motor" }).click();
  await expect(coast).toHaveText("coasts 30 counts from full speed · ✕ not as in the plant file");
  await motor.getByLabel("Lag, ms").fill("0");
  await motor.getByRole("button", { name: "Set the simulated motor" }).click();
  await expect(bench.getByRole("alert")).toContainText("expected a number from 0.1 to 1000");
  await expect(motor.getByLabel("Lag, ms")).toHaveValue("30");
  await motor.getByRole("button", { name: "As in the plant file" }).click();
  await expect(coast).toHaveText("coasts 5 counts from full speed");
});

test("each panel's dot turns red with words when the app falls silent", async ({ robot, stack }) => {
  await robot.expectMode("LOCKED");
  const titles = ["Motors", "Log", "Communication", "Bench", "Proposals", "Status"];
  for (const title of titles)
    await expect(robot.panel(title).getByText("live", { exact: true }).first()).toBeVisible();
  stack.signalApp("SIGSTOP");
  try {
    for (const title of titles) await expect(robot.panel(title).getByText(/stale · \d/)).toBeVisible();
  } finally {
    stack.signalApp("SIGCONT");
  }
  for (const title of titles) await expect(robot.panel(title).getByText(/stale/)).toHaveCount(0);
});

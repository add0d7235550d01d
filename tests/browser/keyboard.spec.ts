/** Each page's main job without a pointer, and how the console looks to those who ask for less or for other colours. */

import { knownBy, type PageName } from "./console_page";
import { expect, test } from "./fixtures";
import { Keyboard } from "./keyboard";

const password = "correct horse battery";

test.describe("with the pedal of the page", () => {
  test.use({ clock: "slow" });

  test("keys alone log in, unlock, enable, propose, press the pedal and stop", async ({
    front,
    stack,
    page,
  }) => {
    const keyboard = new Keyboard(page);
    const axis = front.axis("Probe rotation");
    await keyboard.type(front.loginForm.getByLabel("Name"), "admin");
    await keyboard.type(front.loginForm.getByLabel("Password"), stack.password);
    await page.keyboard.press("Enter");
    await keyboard.press(front.button("Take control"));
    await expect(front.control).toHaveText("You are in control");
    await keyboard.press(front.unlock);
    await front.expectMode("READY");
    await expect(axis.button("Enable")).not.toHaveAttribute("data-foretold");
    await keyboard.press(front.button("Enable Probe rotation"));
    await axis.expectState("ENABLED");
    await keyboard.reach(axis.track);
    for (let step = 0; step < 5; step++) await page.keyboard.press("ArrowRight");
    await page.keyboard.press("Enter");
    await expect(front.proposal(1)).toContainText("approved");
    await front.expectArmed();
    await keyboard.press(front.latch, "Space");
    await expect(front.proposal(1)).toContainText("executing");
    await page.keyboard.press("Escape");
    await expect(front.stopAnswer).toHaveText("STOP accepted");
    await expect(front.proposal(1)).toContainText("aborted");
  });
});

test("keys alone find a code, add a user, read the audit and change a password", async ({
  robot,
  stack,
  page,
}) => {
  const keyboard = new Keyboard(page);
  const open = async (name: string): Promise<void> => {
    await keyboard.press(page.getByRole("link", { name }));
    await expect(robot.panel(name)).toBeVisible();
  };
  await open("Codes");
  await keyboard.type(page.getByRole("searchbox", { name: "Find" }), "stall");
  await expect(robot.panel("Faults").getByRole("article", { name: "STALL" })).toBeVisible();
  await expect(page.getByRole("article", { name: "ESTOP" })).toHaveCount(0);

  await open("Users");
  const form = page.getByRole("form", { name: "Add a user" });
  await keyboard.type(form.getByLabel("Name"), "ann");
  await keyboard.type(form.getByLabel("Role"), "engineer");
  await keyboard.type(form.getByLabel("Password"), password);
  await page.keyboard.press("Enter");
  await expect(page.getByRole("row", { name: "User ann" })).toContainText("engineer");

  await open("Audit");
  await expect(robot.panel("Audit").getByRole("row").filter({ hasText: "ann" }).first()).toBeVisible();

  await open("Account");
  const change = page.getByRole("form", { name: "Change the password" });
  await keyboard.type(change.getByLabel("Current password"), stack.password);
  await keyboard.type(change.getByLabel("New password", { exact: true }), password);
  await keyboard.type(change.getByLabel("New password again"), password);
  await page.keyboard.press("Enter");
  await expect(change.getByRole("status")).toHaveText("The password is changed.");
});

test("keys alone set a registration and a target, capture ticks, reject a proposal and turn the picture", async ({
  robot,
  page,
}) => {
  const keyboard = new Keyboard(page);
  const axis = robot.axis("Probe rotation");
  await robot.unlockRobot();
  await robot.openCase();
  await axis.setHome();
  await axis.enable();
  const open = async (name: string, panel: string): Promise<void> => {
    await keyboard.press(page.getByRole("link", { name, exact: true }));
    await expect(robot.panel(panel)).toBeVisible();
  };
  await open("Targeting", "Entry, target and probe");
  const straight = [1, 0, 0, -18, 0, 1, 0, -185, 0, 0, 1, -73];
  const cells = ["R", "A", "S"].flatMap((row) =>
    ["x", "y", "z", "origin"].map((column) => `${row} ${column}`),
  );
  for (const [of, text] of [
    ...cells.map((cell, place) => [`Registration ${cell}`, `${straight[place]}`] as const),
    ["Entry R", "8"],
    ["Entry A", "250"],
    ["Entry S", "70"],
    ["Target R", "5"],
    ["Target A", "200"],
    ["Target S", "60"],
  ] as const) {
    if (of === "Entry R") await keyboard.press(robot.button("Set registration"));
    await keyboard.reach(page.getByRole("textbox", { name: `${of}, scanner RAS, mm` }));
    await page.keyboard.press("Control+A");
    await page.keyboard.type(text);
  }
  await keyboard.press(robot.button("Set target"));
  await expect(robot.panel("Entry, target and probe")).toContainText("As received.");

  await open("Plots", "Capture");
  await keyboard.press(robot.button("Capture now"));
  await expect(page.getByRole("status", { name: "Capture state" })).toContainText("ticks,");

  await open("Proposals", "Trajectory file");
  const rows = Buffer.from("time [s],probe_rotation [rad]\n0,0.05\n1,0.2\n2,0.1\n");
  // The browser's own dialog for files is not of the page.
  await robot
    .panel("Trajectory file")
    .getByLabel("Trajectory file")
    .setInputFiles({ name: "wave.csv", mimeType: "text/csv", buffer: rows });
  await keyboard.press(robot.button("Propose it"));
  await keyboard.press(robot.button("Reject proposal 1"));
  await expect(robot.panel("Proposal 1")).toContainText("Rejected by admin");

  await keyboard.press(page.getByRole("link", { name: "Show in 3D" }));
  const picture = robot.panel("3D").getByRole("img", { name: /^3D: .*target 5\.0, 200\.0, 60\.0/ });
  await expect(picture).toBeVisible();
  const before = await picture.screenshot();
  await keyboard.press(robot.button("Coronal, from the front"));
  await expect.poll(async () => before.equals(await picture.screenshot())).toBe(false);
});

test("a button that was pressed by key keeps the focus while the app answers", async ({ robot, page }) => {
  const keyboard = new Keyboard(page);
  await robot.unlockRobot();
  const jam = robot.button("Jam Yaw");
  await keyboard.press(jam);
  await expect(jam).toHaveAttribute("aria-pressed", "true");
  await expect(jam).toBeFocused();
  await page.keyboard.press("Enter");
  await expect(jam).toHaveAttribute("aria-pressed", "false");
});

test("every stop of the Tab key is ringed and not hidden", async ({ robot, page }) => {
  const keyboard = new Keyboard(page);
  await robot.unlockRobot();
  await robot.axis("Lateral").enable();
  for (const name of Object.keys(knownBy) as PageName[]) {
    await robot.open(name);
    const stops = await keyboard.stops();
    expect(stops.length, name).toBeGreaterThan(8);
    expect(
      stops.filter(({ fault }) => fault !== null),
      name,
    ).toEqual([]);
  }
});

test("alarms flash as their priority has it, carry a word and a symbol, and hold still where motion is reduced", async ({
  robot,
  page,
}) => {
  const flashes = () =>
    page.evaluate(() => document.getAnimations().map((flash) => flash.effect?.getTiming().duration));
  await robot.panel("Bench").getByText("More faults").click();
  await robot.panel("Bench").getByLabel("Pedal contact NO").selectOption("closed");
  await expect(robot.pedalState).toHaveText("▽ CHANNELS DISAGREE");
  // IEC 60601-1-8: medium priority flashes at 0.4 to 0.8 Hz, high at 1.4 to 2.8 Hz.
  await expect.poll(flashes).toEqual([1600, 1600]);
  await robot.button("Pull E-stop").click();
  await expect(robot.estop).toHaveText("⬣ PULLED");
  await expect.poll(flashes).toEqual([500, 1600, 500]);
  await page.emulateMedia({ reducedMotion: "reduce" });
  expect(await flashes()).toEqual([]);
});

test("forced colours leave a mark on what is pressed, on what lives and on the track", async ({
  robot,
  page,
}) => {
  await page.emulateMedia({ forcedColors: "active", colorScheme: "light" });
  await robot.button("Jam Yaw").click();
  const jam = robot.button("Jam Yaw");
  await expect(jam).toHaveAttribute("aria-pressed", "true");
  await expect(jam).toHaveCSS("outline-width", "2px");
  const ground = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  await expect(robot.panel("Motors").locator(".life-dot i")).not.toHaveCSS("background-color", ground);
  await expect(robot.axis("Yaw").track.locator(".measured path").first()).not.toHaveCSS("fill", ground);
});

/** Homing, and why an axis does not move. */
import type { Axis } from "./console_page";
import { expect, test } from "./fixtures";

/** Slider, entry and jogging of an axis that is enabled: all of them given to the operator, or none. */
async function expectSetpoints(axis: Axis, stand: "locked" | "free"): Promise<void> {
  const locked = stand === "locked";
  await expect(axis.track).toHaveAttribute("aria-disabled", String(locked));
  const before = await axis.circle();
  if (locked) {
    await axis.track.press("ArrowRight");
    expect(await axis.circle()).toBe(before);
  }
  await expect(axis.row.getByRole("textbox")).toBeEnabled({ enabled: !locked });
  await expect(axis.row.getByRole("button", { name: /^Step/ }).first()).toBeEnabled({ enabled: !locked });
}

test("Go Home runs an axis to its switch, and its limits become known", async ({ robot }) => {
  const axis = robot.axis("Probe insertion");
  await robot.unlockRobot();
  await expect(axis.row.getByText("unknown")).toHaveCount(2);
  await axis.enable();
  await axis.press("Go Home");
  await expect(robot.button("Homing.. Probe insertion")).toBeDisabled();
  await expectSetpoints(axis, "locked");
  await expect(robot.panel("Motors").getByRole("status").filter({ hasText: "locked" })).toContainText(
    "The mode home drives the setpoints: wait until it has ended, or abort its proposal.",
  );
  await robot.pressPedal();
  await axis.expectState("HOMING");
  await expect(axis.row.getByText("UNHOMED")).toHaveCount(0);
  await expect(axis.row.getByText("homed at switch")).toBeVisible();
  await expect(axis.row.getByText("unknown")).toHaveCount(0);
  await expect(axis.row.getByText("34.93 mm")).toBeVisible();
  await expect(robot.proposal(1)).toContainText("done");
  await expect(robot.button("Go Home Probe insertion")).toBeEnabled();
  await expectSetpoints(axis, "free");
});

test("Home all goes through the steps while the pedal is held, and ends in manual mode", async ({
  robot,
  page,
}) => {
  const titles = ["Yaw", "Pitch", "Probe insertion", "Lateral", "Axial head"];
  // Insertion, lateral and head, but not yaw, which is to be seen homing.
  await robot.pushByHand({ "Probe insertion": [3, -150], Lateral: [4, 300], "Axial head": [7, 350] });
  await robot.unlockRobot();
  for (const title of titles) await robot.axis(title).enable();
  // Linked to the head, which is not sent to its switch before.
  await robot.axis("Axial feet").setHome();
  await robot.button("Home all").click();
  await robot.approve(1);
  const step = (title: string) =>
    robot.panel("Homing progress").getByRole("listitem").filter({ hasText: title });
  await expect(step("Probe out")).toHaveAttribute("aria-current", "step");
  await expect(robot.button("Waits Yaw")).toBeDisabled();
  await robot.pressPedal();
  await expect(step("Angles")).toHaveAttribute("aria-current", "step");
  await expect(step("Probe out")).toContainText("done");
  await expect(robot.button("Homing.. Yaw")).toBeDisabled();
  await expect(robot.proposal(1)).toContainText("done");
  for (const title of titles) {
    await expect(robot.axis(title).row.getByText("UNHOMED")).toHaveCount(0);
  }
  await expect(robot.panel("Homing progress")).toHaveCount(0);
  await expect(page.getByRole("status", { name: "Robot mode now" })).toHaveText("manual");
});

test("an axis without a switch is homed by Set Home alone", async ({ robot }) => {
  const axis = robot.axis("Probe rotation");
  await robot.unlockRobot();
  await expect(robot.button("Go Home Probe rotation")).toBeDisabled();
  await expect(robot.button("Go Home Probe rotation")).toHaveAttribute("title", /press Set Home/);
  await axis.setHome();
  await expect(axis.row.getByText("359.82°", { exact: true })).toBeVisible();
});

test("Set Home of an axis with a switch asks before it overrides the switch", async ({ robot, page }) => {
  const axis = robot.axis("Lateral");
  await robot.unlockRobot();
  await axis.press("Set Home");
  const question = robot.panel("Override the switch of Lateral?");
  await expect(question).toContainText("Go Home");
  await page.keyboard.press("Escape");
  await expect(question).toHaveCount(0);
  await axis.press("Set Home");
  await question.getByRole("button", { name: "Cancel" }).click();
  await expect(question).toHaveCount(0);
  await expect(axis.row.getByText("UNHOMED")).toBeVisible();

  await axis.setHome(true);
  await expect(question).toHaveCount(0);
  await expect(axis.row.getByText("homed by hand")).toBeVisible();
  await robot.open("Audit");
  await expect(robot.panel("Audit")).toContainText("lateral set-home, its switch overridden");
});

test("Zero all asks first, and shows the verdict of every axis", async ({ robot, page }) => {
  await robot.unlockRobot();
  await robot.button("Zero all").click();
  const question = robot.panel("Declare every axis without a switch at home?");
  await page.keyboard.press("Escape");
  await expect(question).toHaveCount(0);
  await expect(robot.axis("Yaw").row.getByText("UNHOMED")).toBeVisible();

  await robot.button("Zero all").click();
  await question.getByRole("button", { name: "Set Home of these axes" }).click();
  const answer = robot.panel("Answer to Zero all");
  await expect(answer.getByRole("listitem")).toHaveCount(7);
  await expect(answer.getByRole("listitem").filter({ hasText: "Probe rotation" })).toContainText("ACCEPTED");
  await expect(answer.getByRole("link", { name: "ACCEPTED" }).first()).toHaveAttribute(
    "href",
    "#/codes/verdict/ACCEPTED",
  );
  const yaw = answer.getByRole("listitem").filter({ hasText: "Yaw" });
  await expect(yaw).toContainText("Not sent: it has a limit switch");
  await expect(robot.axis("Yaw").row.getByText("UNHOMED")).toBeVisible();
  await expect(robot.axis("Probe rotation").row.getByText("UNHOMED")).toHaveCount(0);
});

test("Why not moving? marks the gate that blocks, with the next step", async ({ robot }) => {
  const axis = robot.axis("Yaw");
  await robot.unlockRobot();
  await axis.row.getByRole("button", { name: "Why not moving? Yaw" }).click();
  const gates = axis.row.getByRole("list", { name: "Gates of Yaw" });
  const line = (gate: string) => gates.getByRole("listitem").filter({ hasText: gate });
  await expect(line("MODE")).toContainText("BLOCKS");
  await expect(line("MODE")).toContainText("press and hold the pedal");
  await expect(line("ENABLE")).toContainText("closed too");
  await robot.pressPedal();
  await expect(line("MODE")).toContainText("open");
  await expect(line("ENABLE")).toContainText("BLOCKS");
});

test.describe("the prostate robot", () => {
  test.use({ robotName: "prostate" });

  test("shows its axes and the steps of its own homing", async ({ robot, page }) => {
    await robot.unlockRobot();
    const steps = page.getByRole("group", { name: "Home", exact: true });
    await expect(steps.getByRole("button", { name: /^Home step/ })).toHaveCount(7);
    await robot.enableAll();
    await robot.button("Home all").click();
    await robot.approve(1);
    const progress = robot.panel("Homing progress");
    await expect(progress.getByRole("listitem").first()).toHaveAttribute("aria-current", "step");
    await robot.pressPedal();
    await expect(progress.getByRole("listitem").nth(1)).toHaveAttribute("aria-current", "step");
    await expect(progress).toContainText(/release the pedal/i);
    await robot.stop.click();
    await expect(progress).toHaveCount(0);
    await expect(robot.proposal(1)).toContainText("aborted");
  });
});

test("an axis without reference looks unlike one that has it", async ({ robot }) => {
  const unhomed = robot.axis("Probe rotation").row.getByText("UNHOMED");
  await robot.unlockRobot();
  await expect(unhomed).toContainText("◌");
  await expect(unhomed).toContainText(/≤ \d+\.\d+°/);
  await robot.axis("Probe rotation").setHome();
  await expect(unhomed).toHaveCount(0);
  await expect(robot.axis("Yaw").row.getByText("UNHOMED")).toBeVisible();
});

test("the largest following error stays until it is reset by hand; how far the axis coasts is shown", async ({
  robot,
}) => {
  const axis = robot.axis("Probe rotation");
  const largest = axis.row.getByRole("status", { name: "Largest following error of Probe rotation" });
  await robot.unlockRobot();
  await axis.setHome();
  await axis.enable();
  await expect(axis.row.getByText(/stops ≤ \d/)).toBeVisible();
  await expect(largest).toHaveCount(0);
  await robot.pressPedal();
  await axis.propose("5");
  await expect(robot.proposal(1)).toContainText("done");
  await expect(largest).toHaveText(/-?\d+\.\d+°/);
  const after = await largest.textContent();
  await expect(
    axis.row.getByRole("status", { name: "Following error of Probe rotation", exact: true }),
  ).toHaveText("none now");
  await expect(largest).toHaveText(after ?? "");
  await robot.button("Reset the largest following error of Probe rotation").click();
  await expect(largest).toHaveCount(0);
});

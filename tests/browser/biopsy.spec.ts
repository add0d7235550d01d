/** The prostate robot's biopsy panel: forces, membranes, and a biopsy that waits for the pedal. */
import { readFileSync } from "node:fs";
import path from "node:path";
import type { ConsolePage } from "./console_page";
import { expect, test } from "./fixtures";

test.use({ robotName: "prostate" });

test("forces are shown and zeroed, membranes set and reset", async ({ robot }) => {
  await robot.unlockRobot();
  const panel = robot.panel("Biopsy");
  const hand = panel.getByRole("row", { name: "Force of the hand" });
  await expect(hand).toContainText(/19[67]\d/);
  await panel.getByRole("button", { name: "Zero forces" }).click();
  await expect(hand.getByRole("cell").last()).toHaveText(/^19[67]\d\.\d$/);

  const membranes = panel.getByRole("list", { name: "Membranes" }).getByRole("listitem");
  await expect(membranes).toHaveText(["25 mm: next", "50 mm: expected"]);
  await panel.getByLabel("Membranes, mm").fill("20, 35, 60");
  await panel.getByRole("button", { name: "Set membranes", exact: true }).click();
  await expect(membranes).toHaveText(["20 mm: next", "35 mm: expected", "60 mm: expected"]);
  await panel.getByLabel("Membranes, mm").fill("20, 20");
  await panel.getByRole("button", { name: "Set membranes", exact: true }).click();
  await expect(panel.getByRole("alert")).toContainText("INVALID");
  await panel.getByRole("button", { name: "Reset membranes" }).click();
  await expect(membranes.first()).toHaveText("20 mm: next");

  await panel.getByLabel("Target x, y, z, mm").fill("3, -2, 70");
  await panel.getByRole("button", { name: "Propose biopsy" }).click();
  await expect(panel.getByRole("alert")).toContainText("Refused: DISABLED");
});

/** A biopsy begins, and a hand presses on the force sensor. */
async function pushNeedle(robot: ConsolePage) {
  const [rotation, insertion] = [robot.axis("Needle rotation"), robot.axis("Needle insertion")];
  await robot.unlockRobot();
  await rotation.setHome();
  for (const axis of [rotation, insertion]) await axis.enable();
  await insertion.press("Go Home");
  await robot.pressPedal();
  await expect(robot.proposal(1)).toContainText("done");
  const panel = robot.panel("Biopsy");
  await panel.getByRole("button", { name: "Zero forces" }).click();
  await panel.getByLabel("Target x, y, z, mm").fill("3, -2, 70");
  await robot.releasePedal();
  await panel.getByRole("button", { name: "Propose biopsy" }).click();
  await robot.approve(2);
  await robot.pressPedal();
  await expect(robot.proposal(2)).toContainText("executing");
  await expect(robot.panel("Motors")).toContainText("The mode cooperative biopsy drives the setpoints");

  await robot.panel("Bench").getByText("More faults").click();
  const hand = robot.panel("Bench").getByRole("group", { name: /^Sensor .*, input 2$/ });
  await hand.getByRole("spinbutton").fill("565");
  await hand.getByRole("button", { name: "Press" }).click();
  return { panel, insertion };
}

test("a hand pushes the needle through its first membrane, and letting the pedal go holds it", async ({
  robot,
}) => {
  const { panel, insertion } = await pushNeedle(robot);
  const membranes = panel.getByRole("list", { name: "Membranes" }).getByRole("listitem");
  await expect(membranes.first()).toHaveText(/^25 mm: passed, found at 2[3-7]\.\d mm$/);

  await robot.releasePedal();
  await expect(robot.proposal(2)).toContainText("paused");
  const held = await insertion.restingCounts();
  expect(await insertion.restingCounts()).toBe(held);
  await robot.button("Abort proposal 2").click();
  await expect(robot.proposal(2)).toContainText("aborted");
});

test.describe("in rough tissue", () => {
  const plant = readFileSync(path.join(__dirname, "../../models/plant/prostate.toml"), "utf8");
  test.use({ plant: plant.replace(/^texture_n = .*$/m, "texture_n = 0.4") });

  test("the page says of rough tissue that no membrane can be told from it", async ({ robot }) => {
    const { panel } = await pushNeedle(robot);
    const needle = panel.locator(".biopsy-now");
    await expect(needle.getByRole("alert")).toContainText("membranes cannot be told from tissue");
    await robot.releasePedal();
  });
});

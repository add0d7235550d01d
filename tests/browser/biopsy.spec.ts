/** The prostate robot's biopsy panel: forces, membranes, and a biopsy that waits for the pedal. */
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

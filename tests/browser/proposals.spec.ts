/** One proposal as a whole, its ghost in 3D, and a trajectory file that is wrong and then corrected. */
import type { Page } from "@playwright/test";
import { expect, test } from "./fixtures";

const header = "time [s],probe_rotation [rad]";

function csv(name: string, rows: string): { name: string; mimeType: string; buffer: Buffer } {
  return { name, mimeType: "text/csv", buffer: Buffer.from(`${header}\n${rows}`) };
}

/** Each axis at home where it stands, whatever its switch would tell; one that still settles is asked again. */
async function setEveryHome(page: Page): Promise<void> {
  const answers = await page.evaluate(async () => {
    const motors: { slot: number }[] = await (await fetch("/api/motors")).json();
    const body = JSON.stringify({ override_switch: true });
    const asked = motors.map(({ slot }) => fetch(`/api/motors/${slot}/set-home`, { method: "POST", body }));
    return (await Promise.all(asked)).map(({ status }) => status);
  });
  expect(new Set(answers)).toEqual(new Set([200]));
}

test("a file that is wrong shows where, a fast one is slowed down, a right one is proposed, looked at and rejected", async ({
  robot,
}) => {
  await robot.unlockRobot();
  const axis = robot.axis("Probe rotation");
  await axis.setHome();
  await axis.enable();
  await robot.open("Proposals");

  const files = robot.panel("Trajectory file");
  const chosen = files.getByLabel("Trajectory file");
  await chosen.setInputFiles(csv("wrong.csv", "0,0.05\n1,900\n"));
  const refusal = files.getByRole("alert");
  await expect(refusal).toContainText("wrong.csv was not loaded: OUT_OF_RANGE");
  await expect(refusal).toContainText("Line 3");
  await expect(refusal.getByRole("cell", { name: "▲ 900" })).toBeVisible();

  await chosen.setInputFiles(csv("fast.csv", "0,0.05\n0.1,0.2\n0.2,0.1\n"));
  await expect(refusal).toContainText("fast.csv was not loaded: TOO_FAST");
  await files.getByRole("button", { name: "Slow it down to fit" }).click();
  await expect(refusal).toHaveCount(0);
  await expect(files).toContainText(/slowed down to \d+\.\d\d times as long, loaded by admin/);

  await chosen.setInputFiles(csv("corrected.csv", "0,0.05\n1,0.2\n2,0.1\n"));
  await expect(refusal).toHaveCount(0);
  await expect(files).toContainText("3 rows, 2.0 s");
  await files.getByRole("button", { name: "Propose it" }).click();

  const detail = robot.panel("Proposal 1");
  await expect(detail.getByRole("definition").filter({ hasText: /^file$/ })).toBeVisible();
  const checks = detail.getByRole("region", { name: "Checks" }).getByRole("listitem");
  await expect(checks.filter({ hasText: "rates" })).toBeVisible();
  await expect(checks.filter({ hasNotText: "passed" })).toHaveCount(0);
  await expect(
    detail.getByRole("img", { name: /^Position of Probe rotation: 0\.00° to 5\.75°, allowed/ }),
  ).toBeVisible();
  await expect(
    detail.getByRole("img", { name: /^Velocity of Probe rotation: at most .* of .*°\/s$/ }),
  ).toBeVisible();

  await robot.button("Reject proposal 1").click();
  await expect(detail).toContainText("Rejected by admin");
  await expect(robot.button("Approve proposal 1")).toHaveCount(0);
});

test("a refused move names the check that failed and leads to its verdict", async ({ robot, page }) => {
  await robot.unlockRobot();
  await robot.axis("Lateral").setHome(true);
  await robot.axis("Lateral").enable();
  await robot.axis("Lateral").propose("12");
  await robot.axis("Lateral").expectRefusal("RANGE");
  await page.getByRole("link", { name: "Details of proposal 1" }).click();
  const checks = robot.panel("Proposal 1").getByRole("region", { name: "Checks" }).getByRole("listitem");
  await expect(checks.filter({ hasText: "failed" })).toContainText("range failed: RANGE");
  await expect(robot.panel("Proposal 1").getByRole("img", { name: /beyond its limits$/ })).toBeVisible();
  await checks.getByRole("link", { name: "RANGE" }).click();
  await expect(page).toHaveURL(/#\/codes\/verdict\/RANGE$/);
});

test("the ghost of a proposal and the workspace are told without WebGL, too", async ({ robot, page }) => {
  await robot.unlockRobot();
  await expect(() => setEveryHome(page)).toPass();
  await robot.axis("Lateral").enable();
  await robot.axis("Lateral").propose("-20");
  await expect(robot.proposal(1)).toContainText("approved");
  await page.evaluate(() => {
    HTMLCanvasElement.prototype.getContext = () => null;
  });
  await page.getByRole("link", { name: "Details of proposal 1" }).click();
  await page.getByRole("link", { name: "Show in 3D" }).click();
  const words = robot.panel("3D").getByRole("status").filter({ hasText: "no WebGL" });
  await expect(words).toContainText(/ghost of proposal 1: tip to .* by a way of 20\.0 mm/);
  await robot.button("Workspace").click();
  await expect(words).toContainText(/workspace: x .* to .*, y .* to/);
});

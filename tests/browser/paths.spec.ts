/** Motion of several axes in the list of proposals. */
import type { Page } from "@playwright/test";
import { expect, test } from "./fixtures";

/** Sends as the page that is open would. */
async function send(page: Page, method: string, path: string, body: string): Promise<number> {
  return page.evaluate(
    async ([verb, target, content]) => (await fetch(target, { method: verb, body: content })).status,
    [method, path, body] as const,
  );
}

test("a trajectory waits in the list for approval, runs while the pedal is held, and is done", async ({
  robot,
  page,
}) => {
  await robot.unlockRobot();
  const axis = robot.axis("Probe rotation");
  await axis.setHome();
  await axis.enable();
  const rows = "time [s],probe_rotation [rad]\n0,0.05\n1,0.2\n2,0.1\n";
  expect(await send(page, "PUT", "/api/trajectory", rows)).toBe(200);
  expect(await send(page, "POST", "/api/proposals", '{"kind":"trajectory"}')).toBe(201);

  const proposal = robot.proposal(1);
  await expect(proposal).toContainText("Trajectory");
  await expect(proposal).toContainText("probe_rotation");
  await expect(proposal).toContainText("checked");
  await robot.button("Approve proposal 1").click();
  await expect(proposal).toContainText("approved");
  await expect(robot.button("Approve proposal 1")).toHaveCount(0);
  await robot.pressPedal();
  await expect(proposal).toContainText("done");
  await robot.releasePedal();
});

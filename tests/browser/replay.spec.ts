/** A recording in the console: the same pages, marked as what they show, with nothing to ask for. */
import { ConsolePage } from "./console_page";
import { expect, test } from "./fixtures";

test("a recording plays in the console to its last tick, and nobody can take control", async ({
  robot,
  stack,
  page,
}) => {
  await robot.unlockRobot();
  await robot.axis("Lateral").enable();
  await robot.button("Pull E-stop").click();
  await expect(robot.estop).toHaveText("⬣ PULLED");
  await expect(robot.mode).toContainText("LOCKED");
  const replay = await stack.replay();
  try {
    await page.goto(replay.url);
    const shown = new ConsolePage(page, replay);
    await shown.logIn("admin", replay.password);
    await expect(page.getByText("REPLAY OF A RECORDING: NOTHING MOVES")).toBeVisible();
    await expect(page.getByText("Nobody is in control: a recording plays")).toBeVisible();
    await expect(shown.panel("Motors")).toContainText("A recording plays: there is nothing to move.");
    await expect(shown.estop).toHaveText("⬣ PULLED");
    await expect(shown.mode).toContainText("LOCKED");
    await expect(page.getByRole("region", { name: "Bench" })).toHaveCount(0);
    await expect(page.getByRole("region", { name: "Why not moving?" })).toContainText("E-stop");
  } finally {
    await replay.end();
  }
});

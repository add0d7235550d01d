/** What holds motion still from outside: a scan, and a breathing gate. */
import { expect, test } from "./fixtures";

test("a scan is shown in the header without moving the page, and nothing is approved until it has ended", async ({
  page,
  robot,
}) => {
  await robot.unlockRobot();
  const axis = robot.axis("Lateral");
  await axis.enable();
  const header = page.locator("header.header");
  const before = await header.boundingBox();
  const status = robot.panel("Status");
  await status.getByRole("button", { name: "Hold still for a scan" }).click();
  const strip = page.getByRole("status", { name: "Scan" });
  await expect(strip).toHaveText(/HELD STILL FOR A SCAN for \d+ s, by \w+, session \d+\. Nothing moves/);
  expect(await header.boundingBox()).toEqual(before);
  await axis.propose("-1");
  await expect(await axis.expectRefusal("SCANNING")).toContainText(
    "Wait for its end, or end it in the console",
  );
  await robot.open("Proposals");
  await expect(strip).toBeVisible();
  await robot.open("Robot");
  await status.getByRole("button", { name: "Scan has ended" }).click();
  await expect(strip).toBeHidden();
});

test("a breathing gate in use is shown with its state, and turned off by whoever is in control", async ({
  page,
  robot,
}) => {
  await robot.unlockRobot();
  const status = robot.panel("Status");
  await status.getByRole("button", { name: "Use the gate" }).click();
  await expect(page.locator(".mode-strip")).toContainText("Breathing gate: no signal.");
  await status.getByRole("button", { name: "Turn the gate off" }).click();
  await expect(page.locator(".mode-strip")).not.toContainText("Breathing gate");
});

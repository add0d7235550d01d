/** One line for what asks somebody to act, and a list behind it. */
import { expect, test } from "./fixtures";

test("the worst alarm stands in a line of fixed height and in the tab's title, on every page, until it is over", async ({
  page,
  robot,
}) => {
  await robot.unlockRobot();
  const header = page.locator("header.header");
  const line = page.locator(".alarm-line[data-priority]");
  await expect(line).toHaveCount(0);
  await expect(page).toHaveTitle("neuro · READY · Interlock");
  const before = await header.boundingBox();
  await robot.button("Pull E-stop").click();
  await expect(line).toContainText("ESTOP The E-stop was pulled, or its loop is broken.");
  await expect(line).toHaveAttribute("data-priority", "high");
  await expect(page).toHaveTitle("⚠ ESTOP · neuro · LOCKED · Interlock");
  expect(await header.boundingBox()).toEqual(before);
  await robot.open("Plots");
  await expect(line).toBeVisible();
  await robot.open("Robot");
  await line.getByRole("button", { name: "1 alarm" }).click();
  const list = page.getByRole("region", { name: "Alarms", exact: true });
  await expect(list).toContainText("Priority high, a person's doing, since");
  await list.getByRole("button", { name: "Acknowledge ESTOP" }).click();
  await expect(list).toContainText("Acknowledged by admin");
  await expect(page).toHaveTitle("neuro · LOCKED · Interlock");
  await expect(line).toContainText("The E-stop was pulled");
  await robot.button("Release E-stop").click();
  await robot.unlockRobot();
  await expect(line).toHaveCount(0);
  expect(await header.boundingBox()).toEqual(before);
});

test("one event of the bus is one alarm, and two clicks lead out of it", async ({ page, robot, stack }) => {
  await robot.unlockRobot();
  const motors: { slot: number; title: string }[] = await (
    await page.request.get(new URL("/api/motors", stack.url).href)
  ).json();
  const power = async (on: boolean): Promise<void> => {
    for (const { slot } of motors) await stack.plant("card_power", { slot, on });
  };
  await power(false);
  const line = page.locator(".alarm-line[data-priority]");
  await expect(line).toContainText("and 5 more: cards were lost together, so hardly by a cable of one.");
  await power(true);
  await line.getByRole("button", { name: "1 alarm" }).click();
  const list = page.getByRole("region", { name: "Alarms", exact: true });
  await expect(list.getByRole("listitem")).toHaveCount(1);
  await list.getByRole("button", { name: "Clear and enable all" }).click();
  await robot.expectMode("READY");
  for (const { title } of motors) await robot.axis(title).expectState("ENABLED");
  await expect(line).toHaveCount(0);
});

test("sound is asked for, kept on this computer and can be paused", async ({ page, robot }) => {
  await robot.button("Pull E-stop").click();
  const open = page.getByRole("button", { name: "1 alarm" });
  await open.click();
  const sound = page.getByLabel("Sound", { exact: true });
  await expect(sound).not.toBeChecked();
  await sound.check();
  await expect(robot.button("Pause sound for 2 min")).toBeVisible();
  await page.reload();
  await open.click();
  await expect(sound).toBeChecked();
});

test("an alarm and its list fit a phone", async ({ page, robot }) => {
  await page.setViewportSize({ width: 360, height: 740 });
  await robot.button("Pull E-stop").click();
  const line = page.locator(".alarm-line[data-priority]");
  await expect(line).toBeVisible();
  await line.getByRole("button", { name: "1 alarm" }).click();
  await expect(page.getByRole("button", { name: "Acknowledge ESTOP" })).toBeInViewport();
  const width = await page.evaluate(() => document.documentElement.scrollWidth);
  expect(width).toBeLessThanOrEqual(360);
});

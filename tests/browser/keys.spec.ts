/** The theme that a user chooses, and what the keys do. */
import { expect, test } from "./fixtures";

test("the theme that a user chose is there again after a reload", async ({ robot, page }) => {
  await robot.chooseTheme("light");
  await page.reload();
  await expect(robot.button("Theme: light")).toBeVisible();
  const scheme = await page.evaluate(() => getComputedStyle(document.documentElement).colorScheme);
  expect(scheme).toBe("light");
});

test("? shows what the keys do, and is a letter where somebody types", async ({ robot, page }) => {
  const help = robot.panel("What the keys do");
  await page.keyboard.press("?");
  await expect(help).toContainText("STOP, at once");
  await page.keyboard.press("?");
  await expect(help).toHaveCount(0);
  await robot.axis("Lateral").row.getByRole("textbox").press("?");
  await expect(help).toHaveCount(0);
  await robot.button("Keys").click();
  await expect(help).toBeVisible();
  await robot.stop.click();
  await expect(robot.stopAnswer).toHaveText("STOP accepted");
  await page.keyboard.press("Escape");
  await expect(robot.stopAnswer).toHaveText("STOP accepted");
  await expect(help).toHaveCount(0);
});

test("? leads to the first steps from every page, whatever was proposed before", async ({ robot, page }) => {
  await robot.unlockRobot();
  await robot.axis("Lateral").enable();
  await robot.axis("Lateral").propose("-1");
  await robot.open("Codes");
  await page.keyboard.press("?");
  await robot.button("Show the first steps").click();
  await expect(robot.panel("What the keys do")).toHaveCount(0);
  await expect(robot.panel("First steps")).toBeVisible();
});

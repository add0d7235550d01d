/** The robot, its target and where it could go, in the scanner; also for a browser that cannot draw it. */
import { expect, test } from "./fixtures";

const targeting = { entry_point: [8, 250, 70], target_point: [5, 200, 60] };
const registration = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

test.beforeEach(async ({ robot, page }) => {
  await robot.expectMode("LOCKED");
  await robot.openCase();
  const set = await page.evaluate(
    async (bodies) => {
      const put = (what: string, body: string) => fetch(`/api/targeting/${what}`, { method: "PUT", body });
      return [(await put("target", bodies[0])).status, (await put("registration", bodies[1])).status];
    },
    [
      JSON.stringify(targeting),
      JSON.stringify({ registration, override_reason: "There is no scanner." }),
    ] as const,
  );
  expect(set).toEqual([200, 200]);
});

test("shows the target, and says what it does not show", async ({ robot, page }) => {
  await robot.open("3D");
  const panel = robot.panel("3D");
  const picture = panel.getByRole("img", {
    name: /^3D: .*desired treatment point .*target 5\.0, 200\.0, 60\.0/,
  });
  await expect(picture).toBeVisible();
  await expect(panel).toContainText("▲ Not shown. NOT_HOMED");
  let before = await picture.screenshot();
  for (const title of [
    "Axial, from the feet",
    "Coronal, from the front",
    "Sagittal, from the right",
    "Oblique",
  ]) {
    await panel.getByRole("button", { name: title }).click();
    await expect
      .poll(async () => before.equals(await picture.screenshot()), `seen from elsewhere: ${title}`)
      .toBe(false);
    before = await picture.screenshot();
  }
  const [inside, window] = await page.evaluate(() => [
    document.documentElement.scrollWidth,
    document.documentElement.clientWidth,
  ]);
  expect(inside).toBe(window);
});

test("a browser without WebGL has the words", async ({ robot, page }) => {
  await page.evaluate(() => {
    HTMLCanvasElement.prototype.getContext = () => null;
  });
  await robot.open("3D");
  const words = robot.panel("3D").getByRole("status").filter({ hasText: "no WebGL" });
  await expect(words).toContainText("desired treatment point");
  await expect(words).toContainText("target 5.0, 200.0, 60.0, in mm RAS");
});

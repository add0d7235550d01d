/** The walk-through of the first move. */
import { expect, test } from "./fixtures";

test("the first steps lead from login to the pedal, each as the one before is done", async ({
  front,
  stack,
}) => {
  await front.logIn("admin", stack.password);
  await front.button("Show the first steps").click();
  const steps = front.panel("First steps");
  const now = steps.getByRole("listitem").and(front.page.locator("[aria-current=step]"));
  await expect(now).toContainText("Take control");
  await front.takeControl();
  await expect(now).toContainText("Unlock");
  await front.unlockRobot();
  await expect(now).toContainText("Enable an axis");
  await front.axis("Probe rotation").enable();
  await expect(now).toContainText("Propose a move");
  await front.axis("Probe rotation").propose("2");
  await expect(now).toContainText("Press the pedal");
  await front.button("Close the first steps").click();
  await expect(steps).toHaveCount(0);
});

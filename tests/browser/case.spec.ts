/** Cases: what registration, entry and target belong to, against the real processes. */
import { readFileSync } from "node:fs";
import type { Page } from "@playwright/test";
import type { ConsolePage } from "./console_page";
import { expect, test } from "./fixtures";
import type { Stack } from "./stack";

const password = "correct horse battery";
/** Where the robot's file expects it, and points in the scanner then. */
const straight = [1, 0, 0, -18, 0, 1, 0, -185, 0, 0, 1, -73, 0, 0, 0, 1];
const points = { Entry: [-10, 65, -3], Target: [-13, 15, -13] } as const;

const field = (page: Page, name: string) =>
  page.getByRole("textbox", { name: `${name}, scanner RAS, mm`, exact: true });

async function setTarget(robot: ConsolePage): Promise<void> {
  for (const [name, values] of Object.entries(points))
    for (const [at, row] of ["R", "A", "S"].entries())
      await field(robot.page, `${name} ${row}`).fill(String(values[at]));
  await robot.button("Set target").click();
  await expect(robot.panel("Entry, target and probe")).toContainText("As received.");
}

async function setRegistration({ page }: ConsolePage, stack: Stack): Promise<void> {
  const registration = new URL("/api/targeting/registration", stack.url).href;
  expect((await page.request.put(registration, { data: { registration: straight } })).status()).toBe(200);
}

test.beforeEach(async ({ robot }) => {
  await robot.expectMode("LOCKED");
});

test("a target is set in an open case alone, and the case takes notes", async ({ robot, page }) => {
  await robot.open("Targeting");
  const panel = robot.panel("Case");
  const aim = robot.panel("Entry, target and probe");
  await expect(panel).toContainText("No case is open.");
  await expect(aim).toContainText("Open a case first.");
  await expect(robot.panel("Registration")).toContainText("Open a case first.");
  await expect(field(page, "Target S")).toHaveAttribute("readonly");
  await expect(robot.button("Open case")).toBeDisabled();
  await panel.getByRole("textbox", { name: "Label" }).fill("phantom 12");
  await page.keyboard.press("Enter");
  await expect(panel).toContainText("Case 1: phantom 12");
  await expect(panel).toContainText(/robot neuro, opened .* by admin/);
  await setTarget(robot);
  await expect(aim).toContainText(/Set \d+ s ago by admin/);
  await panel.getByRole("textbox", { name: "Note" }).fill("The coil is on the left.");
  await page.keyboard.press("Enter");
  await expect(panel.getByRole("list", { name: "Notes" })).toContainText("admin: The coil is on the left.");
});

test("suspending takes registration and poses out of force at once, and resuming brings them back", async ({
  robot,
  page,
  stack,
}) => {
  await robot.openCase();
  await setRegistration(robot, stack);
  await robot.open("Targeting");
  await setTarget(robot);
  const panel = robot.panel("Case");
  const alignment = robot.panel("Alignment");
  await expect(alignment.getByRole("row")).toHaveCount(8);
  await robot.button("Suspend").click();
  await expect(panel).toContainText("The case is suspended: admin suspended it.");
  await expect(alignment).toContainText("NO_REGISTRATION");
  await expect(alignment.getByRole("row")).toHaveCount(0);
  await expect(robot.panel("Registration")).toContainText("The case is suspended");
  await expect(robot.panel("Entry, target and probe")).toContainText("Resume the case first.");
  await expect(panel.getByRole("row", { name: /^Target/ })).toContainText(
    /-13\.00, 15\.00, -13\.00.*by admin/,
  );
  await expect(panel.getByRole("row", { name: /^Registration/ })).toContainText("origin at -18.00");
  await robot.button("Resume: I have looked at it").click();
  await expect(alignment.getByRole("row")).toHaveCount(8);
  await expect(field(page, "Target A")).toHaveValue("15");
  await expect(field(page, "Target A")).not.toHaveAttribute("readonly");
});

test("closing asks, ends all of it, and the next case begins empty", async ({ robot, page, stack }) => {
  await robot.openCase();
  await setRegistration(robot, stack);
  await robot.open("Targeting");
  await setTarget(robot);
  await field(page, "Entry R").fill("9");
  await robot.button("Close case").click();
  await robot.button("Close case 1").click();
  await expect(robot.panel("Case")).toContainText("No case is open.");
  await expect(field(page, "Target A")).toHaveValue("");
  await robot.openCase("phantom 13");
  await expect(robot.panel("Case")).toContainText("Case 2: phantom 13");
  for (const name of ["Entry R", "Target A", "Registration R x"])
    await expect(field(page, name)).toHaveValue("");
  await expect(robot.panel("Registration")).toContainText("The registration is not set.");
  await expect(robot.panel("History")).toContainText("No change was noted yet.");
});

test("an earlier case is exported as JSON, and deleted by an administrator alone", async ({
  robot,
  other,
  page,
}) => {
  await robot.addUser("ann", "engineer", password);
  await robot.openCase("phantom 12");
  await robot.open("Targeting");
  await setTarget(robot);
  await robot.button("Close case").click();
  await robot.button("Close case 1").click();
  const panel = robot.panel("Case");
  await panel.getByText("Earlier cases").click();
  const downloaded = page.waitForEvent("download");
  await robot.button("Export case 1").click();
  const file = await downloaded;
  expect(file.suggestedFilename()).toBe("case-1.json");
  expect(JSON.parse(readFileSync(await file.path(), "utf8"))).toMatchObject({
    schema: "interlock.case/1",
    number: 1,
    label: "phantom 12",
    state: "closed",
    targeting: { target_point: points.Target },
  });

  await other.logIn("ann", password);
  await other.open("Targeting");
  await other.panel("Case").getByText("Earlier cases").click();
  await expect(other.button("Export case 1")).toBeEnabled();
  await expect(other.button("Delete case 1")).toBeDisabled();
  await robot.button("Delete case 1").click();
  await robot.button("Cancel").click();
  await expect(panel.getByRole("row", { name: "Case 1" })).toBeVisible();
  await robot.button("Delete case 1").click();
  await robot.button("Delete it for good").click();
  await expect(panel.getByText("Earlier cases")).toHaveCount(0);
});

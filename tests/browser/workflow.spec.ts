/** The guided way through a case, and the forms of motions that are typed, against the real processes. */
import type { Page } from "@playwright/test";
import { expect, test } from "./fixtures";

/** Where the robot's file expects it. */
const straight = [1, 0, 0, -18, 0, 1, 0, -185, 0, 0, 1, -73];
const cells = ["R", "A", "S"].flatMap((row) =>
  ["x", "y", "z", "origin"].map((column) => `Registration ${row} ${column}`),
);

const field = (page: Page, name: string) =>
  page.getByRole("textbox", { name: `${name}, scanner RAS, mm`, exact: true });

/** Counts presses of the pointer on the page from now on. */
async function countPresses(page: Page): Promise<() => Promise<number>> {
  await page.evaluate(() => {
    const { dataset } = document.documentElement;
    dataset.presses = "0";
    addEventListener("pointerdown", () => (dataset.presses = String(Number(dataset.presses) + 1)), true);
  });
  return () => page.evaluate(() => Number(document.documentElement.dataset.presses));
}

test("the workflow leads from opening a case to closing it", async ({ front: robot, page, stack }) => {
  await robot.logIn("admin", stack.password);
  const presses = await countPresses(page);
  await robot.open("Workflow");
  const workflow = robot.panel("Workflow");
  const step = (title: string) => workflow.getByRole("listitem", { name: title, exact: true });
  const api = (path: string) => new URL(`/api/${path}`, stack.url).href;
  const now = workflow.getByRole("listitem").and(page.locator("[aria-current=step]"));
  const runs = async (id: number): Promise<void> => {
    await expect(robot.panel(`Proposal ${id}`)).toBeVisible();
    await robot.approve(id);
    await expect(robot.panel(`Proposal ${id}`)).toContainText("approved");
    await robot.pressPedal();
  };

  await expect(workflow.getByRole("listitem")).toHaveCount(12);
  await expect(now).toContainText("Open a case");
  await workflow.getByRole("textbox", { name: "Label" }).fill("phantom 12");
  await page.keyboard.press("Enter");
  await expect(step("Open a case")).toContainText("Case 1: phantom 12 is open.");
  await expect(robot.control).toHaveText("You are in control");

  await expect(now).toContainText("Home the robot");
  await robot.button("Unlock and enable all axes").click();
  await expect(step("Home the robot")).toContainText("7 axes are not homed.");
  // Homing by the switches takes minutes of the robot's time; motors.spec.ts waits for it.
  for (const { slot } of (await (await page.request.get(api("motors"))).json()) as { slot: number }[])
    await expect
      .poll(async () =>
        (
          await page.request.post(api(`motors/${slot}/set-home`), { data: { override_switch: true } })
        ).status(),
      )
      .toBe(200);
  await expect(step("Home the robot")).toContainText("All 7 axes are homed, 7 of them by hand.");

  await expect(now).toContainText("Registration");
  for (const [at, name] of cells.entries()) await field(page, name).fill(String(straight[at]));
  await page.keyboard.press("Enter");
  await expect(step("Registration")).toContainText("The registration is valid.");
  await expect(step("Image")).toContainText("No imager was heard in this case.");

  await expect(now).toContainText("Entry and target");
  const view = await page.request.get(new URL("/api/targeting/alignment", stack.url).href);
  const { current } = (await view.json()) as { current: number[] };
  const [x = 0, y = 0, z = 0] = [current[3], current[7], current[11]];
  // As in targeting.spec.ts: within reach from home, and not at it.
  for (const [name, point] of [
    ["Entry", [x - 1, y + 36, z + 1]],
    ["Target", [x - 1, y - 2, z - 1]],
  ] as const)
    for (const [at, row] of ["R", "A", "S"].entries())
      await field(page, `${name} ${row}`).fill((point[at] ?? 0).toFixed(3));
  await page.keyboard.press("Enter");

  await expect(now).toContainText("Review the motion");
  await robot.button("Propose desired pose").click();
  await expect(step("Review the motion")).toContainText("Proposal 1 passed its checks.");
  await expect(now).toContainText("Align the robot");
  await runs(1);
  await expect(step("Align the robot")).toContainText("Each axis that places the probe is at its setpoint.");
  // Two presses of the pedal besides, which is no button of the page here.
  expect(await presses()).toBeLessThanOrEqual(8 - 2);
  await robot.releasePedal();

  await expect(now).toContainText("Confirm by an image");
  const confirmed = page.getByLabel("An image shows the probe where it is to be");
  await confirmed.check();
  await expect(now).toContainText("Insert");
  await robot.button("Propose insertion").click();
  await runs(2);
  const confirming = robot.button("Confirm insertion of proposal 2");
  await expect(confirming).toBeVisible();
  await robot.releasePedal();
  await confirming.click();
  await expect(confirming).toHaveCount(0);
  await robot.pressPedal();
  await expect(step("Insert")).toContainText("is at the depth that the target asks.");
  await robot.releasePedal();
  await expect(confirmed).not.toBeChecked();
  await expect(now).toContainText("Confirm by an image");
  await confirmed.check();

  await expect(now).toContainText("Ablate");
  await page.getByLabel("Ablate: done").check();
  await expect(now).toContainText("Retract");
  await robot.button("Retract probe").click();
  await runs(3);
  await expect(step("Retract")).toContainText("The probe is out.");
  await robot.releasePedal();

  await expect(now).toContainText("Next target, or close the case");
  await robot.button("Close case").click();
  await robot.button("Close case 1").click();
  await expect(now).toContainText("Open a case");
  await expect(page.getByLabel("Ablate: done")).not.toBeChecked();
});

test("a step says what it waits for, and nothing is done before it is", async ({ robot, page }) => {
  await robot.open("Workflow");
  const workflow = robot.panel("Workflow");
  await expect(workflow.getByRole("listitem").and(page.locator("[data-state=done]"))).toHaveCount(0);
  await robot.openCase();
  await expect(workflow.getByRole("listitem").and(page.locator("[data-state=done]"))).toHaveCount(1);
  await expect(workflow.getByRole("listitem", { name: "Registration" })).toContainText(
    "The registration is not set.",
  );
  await expect(page.getByLabel("An image shows the probe where it is to be")).toBeDisabled();
  await expect(robot.button("Retract probe")).toBeEnabled();
  await robot.button("Retract probe").click();
  await expect(workflow.getByRole("alert")).toContainText("Refused:");
});

test("typed motions are proposed with the numbers that were typed, and wrong ones say why", async ({
  robot,
  page,
}) => {
  await robot.unlockRobot();
  await robot.axis("Probe rotation").setHome();
  await robot.axis("Probe insertion").setHome(true);
  for (const title of ["Probe rotation", "Probe insertion"]) await robot.axis(title).enable();
  const sent: unknown[] = [];
  page.on("request", (request) => {
    if (request.method() === "POST" && request.url().endsWith("/api/proposals"))
      sent.push(request.postDataJSON());
  });
  const degrees = (angle: number): unknown => expect.closeTo((angle * Math.PI) / 180, 9);

  await page.getByLabel("Robot mode", { exact: true }).selectOption("coordinated");
  await page.getByRole("link", { name: "Form of the mode coordinated" }).click();
  const panel = robot.panel("Propose a motion");
  const propose = panel.getByRole("button", { name: "Propose motion" });
  const alert = panel.getByRole("alert");
  await propose.click();
  await expect(alert).toContainText("No axis has a target");
  const rotation = panel.getByRole("textbox", { name: /^Probe rotation target, degrees/ });
  await rotation.fill("400");
  await panel.getByRole("textbox", { name: "Shortest duration, s" }).fill("soon");
  await expect(alert).toContainText("Probe rotation: 400 is outside its range; expected -35");
  await expect(alert).toContainText("Shortest duration: “soon” is no number; expected 0 to 3600 s.");
  await rotation.fill("-12,5");
  await panel.getByRole("textbox", { name: /^Probe insertion target, millimetres/ }).fill("4");
  await panel.getByRole("textbox", { name: "Shortest duration, s" }).fill("3");
  await expect(panel.getByText("Not sent:")).toHaveCount(0);
  await page.keyboard.press("Enter");
  await expect(robot.panel("Proposal 1")).toContainText("checked");
  expect(sent).toEqual([
    { kind: "coordinated", targets: { probe_rotation: degrees(-12.5), insertion: 4 }, duration_s: 3 },
  ]);
  await robot.button("Reject proposal 1").click();

  await panel.getByLabel("Kind").selectOption("Ablation in steps");
  const cell = (step: number, name: string) =>
    panel.getByRole("textbox", { name: new RegExp(`^Step ${step} ${name},`) });
  const fill = async (step: number, ...texts: string[]): Promise<void> => {
    for (const [at, name] of ["rotation", "depth", "rest"].entries())
      await cell(step, name).fill(texts[at] ?? "");
  };
  await fill(1, "10", "ten", "1");
  await propose.click();
  await expect(alert).toContainText("Step 1, depth: “ten” is no number; expected");
  await cell(1, "depth").fill("5");
  await robot.button("Add step").click();
  await expect(cell(2, "rotation")).toBeFocused();
  await fill(2, "20", "6", "0.5");
  await robot.button("Add step").press("Enter");
  await fill(3, "30", "7", "2");
  await robot.button("Move step 3 up").press("Enter");
  await expect(robot.button("Move step 2 up")).toBeFocused();
  await robot.button("Remove step 1").click();
  await cell(2, "rest").press("Enter");
  await expect(robot.panel("Proposal 2")).toContainText("Ablation");
  expect(sent.slice(1)).toEqual([
    {
      kind: "ablation",
      steps: [
        { probe_rotation: degrees(30), insertion: 7, dwell_s: 2 },
        { probe_rotation: degrees(20), insertion: 6, dwell_s: 0.5 },
      ],
    },
  ]);
});

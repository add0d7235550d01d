/** The guided way through a case, and the forms of motions that are typed, against the real processes. */
import { readFileSync } from "node:fs";
import path from "node:path";
import type { Locator, Page } from "@playwright/test";
import type { ConsolePage } from "./console_page";
import { expect, test } from "./fixtures";
import type { Stack } from "./stack";

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

/** The page Workflow of one robot, and how somebody goes through it. */
class Walk {
  readonly workflow: Locator;
  readonly now: Locator;

  constructor(
    readonly robot: ConsolePage,
    private readonly page: Page,
    private readonly stack: Stack,
  ) {
    this.workflow = robot.panel("Workflow");
    this.now = this.workflow.getByRole("listitem").and(page.locator("[aria-current=step]"));
  }

  step(title: string): Locator {
    return this.workflow.getByRole("listitem", { name: title, exact: true });
  }

  api(path: string): string {
    return new URL(`/api/${path}`, this.stack.url).href;
  }

  async runs(id: number): Promise<void> {
    await expect(this.robot.panel(`Proposal ${id}`)).toBeVisible();
    const approve = this.robot.button(`Approve proposal ${id}`);
    // An approval that comes late on a busy machine is refused, and given again.
    await expect(async () => {
      await approve.click();
      await expect(approve).toHaveCount(0, { timeout: 2000 });
    }).toPass();
    await this.robot.pressPedal();
  }

  async openCase(label: string): Promise<void> {
    await this.robot.open("Workflow");
    await expect(this.workflow.getByRole("listitem")).toHaveCount(12);
    await expect(this.now).toContainText("Open a case");
    await this.workflow.getByRole("textbox", { name: "Label" }).fill(label);
    await this.page.keyboard.press("Enter");
    await expect(this.step("Open a case")).toContainText(`Case 1: ${label} is open.`);
    await expect(this.robot.control).toHaveText("You are in control");
  }

  async homeAtTheSwitches(id: number, axes: number): Promise<void> {
    await expect(this.now).toContainText("Home the robot");
    await this.robot.button("Unlock and enable all axes").click();
    await expect(this.step("Home the robot")).toContainText(`${axes} axes are not homed.`);
    await this.robot.button("Set home, and propose homing").click();
    await this.runs(id);
    await expect(this.step("Home the robot")).toContainText(`All ${axes} axes are homed`);
    await this.robot.releasePedal();
  }

  /** By hand: this robot needs minutes to its switches; motors.spec.ts waits for them. */
  async homeByHand(axes: number): Promise<void> {
    await expect(this.now).toContainText("Home the robot");
    await this.robot.button("Unlock and enable all axes").click();
    await expect(this.step("Home the robot")).toContainText(`${axes} axes are not homed.`);
    const motors = await (await this.page.request.get(this.api("motors"))).json();
    for (const { slot } of motors as { slot: number }[])
      await expect
        .poll(async () =>
          (
            await this.page.request.post(this.api(`motors/${slot}/set-home`), {
              data: { override_switch: true },
            })
          ).status(),
        )
        .toBe(200);
    await expect(this.step("Home the robot")).toContainText(
      `All ${axes} axes are homed, ${axes} of them by hand.`,
    );
  }

  async register(upperRows: readonly number[]): Promise<void> {
    await expect(this.now).toContainText("Registration");
    for (const [at, name] of cells.entries()) await field(this.page, name).fill(String(upperRows[at]));
    await this.page.keyboard.press("Enter");
    await expect(this.step("Registration")).toContainText("The registration is valid.");
    await expect(this.step("Image")).toContainText("No imager was heard in this case.");
  }

  async aim(entry: readonly number[], target: readonly number[]): Promise<void> {
    await expect(this.now).toContainText("Entry and target");
    for (const [name, point] of [
      ["Entry", entry],
      ["Target", target],
    ] as const)
      for (const [at, row] of ["R", "A", "S"].entries())
        await field(this.page, `${name} ${row}`).fill((point[at] ?? 0).toFixed(3));
    await this.page.keyboard.press("Enter");
  }

  async align(id: number): Promise<void> {
    await expect(this.now).toContainText("Review the motion");
    await this.robot.button("Propose desired pose").click();
    await expect(this.step("Review the motion")).toContainText(`Proposal ${id} passed its checks.`);
    await expect(this.now).toContainText("Align the robot");
    await this.runs(id);
    await expect(this.step("Align the robot")).toContainText(
      "Each axis that places the probe is at its setpoint.",
    );
  }

  async retractAndClose(id: number): Promise<void> {
    await expect(this.now).toContainText("Retract");
    await this.robot.button("Retract probe").click();
    await this.runs(id);
    await expect(this.step("Retract")).toContainText("The probe is out.");
    await this.robot.releasePedal();
    await expect(this.now).toContainText("Next target, or close the case");
    await this.robot.button("Close case").click();
    await this.robot.button("Close case 1").click();
    await expect(this.now).toContainText("Open a case");
  }
}

test("the workflow leads from opening a case to closing it", async ({ front: robot, page, stack }) => {
  await robot.logIn("admin", stack.password);
  const presses = await countPresses(page);
  const walk = new Walk(robot, page, stack);
  // To near their switches.
  await robot.pushByHand({ "Probe insertion": [3, -150], Lateral: [4, 300], "Axial head": [7, 350] });
  await walk.openCase("phantom 12");
  await walk.homeAtTheSwitches(1, 7);
  await walk.register(straight);
  // Those of targeting.spec.ts, where the robot stands here.
  await walk.aim([-10, 65, -3], [-13, 15, -13]);
  await walk.align(2);
  const clicks = await presses();
  // The pedal is pressed twice besides, which is no button of the page here.
  expect(clicks).toBeLessThanOrEqual(8 - 2);
  await robot.releasePedal();

  await expect(walk.now).toContainText("Confirm by an image");
  const confirmed = page.getByLabel("An image shows the probe where it is to be");
  await confirmed.check();
  await expect(walk.now).toContainText("Insert");
  await robot.button("Propose insertion").click();
  await walk.runs(3);
  const confirming = robot.button("Confirm insertion of proposal 3");
  await expect(confirming).toBeVisible();
  await robot.releasePedal();
  await confirming.click();
  await expect(confirming).toHaveCount(0);
  await robot.pressPedal();
  await expect(walk.step("Insert")).toContainText("is at the depth that the target asks.");
  await robot.releasePedal();
  await expect(confirmed).not.toBeChecked();
  await expect(walk.now).toContainText("Confirm by an image");
  await confirmed.check();

  await expect(walk.now).toContainText("Ablate");
  await page.getByLabel("Ablate: done").check();
  await walk.retractAndClose(4);
  await expect(page.getByLabel("Ablate: done")).not.toBeChecked();
});

/** Its sliders start at their inner ends, so that they part without reaching a switch. */
const innerSliders = readFileSync(
  path.join(__dirname, "../../models/plant/prostate.toml"),
  "utf8",
).replaceAll(/start_counts = (-?)375000/g, "start_counts = $1101000");

test.describe("of the prostate robot", () => {
  test.use({ robotName: "prostate", plant: innerSliders });

  test("the workflow leads from opening a case by a biopsy to closing it", async ({ robot, page, stack }) => {
    const walk = new Walk(robot, page, stack);
    await walk.openCase("phantom 13");
    await walk.homeByHand(6);
    const apart = { back_left: 80, front_left: 80, back_right: -80, front_right: -80 };
    const data = { kind: "coordinated", targets: apart };
    expect((await page.request.post(walk.api("proposals"), { data })).status()).toBe(201);
    await walk.runs(1);
    await expect(robot.panel("Proposal 1")).toHaveCount(0);
    await robot.releasePedal();
    await walk.register([1, 0, 0, 0, 0, 1, 0, -11, 0, 0, 1, -90]);
    await walk.aim([2, 7, -136], [2, 7, -86]);
    await walk.align(2);
    await robot.releasePedal();

    await expect(walk.now).toContainText("Confirm by an image");
    await page.getByLabel("An image shows the probe where it is to be").check();
    await expect(walk.now).toContainText("Insert");
    await robot.button("Zero forces").click();
    await robot.button("Propose biopsy of the target").click();
    await walk.runs(3);
    await stack.plant("hand", { newtons: 5 });
    await expect(walk.now).toContainText("Confirm by an image");
    await stack.plant("hand", { newtons: 0 });
    await robot.releasePedal();

    await page.getByLabel("An image shows the probe where it is to be").check();
    await expect(walk.now).toContainText("Biopsy");
    await page.getByLabel("Biopsy: done").check();
    await walk.retractAndClose(4);
  });
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
  await expect(page.getByText("NO_REGISTRATION").first()).toBeVisible();
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

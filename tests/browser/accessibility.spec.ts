/** Every page, and every state of its panels, by axe-core's rules for WCAG 2.2 AA, in the light and in the dark theme. */
import AxeBuilder from "@axe-core/playwright";
import type { Page } from "@playwright/test";
import { headerFields } from "../../web/src/stream/decode";
import type { ConsolePage } from "./console_page";
import { expect, test } from "./fixtures";
import { NavigationProgram } from "./navigation_program";

const rules = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"];
/** Those that a theme can break. */
const colourRules = ["color-contrast", "link-in-text-block"];
const password = "correct horse battery";

/** Of the data's age, in microseconds, in the stream's binary message. */
const AGE_OFFSET = 4 * headerFields.indexOf("age_us");

/** Each place that breaks a rule, with what is wrong there. */
async function violations(axe: AxeBuilder): Promise<string[]> {
  const { violations: found } = await axe.analyze();
  return found.flatMap(({ id, nodes }) =>
    nodes.map(({ target, failureSummary }) => `${id} at ${target.join(" ")}: ${failureSummary}`),
  );
}

/** In both themes; `leftOut` names what an earlier test judged as it is now. */
async function expectNoViolation(page: Page, state: string, leftOut: readonly string[] = []): Promise<void> {
  const axe = (): AxeBuilder => {
    // The page has no frames: axe needs no second page to merge their findings.
    const builder = new AxeBuilder({ page }).setLegacyMode();
    for (const part of leftOut) builder.exclude(part);
    return builder.options({ resultTypes: ["violations"], preload: false });
  };
  await page.emulateMedia({ colorScheme: "light" });
  expect.soft(await violations(axe().withTags(rules)), `${state}, light`).toEqual([]);
  await page.emulateMedia({ colorScheme: "dark" });
  expect.soft(await violations(axe().withRules(colourRules)), `${state}, dark`).toEqual([]);
}

/** The contents of panels, by their titles, that show their colours. */
function coloured(page: Page): Promise<string[]> {
  return page.evaluate(() => {
    const contents = [...document.querySelectorAll("main .panel > :not(.panel-head)")];
    const isGrey = (element: Element | null): boolean =>
      element !== null &&
      (getComputedStyle(element).filter === "grayscale(1)" || isGrey(element.parentElement));
    return contents
      .filter((content) => !isGrey(content))
      .map((content) => content.closest(".panel")?.getAttribute("aria-label") ?? content.className);
  });
}

/** Panels that look the same whatever the axes do, and the rows of axes with which nothing is done. */
const untouched = [
  ...["Log", "Communication", "Navigation", "Status"].map((title) => `[aria-label="${title}"].panel`),
  ...["Yaw", "Pitch", "Axial head", "Axial feet"].map((title) => `[aria-label="Axis ${title}"]`),
];

/** Opens everything in the panels of the robot's page that can be opened. */
async function unfoldPanels(robot: ConsolePage): Promise<void> {
  await robot.panel("Bench").getByText("More faults").click();
  await robot.panel("Bench").getByText("Plant parameters").click();
  const whys = robot.page.getByRole("button", { name: /^Why not moving\?/ });
  await whys.first().click();
}

test("the page before login, and its refusal", async ({ front, page }) => {
  await front.expectMode("LOCKED");
  await expectNoViolation(page, "login");
  await front.tryLogIn("admin", "wrong password");
  await expect(front.loginForm.getByRole("alert")).toContainText("CREDENTIALS");
  await expectNoViolation(page, "refused login");
});

test("the sheets of codes, users, audit and account", async ({ robot, page }) => {
  await robot.addUser("ann", "engineer", password);
  for (const name of ["Codes", "Users", "Audit", "Account"] as const) {
    await robot.open(name);
    await expect(page.getByRole("main")).toBeVisible();
    await expectNoViolation(page, name);
  }
});

test("the plots and the 3D view", async ({ robot, page }) => {
  await robot.open("Plots");
  await expect(robot.panel("Plots").getByRole("img").first()).toHaveAttribute("aria-label", /measured -?\d/);
  await expect(robot.panel("Loop time").getByRole("img").first()).toBeVisible();
  await expectNoViolation(page, "Plots");
  await robot.open("3D");
  const view = robot.panel("3D");
  const words = view.getByRole("status").filter({ hasText: "no WebGL" });
  await expect(view.getByRole("img").or(words)).toBeVisible();
  await expectNoViolation(page, "3D");
});

test("the page of the target, with something wrong, something newer, and what it asks", async ({
  robot,
  other,
  page,
}) => {
  await robot.addUser("vic", "viewer", password);
  const put = (what: string, body: object): Promise<void> =>
    page.evaluate(
      async ([path, text]) => {
        await fetch(path, { method: "PUT", body: text });
      },
      [`/api/targeting/${what}`, JSON.stringify(body)] as const,
    );
  await robot.openCase();
  await put("target", { entry_point: [8, 250, 70], target_point: [60, 200, 60] });
  await put("registration", {
    registration: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1],
    override_reason: "There is no scanner.",
  });
  await robot.open("Targeting");
  await expect(robot.panel("Alignment")).toContainText("clamped");
  const form = page.getByRole("form", { name: "Registration" });
  await form.getByRole("textbox", { name: /^Registration A y/ }).fill("x");
  await page.getByRole("textbox", { name: /^Entry R/ }).fill("9");
  await put("target", { entry_point: [7, 250, 70] });
  await expect(robot.button("Keep mine")).toBeVisible();
  await expectNoViolation(page, "targeting");
  await other.logIn("vic", password);
  await other.open("Targeting");
  await expect(other.panel("Registration")).toContainText("Read only.");
  await expectNoViolation(other.page, "a viewer's targeting");
  await robot.button("Suspend").click();
  await expect(robot.panel("Case")).toContainText("Would be in force");
  await robot.button("Close case").click();
  await expectNoViolation(page, "a suspended case");
});

test("the workflow without a case and in one, and the forms of motions with something wrong", async ({
  robot,
  page,
}) => {
  await robot.open("Workflow");
  await expect(page.getByRole("form", { name: "Open case" })).toBeVisible();
  await expectNoViolation(page, "workflow without a case");
  await robot.openCase();
  const step = (name: string) => robot.panel("Workflow").getByRole("listitem", { name, exact: true });
  await expect(step("Open a case")).toContainText("is open.");
  await step("Registration").getByRole("button").click();
  await expect(robot.panel("Registration")).toBeVisible();
  await robot.button("Close case").click();
  await expectNoViolation(page, "workflow in a case");
  await robot.open("Proposals");
  const form = robot.panel("Propose a motion");
  for (const kind of ["Several axes together", "Ablation in steps"]) {
    await form.getByLabel("Kind").selectOption(kind);
    await form.getByRole("button", { name: "Propose motion" }).click();
    await expect(form.getByRole("alert")).toContainText("Not sent:");
    await expectNoViolation(page, kind);
  }
});

test("the robot's page, locked, with everything unfolded and with the keys shown", async ({
  robot,
  page,
  stack,
}) => {
  const program = await NavigationProgram.connect(stack.igtlPort);
  try {
    program.send("GET_STATUS", "robot_status");
    await robot
      .panel("Navigation")
      .getByText(/names? heard/)
      .click();
    await unfoldPanels(robot);
    await expectNoViolation(page, "unfolded");
    await robot.button("Keys").click();
    await expectNoViolation(page, "keys");
  } finally {
    program.end();
  }
});

test("proposals, refusals and a stalled axis", async ({ robot, page }) => {
  const axis = robot.axis("Probe rotation");
  await robot.unlockRobot();
  await axis.enable();
  await axis.row.getByRole("textbox").fill("400");
  await robot.axis("Lateral").propose("1");
  await robot.axis("Lateral").expectRefusal("DISABLED");
  await expectNoViolation(page, "refused", untouched);
  await page.getByRole("link", { name: "Details of proposal 1" }).click();
  await expect(robot.panel("Proposal 1").getByRole("region", { name: "Profile" })).toBeVisible();
  await expectNoViolation(page, "a proposal as a whole");
  await robot.open("Robot");
  await page.getByRole("button", { name: "Jam Probe rotation" }).click();
  await axis.propose("40");
  await robot.pressPedal();
  await expect(axis.row.getByRole("alert").filter({ hasText: "STALL" })).toBeVisible();
  await expectNoViolation(page, "stalled", untouched);
  await robot.open("Runs");
  await expect(robot.panel("Run 2").getByRole("figure", { name: "Probe rotation" })).toBeVisible();
  await robot.panel("Retention").getByLabel("Runs").fill("19");
  await expectNoViolation(page, "Runs");
});

test("alarms and questions", async ({ robot, page }) => {
  await robot.unlockRobot();
  await robot.axis("Lateral").press("Set Home");
  await robot.button("Zero all").click();
  await expectNoViolation(page, "questions", untouched);
  await robot.panel("Bench").getByText("More faults").click();
  await robot.panel("Bench").getByLabel("Pedal contact NO").selectOption("closed");
  await expect(robot.pedalState).toContainText("CHANNELS DISAGREE");
  await robot.button("Pull E-stop").click();
  await robot.expectMode("LOCKED");
  await expect(robot.estop).toContainText("PULLED");
  await robot.unlock.click();
  await expect(page.getByRole("alert").filter({ hasText: "Unlock refused" })).toBeVisible();
  await expectNoViolation(page, "alarms", untouched);
});

test("a viewer's page, and a request for control", async ({ robot, other }) => {
  await robot.addUser("vic", "viewer", password);
  await robot.addUser("ann", "engineer", password);
  await other.logIn("vic", password);
  await expect(other.panel("Motors")).toContainText("You are logged in as viewer");
  await expectNoViolation(other.page, "viewer");
  await other.button("Log out").click();
  await other.logIn("ann", password);
  await other.button("Request control").click();
  await expect(robot.button("Hand over to ann")).toBeVisible();
  await expectNoViolation(robot.page, "asked for", untouched);
});

for (const [level, ageMs] of [
  ["grey", 600],
  ["covered", 1500],
] as const) {
  test(`data that are ${level}`, async ({ robot, page }) => {
    await robot.unlockRobot();
    await page.routeWebSocket("**/api/stream", (console) => {
      console.connectToServer().onMessage((message) => {
        if (typeof message !== "string") message.writeUInt32LE(ageMs * 1000, AGE_OFFSET);
        console.send(message);
      });
    });
    await page.reload();
    await expect(page.getByRole("main")).toHaveAttribute("data-level", level);
    await expect(robot.axis("Lateral").row).toBeAttached();
    await expectNoViolation(page, level);
    for (const name of ["Robot", "Workflow", "Targeting", "Proposals", "Plots", "3D"] as const) {
      await robot.open(name);
      await expect(page.getByRole("main")).toHaveAttribute("data-level", level);
      expect(await coloured(page), `what is not greyed on ${name}`).toEqual([]);
    }
  });
}

test.describe("the prostate robot", () => {
  test.use({ robotName: "prostate" });

  test("its page while it homes", async ({ robot, page }) => {
    await robot.unlockRobot();
    await unfoldPanels(robot);
    await robot.enableAll();
    await robot.button("Home all").click();
    await robot.approve(1);
    await expect(robot.panel("Homing progress")).toBeVisible();
    await expectNoViolation(page, "homing");
  });
});

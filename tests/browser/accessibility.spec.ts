/** Every page, and every state of its panels, by axe-core's rules for WCAG 2.2 AA, in the light and in the dark theme. */
import AxeBuilder from "@axe-core/playwright";
import type { Page } from "@playwright/test";
import type { ConsolePage } from "./console_page";
import { expect, test } from "./fixtures";
import { NavigationProgram } from "./navigation_program";

const rules = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"];
/** Those that a theme can break. */
const colourRules = ["color-contrast", "link-in-text-block"];
const password = "correct horse battery";

test.describe.configure({ timeout: 300_000 });

/** Each place that breaks a rule, with what is wrong there. */
async function violations(axe: AxeBuilder): Promise<string[]> {
  const { violations: found } = await axe.analyze();
  return found.flatMap(({ id, nodes }) =>
    nodes.map(({ target, failureSummary }) => `${id} at ${target.join(" ")}: ${failureSummary}`),
  );
}

/** In both themes. */
async function expectNoViolation(page: Page, state: string): Promise<void> {
  const axe = (): AxeBuilder =>
    // The page has no frames: axe needs no second page to merge their findings.
    new AxeBuilder({ page }).setLegacyMode().options({ resultTypes: ["violations"], preload: false });
  await page.emulateMedia({ colorScheme: "light" });
  expect.soft(await violations(axe().withTags(rules)), `${state}, light`).toEqual([]);
  await page.emulateMedia({ colorScheme: "dark" });
  expect.soft(await violations(axe().withRules(colourRules)), `${state}, dark`).toEqual([]);
}

/** Opens everything in the panels of the robot's page that can be opened. */
async function unfoldPanels(robot: ConsolePage): Promise<void> {
  await robot.panel("Bench").getByText("More faults").click();
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

/** Pictures of every page for the manual: build/pictures/PAGE-THEME-WIDTHxHEIGHT.png. */
import { mkdirSync } from "node:fs";
import path from "node:path";
import type { Page } from "@playwright/test";
import { expect, test } from "../../tests/browser/fixtures";
import { root } from "../../tests/browser/places";

const folder = path.join(root, "build/pictures");
const sizes = [
  { width: 1280, height: 800 },
  { width: 3840, height: 2160 },
] as const;
const password = "correct horse battery";

test.setTimeout(300_000);

/** In both themes and sizes; the clock and the ages on the page are those of the run. */
async function take(page: Page, name: string): Promise<void> {
  mkdirSync(folder, { recursive: true });
  for (const colorScheme of ["light", "dark"] as const) {
    await page.emulateMedia({ colorScheme });
    for (const size of sizes) {
      await page.setViewportSize(size);
      const file = `${name}-${colorScheme}-${size.width}x${size.height}.png`;
      await page.screenshot({ path: path.join(folder, file), animations: "disabled" });
    }
  }
}

test("the page before login", async ({ front, page }) => {
  await front.expectMode("LOCKED");
  await take(page, "login");
});

test("the robot's page at work, and the sheets", async ({ robot, page }) => {
  await robot.addUser("ann", "engineer", password);
  await robot.unlockRobot();
  for (const title of ["Probe rotation", "Axial feet"]) {
    await robot.axis(title).enable();
    await robot.axis(title).setHome();
  }
  await robot.axis("Probe insertion").propose("30");
  await robot.axis("Probe insertion").expectRefusal("DISABLED");
  await robot.axis("Probe rotation").propose("12.5");
  await robot.pressPedal();
  await expect(robot.proposal(2)).toContainText("done");
  await robot.axis("Probe rotation").propose("200");
  await expect.poll(() => robot.axis("Probe rotation").counts()).toBeGreaterThan(1000);
  await take(page, "robot");
  for (const name of ["Plots", "3D"] as const) {
    await robot.open(name);
    await expect(robot.panel(name)).toBeVisible();
    if (name === "Plots")
      await page.getByRole("combobox", { name: "Axis", exact: true }).selectOption("Probe rotation");
    await take(page, name.toLowerCase());
  }
  await robot.open("Proposals");
  await expect(robot.panel("All proposals")).toBeVisible();
  await take(page, "proposals");
  await robot.stop.click();
  for (const name of ["Codes", "Users", "Audit", "Account"] as const) {
    await robot.open(name);
    await expect(robot.panel(name)).toBeVisible();
    await take(page, name.toLowerCase());
  }
});

test("the page of the runs, two of them over each other", async ({ robot, page }) => {
  await robot.unlockRobot();
  const axis = robot.axis("Probe rotation");
  await axis.enable();
  await axis.setHome();
  for (const [id, last] of [
    [1, 0.1],
    [2, 0.15],
  ]) {
    await page.evaluate(async (rows) => {
      await fetch("/api/trajectory", { method: "PUT", body: rows });
      await fetch("/api/proposals", { method: "POST", body: '{"kind":"trajectory"}' });
    }, `time [s],probe_rotation [rad]\n0,0.05\n1,0.2\n2,${last}\n`);
    await robot.approve(id ?? 0);
    await expect(robot.proposal(id ?? 0)).toContainText("approved");
    await robot.pressPedal();
    await expect(robot.proposal(id ?? 0)).toContainText("done");
    await robot.releasePedal();
  }
  await page.goto(new URL("#/runs/2/1", page.url()).href);
  await expect(robot.panel("Run 2").getByRole("img")).toHaveAttribute("aria-label", /actual #1 /);
  await take(page, "runs");
});

test("the page of a target that is set", async ({ robot, page }) => {
  await robot.openCase("phantom 12");
  const [entry_point, target_point] = [
    [8, 250, 70],
    [5, 200, 60],
  ];
  const registration = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
  await page.evaluate(
    async ([target, registered]) => {
      await fetch("/api/targeting/target", { method: "PUT", body: target });
      await fetch("/api/targeting/registration", { method: "PUT", body: registered });
    },
    [
      JSON.stringify({ entry_point, target_point }),
      JSON.stringify({ registration, override_reason: "There is no scanner." }),
    ] as const,
  );
  await robot.open("Workflow");
  await expect(robot.panel("Workflow").getByRole("listitem").first()).toContainText("is open.");
  await take(page, "workflow");
  await robot.open("Targeting");
  await expect(robot.panel("History").getByRole("row")).toHaveCount(3);
  await expect(robot.panel("Alignment").getByRole("table")).toBeVisible();
  await take(page, "targeting");
});

test("the robot's page with everything unfolded, and covered", async ({ robot, page, stack }) => {
  await robot.panel("Bench").getByText("More faults").click();
  await page
    .getByRole("button", { name: /^Why not moving\?/ })
    .first()
    .click();
  await robot.button("Keys").click();
  await take(page, "robot-help");
  await robot.button("Keys").click();
  stack.signalApp("SIGSTOP");
  try {
    await expect(page.getByRole("main")).toHaveAttribute("data-level", "covered");
    await take(page, "robot-covered");
  } finally {
    stack.signalApp("SIGCONT");
  }
});

test.describe("the prostate robot", () => {
  test.use({ robotName: "prostate" });

  test("its page", async ({ robot, page }) => {
    await robot.unlockRobot();
    await take(page, "prostate");
    await robot.openCase("phantom 13");
    await robot.open("Workflow");
    await expect(robot.panel("Workflow").getByRole("listitem", { name: "Biopsy" })).toBeVisible();
    await take(page, "prostate-workflow");
  });
});

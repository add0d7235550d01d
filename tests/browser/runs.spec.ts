/** Every motion that was carried out: found again, looked at, compared, noted and kept. */
import { readFileSync } from "node:fs";
import type { Locator, Page } from "@playwright/test";
import type { ConsolePage } from "./console_page";
import { expect, test } from "./fixtures";
import { Keyboard } from "./keyboard";

const password = "correct horse battery";
/** So long that nobody waits for its end. */
const LONG_S = 120;

async function ready(robot: ConsolePage): Promise<void> {
  await robot.unlockRobot();
  const axis = robot.axis("Probe rotation");
  await axis.setHome();
  await axis.enable();
}

/** Proposes a motion that is planned in time, back or forth by its number, approves it and presses the pedal. */
async function begin(robot: ConsolePage, number: number, duration_s = 0): Promise<void> {
  const targets = { probe_rotation: number % 2 === 1 ? 0.1 : 0.05 };
  const body = JSON.stringify({ kind: "coordinated", targets, ...(duration_s > 0 ? { duration_s } : {}) });
  const status = await robot.page.evaluate(
    async (draft) => (await fetch("/api/proposals", { method: "POST", body: draft })).status,
    body,
  );
  expect(status).toBe(201);
  await robot.approve(number);
  await expect(robot.proposal(number)).toContainText("approved");
  await robot.pressPedal();
}

async function carryOut(robot: ConsolePage, number: number): Promise<void> {
  await begin(robot, number);
  await expect(robot.proposal(number)).toContainText("done");
  await robot.releasePedal();
}

/** Of a run in the list. */
const line = (robot: ConsolePage, number: number): Locator =>
  robot
    .panel("Runs")
    .getByRole("listitem")
    .filter({ hasText: new RegExp(`^#${number} `) });

const chart = (panel: Locator, axis: string): Locator =>
  panel.getByRole("figure", { name: axis, exact: true }).getByRole("img");

const sidewards = (page: Page): Promise<number> =>
  page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);

test("a motion that was made is in the list with its outcome, and a reload shows its plot again", async ({
  robot,
  page,
}) => {
  await ready(robot);
  await carryOut(robot, 1);
  await robot.open("Runs");
  const run = robot.panel("Run 1");
  await expect(line(robot, 1)).toContainText("Coordinated: Probe rotation");
  await expect(line(robot, 1)).toContainText("✓done");
  await expect(line(robot, 1)).toContainText(/largest deviation \d+\.\d+°/);
  await line(robot, 1).getByRole("link").click();
  for (const look of ["at first", "reloaded"]) {
    await expect(page, look).toHaveURL(/#\/runs\/1$/);
    // Without a cursor the chart says where both ended: its target is 0.1 rad.
    await expect(chart(run, "Probe rotation"), look).toHaveAttribute(
      "aria-label",
      /planned 5\.7\d °, actual/,
    );
    const cells = run.getByRole("row", { name: /^Probe rotation/ }).getByRole("cell");
    await expect(cells.nth(1), look).toHaveText(/^5\.7\d°$/);
    await expect(cells.nth(4), look).toHaveText(/^\d+\.\d+°$/);
    await expect(run.getByRole("definition").filter({ hasText: /^admin$/ }), look).toBeVisible();
    await page.reload();
  }
});

test("a reload keeps which axes are drawn, and what the list is narrowed to", async ({ robot, page }) => {
  await ready(robot);
  await carryOut(robot, 1);
  await robot.open("Runs");
  const run = robot.panel("Run 1");
  await run.getByRole("button", { name: "Probe rotation", pressed: true }).click();
  await expect(run.getByText("No axis is drawn")).toBeVisible();
  const outcome = robot.panel("Runs").getByLabel("Outcome");
  await outcome.selectOption("aborted");
  await expect(robot.panel("Runs")).toContainText("No run fits these choices.");
  await page.reload();
  await expect(robot.panel("Runs")).toContainText("No run fits these choices.");
  await robot.button("Show all runs").click();
  await expect(outcome).toHaveValue("");
  await expect(run.getByText("No axis is drawn")).toBeVisible();
});

test("an empty list says what makes a run", async ({ robot, page }) => {
  await robot.open("Runs");
  await expect(robot.panel("Runs")).toContainText("No motion was carried out yet. Propose one");
  await robot.panel("Runs").getByRole("link", { name: "Proposals" }).click();
  await expect(page).toHaveURL(/#\/proposals$/);
});

test("two runs are drawn over each other, with their numbers side by side, and a link leads to both", async ({
  robot,
  page,
}) => {
  await ready(robot);
  await carryOut(robot, 1);
  await carryOut(robot, 2);
  await robot.open("Runs");
  await line(robot, 2).getByRole("link").click();
  const run = robot.panel("Run 2");
  const keyboard = new Keyboard(page);
  await keyboard.type(run.getByLabel("Compare with"), "#1");
  for (const look of ["at first", "reloaded"]) {
    await expect(page, look).toHaveURL(/#\/runs\/2\/1$/);
    await expect(chart(run, "Probe rotation"), look).toHaveAttribute(
      "aria-label",
      /planned #2 .*, actual #2 .*, planned #1 .*, actual #1 /,
    );
    const rows = run.getByRole("row", { name: /^Probe rotation/ });
    await expect(rows, look).toHaveCount(2);
    await expect(rows.nth(0), look).toContainText("#2");
    await expect(rows.nth(1), look).toContainText("#1");
    await page.reload();
  }
  await run.getByRole("button", { name: "Deviation", pressed: false }).click();
  const deviation = chart(run, "Probe rotation: deviation");
  const { width } = (await deviation.boundingBox()) ?? { width: 0 };
  await deviation.hover({ position: { x: width / 2, y: 40 } });
  await expect(deviation).toHaveAttribute(
    "aria-label",
    /actual #2 less planned #2 -?\d.*, actual #1 less planned #1 -?\d/,
  );
  await run.getByLabel("Compare with").selectOption("none");
  await expect(page).toHaveURL(/#\/runs\/2$/);
  await expect(run.getByRole("row", { name: /^Probe rotation/ })).toHaveCount(1);
});

test("a note is kept with its run, and a viewer can neither write one nor set the retention", async ({
  robot,
  other,
  page,
}) => {
  await robot.addUser("vic", "viewer", password);
  await ready(robot);
  await carryOut(robot, 1);
  await robot.open("Runs");
  const note = robot.panel("Run 1").getByLabel("Note");
  await note.fill("new gel, second try");
  await page.reload();
  await expect(note).toHaveValue("new gel, second try");
  await robot.button("Save note").click();
  await expect(line(robot, 1)).toContainText("✎ new gel, second try");

  await other.logIn("vic", password);
  await other.open("Runs");
  await expect(other.panel("Run 1").getByRole("definition").filter({ hasText: "new gel" })).toBeVisible();
  await expect(other.panel("Retention")).toContainText("The newest 2000 runs of the last 365 days stay");
  await expect(other.page.getByRole("textbox")).toHaveCount(0);
  await expect(other.panel("Retention").getByRole("button")).toHaveCount(0);
});

test("an administrator sets the retention within its bounds, and is asked before runs go", async ({
  robot,
}) => {
  await robot.open("Runs");
  const panel = robot.panel("Retention");
  const set = robot.button("Set retention");
  await panel.getByLabel("Runs").fill("19");
  await expect(panel.getByRole("status")).toContainText(
    "Runs: “19” does not fit; expected a whole number from 20 to 100000.",
  );
  await expect(set).toBeDisabled();
  await panel.getByLabel("Runs").fill("500");
  await set.click();
  await expect(panel).toContainText("The newest 2000 runs");
  await panel.getByRole("button", { name: "Remove the others" }).click();
  await expect(panel).toContainText("The newest 500 runs of the last 365 days stay");
  await panel.getByLabel("Days").fill("400");
  await set.click();
  await expect(panel).toContainText("The newest 500 runs of the last 400 days stay");
});

test("the samples of a run come as a table", async ({ robot, page }) => {
  await ready(robot);
  await carryOut(robot, 1);
  await robot.open("Runs");
  const downloaded = page.waitForEvent("download");
  await robot.button("CSV of run 1").click();
  const file = await downloaded;
  expect(file.suggestedFilename()).toBe("run-1.csv");
  const [head, ...rows] = readFileSync(await file.path(), "utf8")
    .trim()
    .split("\n");
  expect(head).toBe(
    "time_s,probe_rotation_planned_deg,probe_rotation_commanded_deg,probe_rotation_actual_deg",
  );
  expect(Math.max(...rows.map((row) => Number(row.split(",")[3])))).toBeGreaterThan(5.6);
});

test("a run that goes on grows by itself, and is interrupted when the app ends in the middle of it", async ({
  robot,
  stack,
}) => {
  await ready(robot);
  await begin(robot, 1, LONG_S);
  await expect(robot.proposal(1)).toContainText("executing");
  await robot.open("Runs");
  const run = robot.panel("Run 1");
  await expect(line(robot, 1)).toContainText("▶running");
  const until = run.getByRole("definition").filter({ hasText: /:\d\d/ }).nth(1);
  const before = (await until.textContent()) ?? "";
  await expect(until).not.toHaveText(before);
  stack.signalApp("SIGKILL");
  await expect(line(robot, 1)).toContainText("!interrupted");
  await expect(run).toContainText("!interrupted");
  await expect(chart(run, "Probe rotation")).toHaveAttribute("aria-label", /planned \d.*, actual/);
});

test("a proposal that was carried out and its run lead to each other", async ({ robot, page }) => {
  await ready(robot);
  await begin(robot, 1, LONG_S);
  await expect(robot.proposal(1)).toContainText("executing");
  await robot.stop.click();
  await expect(robot.proposal(1)).toContainText("aborted");
  await page.getByRole("link", { name: "Details of proposal 1" }).click();
  await robot.panel("Proposal 1").getByRole("link", { name: "Run 1" }).click();
  const run = robot.panel("Run 1");
  await expect(run).toContainText("■aborted");
  await run.getByRole("link", { name: "Proposal 1" }).click();
  await expect(robot.panel("Proposal 1")).toBeVisible();
});

test("a store that does not answer is told, with what is known left on the page", async ({ robot, page }) => {
  await ready(robot);
  await carryOut(robot, 1);
  await robot.open("Runs");
  await expect(robot.panel("Run 1")).toContainText("done");
  await page.route("**/api/runs*", (route) =>
    route.fulfill({
      status: 503,
      contentType: "application/problem+json",
      json: { code: "STORE", detail: "The store did not answer within 5 s.", next_step: "Look at the log." },
    }),
  );
  await expect(robot.panel("Runs").getByRole("alert")).toContainText(
    "No answer: STORE: The store did not answer within 5 s. Look at the log.",
  );
  await expect(line(robot, 1)).toBeVisible();
  await page.unroute("**/api/runs*");
  await expect(robot.panel("Runs").getByRole("alert")).toHaveCount(0);
});

test("a link to a run that is not kept says so, and the list stays", async ({ robot, page }) => {
  await ready(robot);
  await carryOut(robot, 1);
  await page.goto(new URL("#/runs/99", page.url()).href);
  await expect(robot.panel("Run 99").getByRole("alert")).toContainText(/NOT_FOUND: .*run 99/);
  await line(robot, 1).getByRole("link").click();
  await expect(robot.panel("Run 1")).toContainText("done");
});

test("older runs follow the newest ones", async ({ robot, page }) => {
  const made = (id: number, axes: unknown): object => ({
    ...{ id, case: null, kind: "move", mode: "manual", author: "ann", source: "console", aim: null },
    ...{ outcome: "done", detail: "", verdict: null, begun: "2026-01-01T00:00:00.000Z", begun_tick: 1 },
    ...{ ended: null, ended_tick: null, duration_s: 1, kept: "2026-01-01T00:00:00.000Z", note: "" },
    ...{ robot: "neuro", configuration: "", axes },
  });
  await page.route(/\/api\/runs(\?|$)/, (route) => {
    const before = Number(new URL(route.request().url()).searchParams.get("before") ?? 101);
    const ids = Array.from({ length: 50 }, (_, place) => before - 1 - place);
    return route.fulfill({
      json: {
        runs: ids.map((id) => made(id, [])),
        more: before > 51,
        retention: { count: 2000, days: 365, always: 20 },
      },
    });
  });
  await page.route(/\/api\/runs\/100/, (route) =>
    route.fulfill({
      json: route.request().url().endsWith("samples")
        ? {
            id: 100,
            times_s: [],
            buckets_of_sample: 1,
            axes: [],
            plan: { basis: "none", why: null, times_s: [], axes: [] },
          }
        : { ...made(100, []), recordings: [] },
    }),
  );
  await robot.open("Runs");
  await expect(robot.panel("Runs").getByRole("listitem")).toHaveCount(50);
  await robot.button("Older runs").click();
  await expect(robot.panel("Runs").getByRole("listitem")).toHaveCount(100);
  await expect(robot.button("Older runs")).toHaveCount(0);
  await expect(line(robot, 1)).toBeVisible();
});

test("a phone shows a run and its comparison without scrolling sideways", async ({ robot, page }) => {
  await ready(robot);
  await carryOut(robot, 1);
  await carryOut(robot, 2);
  await robot.open("Runs");
  await page.setViewportSize({ width: 360, height: 740 });
  await page.goto(new URL("#/runs/2/1", page.url()).href);
  await expect(chart(robot.panel("Run 2"), "Probe rotation")).toHaveAttribute("aria-label", /actual #1 /);
  expect(await sidewards(page)).toBe(0);
});

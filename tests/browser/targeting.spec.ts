/** Registration, entry, target and probe, and the move that follows from them, against the real processes. */
import type { Locator, Page } from "@playwright/test";
import { expect, test } from "./fixtures";

const entry = [8, 250, 70];
const target = [5, 200, 60];
const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

/** As another program of the same user does it. */
async function put(page: Page, what: "registration" | "target", body: object): Promise<void> {
  const status = await page.evaluate(
    async ([path, text]) => (await fetch(path, { method: "PUT", body: text })).status,
    [`/api/targeting/${what}`, JSON.stringify(body)] as const,
  );
  expect(status).toBe(200);
}

/** The bodies of what the page itself sends to the targeting from now on. */
function sentBy(page: Page): unknown[] {
  const bodies: unknown[] = [];
  page.on("request", (request) => {
    if (request.method() === "PUT" && request.url().includes("/api/targeting/"))
      bodies.push(request.postDataJSON());
  });
  return bodies;
}

const cell = (page: Page, row: string, column: string): Locator =>
  page.getByRole("textbox", { name: `Registration ${row} ${column}, scanner RAS, mm` });

const poseOrigin = async (pose: Locator): Promise<number[]> => {
  const texts = await pose.getByRole("row").locator("td:last-child").allTextContents();
  return texts.slice(0, 3).map(Number);
};

test.beforeEach(async ({ robot }) => {
  await robot.expectMode("LOCKED");
  await robot.openCase();
});

test("a registration is refused in words until it is rigid, set once, and told with source and age", async ({
  robot,
  page,
}) => {
  await robot.open("Targeting");
  const panel = robot.panel("Registration");
  const set = panel.getByRole("button", { name: "Set registration" });
  await expect(panel).toContainText("Not set yet.");
  await expect(panel).toContainText(
    "The registration is not set. Nothing is shown in the scanner, or moved to.",
  );
  await expect(set).toBeDisabled();
  await put(page, "registration", { registration: identity, override_reason: "There is no scanner." });
  await expect(cell(page, "R", "x")).toHaveValue("1");
  const sent = sentBy(page);

  await cell(page, "R", "x").fill("zero");
  await expect(panel.getByRole("alert")).toContainText(
    "Row R, x: “zero” is no number; expected one such as 0.7071.",
  );
  await cell(page, "R", "x").fill("0");
  await expect(panel.getByRole("alert")).toContainText("Column x: its length is 0.0000; expected 1");
  await expect(set).toBeDisabled();
  await cell(page, "R", "y").fill("-1");
  await cell(page, "A", "x").fill("1");
  await cell(page, "A", "y").fill("0");
  await cell(page, "R", "origin").fill("10,5");
  await cell(page, "R", "origin").press("Enter");
  await expect(panel.getByRole("alert").last()).toContainText("IMPLAUSIBLE");
  await expect(panel.getByRole("alert").last()).toContainText("it is turned by 90 degrees");
  const reason = panel.getByLabel("Reason to set it all the same");
  await reason.fill("Lies on its side.");
  await cell(page, "R", "origin").fill("11");
  await expect(reason).toHaveCount(0);
  await cell(page, "R", "origin").fill("10.5");
  await cell(page, "R", "origin").press("Enter");
  await reason.fill("Lies on its side.");
  await panel.getByRole("button", { name: "Set it all the same" }).click();
  await expect(panel).toContainText("It was set all the same: Lies on its side.");
  await expect(panel).toContainText(/Set \d+ s ago by admin \(console, 127\.0\.0\.1:\d+\)/);
  await expect(set).toBeDisabled();
  const onItsSide = [0, -1, 0, 10.5, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
  const whole = { registration: onItsSide, ignore_registration_rotation: false };
  expect(sent).toEqual([whole, whole, { ...whole, override_reason: "Lies on its side." }]);

  const history = robot.panel("History").getByRole("row").nth(1);
  await expect(history).toContainText("admin");
  await expect(history).toContainText("moved by 10.50 mm, turned by 90.00°");
});

test("the table moved: the registration expires at once, and is valid again once somebody sets it again", async ({
  robot,
  page,
}) => {
  // Where the robot's file expects it, and the points in the scanner then.
  const straight = [1, 0, 0, -18, 0, 1, 0, -185, 0, 0, 1, -73, 0, 0, 0, 1];
  await put(page, "target", { entry_point: [-10, 65, -3], target_point: [-13, 15, -13] });
  await robot.open("Targeting");
  const panel = robot.panel("Registration");
  const alignment = robot.panel("Alignment");
  const moved = robot.button("The table moved");
  await expect(alignment).toContainText("NO_REGISTRATION");
  await put(page, "registration", { registration: straight });
  await expect(alignment.getByRole("row")).toHaveCount(8);
  await moved.click();
  await expect(panel).toContainText("The registration has expired: The table moved.");
  await expect(alignment).toContainText("NO_REGISTRATION");
  await expect(moved).toBeDisabled();
  await expect(robot.panel("History").getByRole("row").nth(1)).toContainText("has expired: The table moved.");
  await robot.button("Set registration").click();
  await expect(panel).not.toContainText("expired");
  await expect(alignment).toContainText("NO_TARGET");
  await put(page, "target", { entry_point: [-10, 65, -3], target_point: [-13, 15, -13] });
  await expect(alignment.getByRole("row")).toHaveCount(8);
});

test("a planned target is kept under its name, fills the fields when it is taken, and is set by itself", async ({
  robot,
  page,
}) => {
  await robot.open("Targeting");
  const aim = robot.panel("Entry, target and probe");
  const field = (name: string) => page.getByRole("textbox", { name: `${name}, scanner RAS, mm` });
  const sent = sentBy(page);
  await aim.getByText("Planned targets: 0").click();
  await expect(aim).toContainText("Write entry and target above");
  for (const [name, values] of [
    ["Entry", entry],
    ["Target", target],
  ] as const)
    for (const [at, row] of ["R", "A", "S"].entries()) await field(`${name} ${row}`).fill(String(values[at]));
  await aim.getByRole("textbox", { name: "Name" }).fill("core 1");
  await page.keyboard.press("Enter");
  const row = aim.getByRole("listitem", { name: "core 1" });
  await expect(row).toContainText("5.0");
  await robot.button("Undo").click();
  await expect(field("Target R")).toHaveValue("");
  await robot.button("Take core 1 into the fields").click();
  await expect(field("Target R")).toHaveValue("5");
  await robot.button("Set target").click();
  await expect(aim).toContainText("As received.");
  await robot.button("Remove core 1").click();
  await expect(aim).toContainText("Planned targets: 0");
  expect(sent).toEqual([
    { planned_targets: [{ name: "core 1", entry_point: entry, target_point: target }] },
    { entry_point: entry, target_point: target },
    { planned_targets: [] },
  ]);
});

test("what is edited is not overwritten by what arrives, and nothing is sent that did not change", async ({
  robot,
  page,
}) => {
  await put(page, "target", { entry_point: entry, target_point: target });
  await robot.open("Targeting");
  const registration = robot.panel("Registration");
  const aim = robot.panel("Entry, target and probe");
  const sent = sentBy(page);

  await page.getByLabel("File of a registration").setInputFiles({
    name: "zframe.txt",
    mimeType: "text/plain",
    buffer: Buffer.from("# mm\n1 0 0 5\n0 1 0 6\n0 0 1 7\n0 0 0 1\n"),
  });
  await expect(registration).toContainText("From zframe.txt, not sent.");
  await expect(cell(page, "S", "origin")).toHaveValue("7");
  const meanwhile = [1, 0, 0, -1, 0, 1, 0, -2, 0, 0, 1, -3, 0, 0, 0, 1];
  await put(page, "registration", { registration: meanwhile, override_reason: "There is no scanner." });
  await expect(registration.getByRole("alert").first()).toContainText("origin at -1.00, -2.00, -3.00");
  await expect(cell(page, "S", "origin")).toHaveValue("7");
  await expect(robot.button("Set registration")).toBeDisabled();
  await robot.button("Take what arrived").click();
  await expect(cell(page, "S", "origin")).toHaveValue("-3");
  await expect(registration).toContainText("As received.");

  await page.getByLabel("File of a registration").setInputFiles({
    name: "film.txt",
    mimeType: "text/plain",
    buffer: Buffer.from("1 2 3"),
  });
  await expect(registration.getByRole("alert").first()).toContainText(
    "film.txt: It has 3 numbers; expected 16",
  );

  await page.getByRole("textbox", { name: "Target S, scanner RAS, mm" }).fill("61.5");
  await put(page, "target", { entry_point: [9, 250, 70] });
  await expect(page.getByRole("textbox", { name: "Entry R, scanner RAS, mm" })).toHaveValue("9");
  await expect(aim).toContainText("To be sent: Target.");
  await robot.button("Set target").click();
  await expect(aim).toContainText("As received.");
  expect(sent.slice(-1)).toEqual([{ target_point: [5, 200, 61.5] }]);
  // Two came from this test by fetch, past the forms.
  expect(sent).toHaveLength(3);
});

test("poses that are not told any more are greyed though the stream lives", async ({ robot, page }) => {
  await robot.unlockRobot();
  await robot.open("Targeting");
  const poses = robot.panel("Poses of the treatment point");
  await expect(poses.getByText("live", { exact: true })).toBeVisible();
  await expect(poses).not.toHaveAttribute("data-late");
  // The app goes on, and never answers this question again.
  await page.route("**/api/targeting/alignment", () => undefined);
  await expect(poses).toHaveAttribute("data-late", "true");
  await expect(poses.getByText(/stale · \d/)).toBeVisible();
  const filters = await poses
    .locator(":scope > :not(.panel-head)")
    .evaluateAll((parts) => parts.map((part) => getComputedStyle(part).filter));
  expect(new Set(filters)).toEqual(new Set(["grayscale(1)"]));
  await expect(page.getByRole("main")).toHaveAttribute("data-level", "live");
});

test("the alignment says what it asks of each axis and why it would be refused, as it then is", async ({
  robot,
  page,
}) => {
  await put(page, "target", { entry_point: entry, target_point: target });
  await put(page, "registration", { registration: identity, override_reason: "There is no scanner." });
  await robot.unlockRobot();
  await robot.open("Targeting");
  const alignment = robot.panel("Alignment");
  const desired = robot.button("Propose desired pose");
  const hindrances = alignment.getByRole("list", { name: "Why it would be refused now" });
  await expect(alignment.getByRole("row")).toHaveCount(8);
  await expect(hindrances).toContainText("DISABLED: Yaw");
  await expect(hindrances).toContainText("NOT_HOMED");
  await desired.click();
  await expect(alignment.getByRole("alert")).toContainText("Refused: DISABLED");
  await expect(robot.panel("Poses of the treatment point")).toContainText("NOT_HOMED");

  await put(page, "target", { target_point: [60, 200, 60] });
  await expect(alignment).toContainText("The desired pose would be refused, UNREACHABLE");
  await expect(alignment.getByText("▲ clamped").first()).toBeVisible();
  await expect(desired).toBeDisabled();
  const accepting = page.getByRole("button", {
    name: /^Accept .* mm and .*°, and propose the reachable pose$/,
  });
  await expect(accepting).toBeEnabled();
});

test("the proposed alignment brings the current pose to the desired one", async ({ robot, page }) => {
  await robot.unlockRobot();
  const motors: { title: string; has_switch: boolean }[] = await page.evaluate(async () =>
    (await fetch("/api/motors")).json(),
  );
  for (const { title, has_switch } of motors) {
    await robot.axis(title).setHome(has_switch);
    await robot.axis(title).enable();
  }
  await put(page, "registration", { registration: identity, override_reason: "There is no scanner." });
  await robot.open("Targeting");
  const current = page.getByRole("region", { name: "Current pose" });
  await expect(current.getByRole("table")).toBeVisible();
  const [x = 0, y = 0, z = 0] = await poseOrigin(current);
  // At home the probe points along -y, and its entry lies D - B = 36 mm before the treatment point. Yaw and axial
  // head stand at their ends there: the target is off to where they can go.
  await put(page, "target", { entry_point: [x - 1, y + 36, z + 1], target_point: [x - 1, y - 2, z - 1] });
  const error = current.getByRole("status", { name: "Error of the current pose from the desired one" });
  await expect(error).toContainText(/^2\.\d\d mm/);
  await page.getByLabel("Insert the probe once it is aligned").check();
  await robot.button("Propose desired pose").click();
  const proposed = robot.panel("Alignment").getByRole("status").filter({ hasText: "Proposal" });
  await expect(proposed).toContainText("checked");
  await robot.approve(1);
  await expect(proposed).toContainText("approved");
  await robot.open("Robot");
  await expect(robot.proposal(1)).toContainText("All axes: ACCEPTED would be accepted once the pedal");
  await robot.pressPedal();
  await expect(robot.proposal(1)).toContainText("Aligned. Look at it, confirm the insertion");
  await robot.releasePedal();
  const confirming = robot.button("Confirm insertion of proposal 1");
  await confirming.click();
  await expect(confirming).toHaveCount(0);
  await robot.pressPedal();
  // Whoever leaves the page lifts the foot.
  await expect(robot.proposal(1)).toContainText("done");
  await robot.open("Targeting");
  await expect(error).toContainText(/^0\.[0-2]\d mm, 0\.\d\d°/);
});

test("the error budget of a pose stands in the alignment, beneath the checks of its motion, and in 3D", async ({
  robot,
  page,
}) => {
  await put(page, "target", { entry_point: entry, target_point: target });
  await put(page, "registration", {
    registration: identity,
    residual_mm: 0.4,
    fiducial_points: [
      [-40, 0, 0],
      [40, 0, 10],
      [-30, 60, 0],
      [0, 20, 60],
    ],
    override_reason: "There is no scanner.",
  });
  await robot.unlockRobot();
  await robot.open("Targeting");
  const alignment = robot.panel("Alignment");
  const words =
    /Error of the reachable pose: ±(\d\.\d\d) mm or more at 95 %: registration .*; tip ±.* mm; not stated: play, calibration, image/;
  await expect(alignment).toContainText(words);
  const [, longest] = words.exec((await alignment.textContent()) ?? "") ?? [];
  await robot.button("Propose desired pose").click();
  await expect(alignment.getByRole("alert")).toContainText("Refused: DISABLED");

  await robot.open("3D");
  const picture = robot.panel("3D").getByRole("img", { name: /^3D: .*95 % ellipsoid/ });
  await expect(picture).toHaveAccessibleName(
    new RegExp(`95 % ellipsoid with half axes of ${longest}, \\d\\.\\d\\d, \\d\\.\\d\\d mm`),
  );
  await expect(robot.panel("3D").getByRole("list", { name: "What is shown" })).toContainText(
    "where the treatment point may be",
  );
  const before = await picture.screenshot();
  await put(page, "target", { target_point: target, target_covariance_mm2: [400, 0, 0, 0, 25, 0, 0, 0, 1] });
  await expect(picture).toHaveAccessibleName(/half axes of 5[56]\.\d\d, 14\.\d\d, /);
  await expect.poll(async () => before.equals(await picture.screenshot()), "a larger one").toBe(false);

  await robot.open("Proposals");
  await expect(robot.panel("Proposal 1").getByRole("region", { name: "Checks" })).toContainText(words);
});

/** Saving and loading where the robot stands. */
import { readFileSync } from "node:fs";
import type { Axis, ConsolePage } from "./console_page";
import { expect, test } from "./fixtures";

interface Saved {
  name: string;
  text: string;
}

async function save(robot: ConsolePage): Promise<Saved> {
  const downloading = robot.page.waitForEvent("download");
  await robot.button("Save positions").click();
  const download = await downloading;
  return { name: download.suggestedFilename(), text: readFileSync(await download.path(), "utf8") };
}

const loadButton = (robot: ConsolePage) => robot.page.getByRole("button", { name: /^Load positions/ });

async function load(robot: ConsolePage, name: string, text: string): Promise<void> {
  const choosing = robot.page.waitForEvent("filechooser");
  await loadButton(robot).click();
  const chooser = await choosing;
  await chooser.setFiles({ name, mimeType: "application/json", buffer: Buffer.from(text) });
}

async function carry(robot: ConsolePage, name: string, text: string) {
  return robot.page.evaluateHandle(
    ([fileName, content]) => {
      const dropped = new DataTransfer();
      dropped.items.add(new File([content], fileName, { type: "application/json" }));
      return dropped;
    },
    [name, text] as const,
  );
}

/** Counts that an encoder at rest may read beside its place, in the moment of setting it or of reading it. */
const NOISE_COUNTS = 1;

async function expectPosition(axis: Axis, counts: number): Promise<void> {
  await expect.poll(async () => Math.abs((await axis.counts()) - counts)).toBeLessThanOrEqual(NOISE_COUNTS);
}

for (const robotName of ["neuro", "prostate"] as const) {
  test.describe(robotName, () => {
    test.use({ robotName });

    test("saved positions are compared, confirmed and set again", async ({ robot, page }) => {
      await robot.unlockRobot();
      const saved = await save(robot);
      expect(saved.name).toMatch(new RegExp(`^${robotName}-positions-\\d{8}T\\d{6}Z\\.json$`));
      expect(JSON.parse(saved.text)).toMatchObject({ format: "interlock-positions", robot: robotName });

      const row = page.getByRole("listitem", { name: /^Axis / }).first();
      const title = ((await row.getAttribute("aria-label")) ?? "").replace("Axis ", "");
      const axis = robot.axis(title);
      const before = await axis.counts();
      const moved = JSON.parse(saved.text);
      const entry = moved.axes[0];
      entry.position_counts = before - 40;
      await load(robot, saved.name, JSON.stringify(moved));

      const table = robot.panel(`Positions of ${saved.name}`);
      const line = table.getByRole("row").filter({ hasText: title });
      await expect(line.getByRole("checkbox")).toBeChecked();
      await expect(line).toContainText("disabled");
      await expect.poll(() => axis.counts()).toBe(before);
      await table.getByRole("button", { name: "Set 1 position" }).click();

      const answer = robot.panel("Answer to Load positions");
      await expect(answer.getByRole("listitem")).toHaveCount(1);
      await expect(answer).toContainText(`${title} ACCEPTED`);
      await expectPosition(axis, before - 40);
      await axis.expectState("DISABLED");

      const dataTransfer = await carry(robot, saved.name, saved.text);
      await loadButton(robot).dispatchEvent("drop", { dataTransfer });
      await table.getByRole("button", { name: "Set 1 position" }).click();
      await expectPosition(axis, before);
    });
  });
}

test("a wrong file is refused in words and changes nothing", async ({ robot }) => {
  await robot.unlockRobot();
  const saved = JSON.parse((await save(robot)).text);
  const counts = await robot.axis("Yaw").counts();
  const refusal = robot.panel("Motors").getByRole("alert").filter({ hasText: "Not loaded:" });
  const elsewhere = { ...saved.axes[0], position_counts: saved.axes[0].position_counts - 30 };
  const axes = [elsewhere, ...saved.axes.slice(1)];
  for (const [text, words] of [
    ["\u0089PNG", "is no JSON"],
    ["{}", "INVALID"],
    [JSON.stringify({ ...saved, axes, robot: "prostate" }), "POSITIONS_ROBOT"],
    [JSON.stringify({ ...saved, axes, config_crc: "00000000" }), "POSITIONS_CONFIG"],
    [JSON.stringify({ ...saved, axes, version: 2 }), "POSITIONS_VERSION"],
  ] as const) {
    await load(robot, "wrong.json", text);
    await expect(refusal).toContainText(words);
    await robot.button("Dismiss the refusal of the file").click();
  }
  expect(await robot.axis("Yaw").counts()).toBe(counts);
});

test("a position outside of the soft limits cannot be chosen, and Cancel sets nothing", async ({ robot }) => {
  await robot.unlockRobot();
  const saved = JSON.parse((await save(robot)).text);
  const counts = await robot.axis("Pitch").counts();
  for (const axis of saved.axes) {
    if (axis.axis === "yaw") axis.position_counts = 5000;
    if (axis.axis === "pitch") axis.position_counts = counts + 20;
  }
  await load(robot, "far.json", JSON.stringify(saved));
  const table = robot.panel("Positions of far.json");
  const yaw = table.getByRole("row").filter({ hasText: "Yaw" });
  await expect(yaw).toContainText("outside limits");
  await expect(yaw.getByRole("checkbox")).toHaveCount(0);
  await table.getByRole("button", { name: "Cancel" }).click();
  await expect(table).toHaveCount(0);
  expect(await robot.axis("Pitch").counts()).toBe(counts);
});

test("a file dropped beside the button does not take the place of the page", async ({ robot }) => {
  const dataTransfer = await carry(robot, "wrong.json", "{}");
  const kept = await robot.panel("Log").evaluate((panel, dropped) => {
    const event = new DragEvent("drop", { dataTransfer: dropped, bubbles: true, cancelable: true });
    panel.dispatchEvent(event);
    return event.defaultPrevented;
  }, dataTransfer);
  expect(kept).toBe(true);
});

test("what Zero all declared is undone, and the axis is not homed afterwards", async ({ robot }) => {
  await robot.unlockRobot();
  const undo = robot.panel("Undo of positions");
  await expect(undo.getByRole("button")).toBeDisabled();
  const axis = robot.axis("Probe rotation");
  const before = await axis.restingCounts();
  await robot.button("Zero all").click();
  const question = robot.panel("Declare every axis without a switch at home?");
  await expect(question).toContainText("A registration that rests on these axes expires.");
  await question.getByRole("button", { name: "Set Home of these axes" }).click();
  await expect(axis.row.getByText("UNHOMED")).toHaveCount(0);
  await expectPosition(axis, 0);
  await expect(undo).toContainText("Set Home by admin");
  await expect(undo).toContainText("Probe rotation: ");
  await robot.button("Undo Set Home").click();
  await expect(robot.panel("Answer to Undo")).toContainText("Probe rotation ACCEPTED");
  await expectPosition(axis, before);
  await expect(axis.row.getByText("UNHOMED")).toBeVisible();
  await expect(undo.getByRole("button")).toBeDisabled();
});

test("a saved position is gone to by a motion that waits for its approval", async ({ robot }) => {
  await robot.unlockRobot();
  const axis = robot.axis("Probe rotation");
  await axis.setHome();
  await axis.enable();
  const saved = await save(robot);
  const elsewhere = JSON.parse(saved.text);
  const [entry] = elsewhere.axes.filter((each: { axis: string }) => each.axis === "probe_rotation");
  entry.position_counts -= 200;
  await load(robot, saved.name, JSON.stringify(elsewhere));
  const table = robot.panel(`Positions of ${saved.name}`);
  const go = table.getByRole("button", { name: "Propose to go there" });
  await go.click();
  await expect(table).toHaveCount(0);
  await expect(robot.proposal(1)).toContainText("checked");
  await robot.approve(1);
  await robot.pressPedal();
  await expectPosition(axis, entry.position_counts);
  await expect(axis.row.getByText("UNHOMED")).toHaveCount(0);
});

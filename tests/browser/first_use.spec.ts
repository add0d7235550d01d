/** A newcomer's first use of the console, by clicking, against the real processes. */
import { mkdirSync } from "node:fs";
import path from "node:path";
import { expect, test } from "./fixtures";
import { picture, reports } from "./places";

test.use({ clock: "slow" });

test("a newcomer unlocks, enables, drags, holds the pedal, arrives, and letting go stops the axis", async ({
  robot,
  page,
}) => {
  const axis = robot.axis("Probe rotation");
  await expect(page.getByText("SIMULATED HARDWARE").first()).toBeVisible();
  await expect(page.getByRole("banner").getByText("BOOT")).toBeVisible();
  await robot.unlockRobot();
  await axis.enable();

  await axis.drag(3);
  const target = await axis.circle();
  expect(Math.abs(target - (await axis.counts()))).toBeGreaterThan(100);
  await expect(robot.proposal(1)).toHaveCount(0);
  await page.mouse.up();
  await expect(robot.proposal(1)).toContainText("approved");
  expect(await axis.restingCounts()).toBeLessThanOrEqual(1);

  await robot.holdPedal();
  await axis.expectState("MOVING");
  await expect(robot.proposal(1)).toContainText("executing");
  await expect.poll(() => axis.counts()).toBeGreaterThan(10);
  await robot.letPedalGo();
  await expect(robot.proposal(1)).toContainText("paused");
  const stoppedAt = await axis.restingCounts();
  expect(stoppedAt).toBeLessThan(target);

  await robot.holdPedal();
  await expect(robot.proposal(1)).toContainText("done");
  await robot.letPedalGo();
  expect(Math.abs((await axis.restingCounts()) - target)).toBeLessThanOrEqual(2);
});

test("the simulated pedal is let go when the window loses the operator", async ({ robot, page }) => {
  await robot.unlockRobot();
  await robot.latchPedal();
  await page.evaluate(() => window.dispatchEvent(new Event("blur")));
  await expect(robot.pedalState).toContainText("released");
  await robot.expectMode("READY");
});

test("a drag moves nothing while it lasts, even with the pedal held", async ({ robot, page }) => {
  const axis = robot.axis("Probe rotation");
  const asked: string[] = [];
  await robot.unlockRobot();
  await axis.enable();
  await robot.pressPedal();
  page.on("request", (request) => {
    const { pathname } = new URL(request.url());
    if (request.method() !== "GET" && !pathname.startsWith("/api/bench/pedal")) asked.push(pathname);
  });
  const before = await axis.restingCounts();
  await axis.drag(3);
  expect(Math.abs((await axis.circle()) - before)).toBeGreaterThan(100);
  expect(Math.abs((await axis.restingCounts()) - before)).toBeLessThanOrEqual(1);
  expect(asked).toEqual([]);
  await page.mouse.up();
  await expect.poll(() => axis.counts()).toBeGreaterThan(before + 10);
  expect(asked).toEqual(["/api/proposals"]);
});

test("a move beyond the range is refused in words at the axis and in the list", async ({ robot }) => {
  const axis = robot.axis("Probe rotation");
  await robot.unlockRobot();
  await axis.enable();
  await axis.propose("300");
  const refusal = await axis.expectRefusal("RANGE");
  await expect(refusal).toContainText("outside the allowed range");
  await expect(refusal).toContainText("home the axis for the full range");
  await expect(robot.proposal(1)).toContainText("refused");
  await expect(robot.proposal(1)).toContainText("RANGE");
  await robot.pressPedal();
  expect(Math.abs(await axis.restingCounts())).toBeLessThanOrEqual(1);
  await refusal.getByRole("button", { name: /Dismiss/ }).click();
  await expect(refusal).toHaveCount(0);
});

test("a move of an axis that is not enabled is refused with the next step", async ({ robot }) => {
  await robot.unlockRobot();
  const axis = robot.axis("Probe insertion");
  await axis.propose("1");
  await expect(await axis.expectRefusal("DISABLED")).toContainText("Enable the axis.");
});

test("a target that is no number is not sent", async ({ robot }) => {
  const axis = robot.axis("Probe insertion");
  await axis.propose("ten");
  await expect(axis.row.getByText("expected a number of millimetres")).toBeVisible();
  await expect(robot.proposal(1)).toHaveCount(0);
});

test("arrow keys preview, Enter proposes, and Escape drops a preview and stops", async ({ robot, page }) => {
  const axis = robot.axis("Probe rotation");
  await robot.unlockRobot();
  await axis.enable();
  await axis.track.focus();
  await page.keyboard.press("ArrowRight");
  const previewed = await axis.circle();
  expect(previewed).toBeGreaterThan(50);
  await page.keyboard.press("Escape");
  await expect(robot.stopAnswer).toHaveText("STOP accepted");
  await expect.poll(() => axis.circle()).toBeLessThanOrEqual(1);
  await expect(robot.proposal(1)).toHaveCount(0);
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("Enter");
  await expect(robot.proposal(1)).toContainText("approved");
  // A preview starts where the axis stands, and its encoder trembles by a count.
  expect(Math.abs((await axis.circle()) - previewed)).toBeLessThanOrEqual(2);
});

for (const [way, where] of [
  ["a click on STOP", "page"],
  ["Esc", "page"],
  ["Esc typed into a number field", "field"],
] as const) {
  test(`${way} stops a move, and the held pedal does not start it again`, async ({ robot, page }) => {
    const axis = robot.axis("Probe rotation");
    await robot.unlockRobot();
    await axis.enable();
    await axis.propose("40");
    await robot.pressPedal();
    await expect.poll(() => axis.counts()).toBeGreaterThan(10);

    if (where === "field") await axis.row.getByRole("textbox").focus();
    if (way === "a click on STOP") await robot.stop.click();
    else await page.keyboard.press("Escape");

    await robot.expectMode("READY");
    await expect(robot.stopAnswer).toHaveText("STOP accepted");
    await expect(robot.proposal(1)).toContainText("aborted");
    const stoppedAt = await axis.restingCounts();
    await expect(robot.pedalState).toContainText("pressed");
    await robot.expectMode("READY");
    expect(Math.abs((await axis.restingCounts()) - stoppedAt)).toBeLessThanOrEqual(1);
  });
}

test("the E-stop locks with its cause until it is released and unlocked, and nothing moves by unlocking", async ({
  robot,
  page,
}) => {
  const axis = robot.axis("Probe rotation");
  await robot.unlockRobot();
  await axis.enable();
  await axis.propose("40");
  await robot.pressPedal();
  await expect.poll(() => axis.counts()).toBeGreaterThan(10);

  await page.getByRole("button", { name: "Pull E-stop" }).click();
  await robot.expectMode("LOCKED");
  await expect(robot.estop).toContainText("PULLED");
  const signs = page.getByRole("banner").locator(".alarm-sign");
  await expect(signs.and(page.locator('[data-priority="high"]'))).toHaveCount(3);
  await expect(
    page.getByRole("banner").getByText("The E-stop was pulled, or its loop is broken."),
  ).toBeVisible();
  await axis.expectState("DISABLED");
  const stoppedAt = await axis.restingCounts();

  await robot.releasePedal();
  await robot.unlock.click();
  await expect(page.getByRole("alert").filter({ hasText: "Unlock refused: CAUSE_PRESENT" })).toBeVisible();

  await page.getByRole("button", { name: "Release E-stop" }).click();
  await expect(robot.estop).toContainText("released");
  await robot.unlockRobot();
  await expect(signs.and(page.locator("[data-priority]"))).toHaveCount(0);
  await robot.pressPedal();
  await axis.expectState("DISABLED");
  expect(Math.abs((await axis.restingCounts()) - stoppedAt)).toBeLessThanOrEqual(1);
});

test("a jammed axis stalls, names the fault with its next step, and moves again once cleared", async ({
  robot,
  page,
}) => {
  const axis = robot.axis("Probe rotation");
  await robot.unlockRobot();
  await axis.enable();
  const jam = page.getByRole("button", { name: "Jam Probe rotation" });
  await jam.click();
  await expect(jam).toHaveAttribute("aria-pressed", "true");
  await axis.propose("10");
  await robot.pressPedal();

  const fault = axis.row.getByRole("alert").filter({ hasText: "STALL" });
  await expect(fault).toContainText("driven without making progress");
  await expect(fault).toContainText("Look for an obstacle");
  await expect(fault.getByRole("link", { name: "STALL" })).toHaveAttribute("href", "#/codes/fault/STALL");
  await robot.expectMode("READY");
  // At rest, which is asked first.
  await expect(axis.button("Clear")).toHaveAccessibleDescription(/PEDAL_DOWN/);
  await axis.press("Clear");
  await axis.expectRefusal("PEDAL_DOWN");

  await robot.releasePedal();
  await jam.click();
  await expect(jam).toHaveAttribute("aria-pressed", "false");
  await expect(axis.button("Clear")).not.toHaveAttribute("data-foretold");
  await axis.press("Clear");
  await axis.expectState("DISABLED");
  await axis.enable();
  await axis.propose("2");
  await robot.pressPedal();
  await expect.poll(() => axis.counts()).toBeGreaterThan(10);
});

test.describe("as impatient as it is", () => {
  test.use({ patience: 1 });

  test("data of a silent app are greyed, then covered, and STOP says that it was not heard", async ({
    robot,
    stack,
    page,
  }) => {
    await robot.unlockRobot();
    const panels = page.getByRole("main");
    await expect(panels).toHaveAttribute("data-level", "live");
    // What is shown in each painted frame, until the panels are covered.
    const shown = page.evaluate(
      () =>
        new Promise<{ level: string; age: string; header: string }[]>((resolve) => {
          const seen: { level: string; age: string; header: string }[] = [];
          const look = (): void => {
            const level = document.querySelector("main")?.dataset.level ?? "";
            const header = document.querySelector("header")?.dataset.level ?? "";
            const age = document.querySelector(".connection dd:last-of-type")?.textContent ?? "";
            seen.push({ level, age, header });
            if (level === "covered") resolve(seen);
            else requestAnimationFrame(look);
          };
          look();
        }),
    );
    stack.signalApp("SIGSTOP");
    try {
      const frames = await shown;
      await expect(robot.button("Alarms unknown")).toBeVisible();
      for (const { level, age, header } of frames) {
        const ageMs = age.endsWith(" ms") ? Number.parseInt(age, 10) : 1000 * Number.parseFloat(age);
        // An age that is shown as a bound was rounded to it from either side.
        if (ageMs === 250 || ageMs === 1000) continue;
        expect(level, `at an age of ${age}`).toBe(ageMs < 250 ? "live" : ageMs < 1000 ? "grey" : "covered");
        expect(header).toBe(level);
      }
      const order = frames.map(({ level }) => level).filter((level, at, all) => level !== all[at - 1]);
      // A page that was not painted while they were grey goes from live to covered at once.
      expect(order.slice(order.lastIndexOf("live")).join()).toMatch(/^live(,grey)?,covered$/);
      await expect(page.getByRole("heading", { name: /No data for/ })).toBeVisible();
      await robot.expectMode("UNKNOWN");
      await expect(robot.unlock).toBeDisabled();
      await page.keyboard.press("Escape");
      await expect(page.getByRole("alert").filter({ hasText: "use the E-stop" })).toBeVisible();
    } finally {
      stack.signalApp("SIGCONT");
    }
    await expect(panels).toHaveAttribute("data-level", "live");
    await robot.expectMode("READY");
  });
});

test("the console comes back by itself when the app was killed and started again", async ({
  robot,
  stack,
  page,
}) => {
  await robot.unlockRobot();
  const axis = robot.axis("Probe rotation");
  await axis.enable();
  let framesOfNewStreams = 0;
  page.on("websocket", (stream) => {
    stream.on("framereceived", () => {
      framesOfNewStreams += 1;
    });
  });
  stack.signalApp("SIGKILL");
  await expect.poll(() => framesOfNewStreams).toBeGreaterThan(3);
  await robot.expectMode("READY");
  await axis.expectState("ENABLED");
  await robot.takeControl();
  await axis.propose("300");
  await axis.expectRefusal("RANGE");
});

test("no key enables an axis, unlocks or presses the pedal", async ({ robot, page }) => {
  const asked = new Set<string>();
  page.on("request", (request) => {
    if (request.method() !== "GET") asked.add(new URL(request.url()).pathname);
  });
  const letters = [..."abcdefghijklmnopqrstuvwxyz0123456789"];
  const named = ["Enter", "Space", "Insert", "Delete", "Home", "End", "PageUp", "ArrowUp", "ArrowRight"];
  const functions = Array.from({ length: 12 }, (_, index) => `F${index + 1}`);
  const pressAll = async (): Promise<void> => {
    // Nothing has the focus: a button that has it is pressed by Enter and Space, as everywhere.
    await page.evaluate(() => (document.activeElement as HTMLElement | null)?.blur());
    for (const key of [...letters, ...named, ...functions]) {
      await page.keyboard.press(key);
      await page.keyboard.press(`Control+${key}`);
    }
  };
  await robot.expectMode("LOCKED");
  await pressAll();
  await robot.expectMode("LOCKED");
  expect([...asked]).toEqual([]);
  await robot.unlockRobot();
  asked.clear();
  await pressAll();
  await page.keyboard.press("Escape");
  await expect(robot.stopAnswer).toHaveText("STOP accepted");
  expect([...asked]).toEqual(["/api/stop"]);
  await robot.expectMode("READY");
  await robot.axis("Yaw").expectState("DISABLED");
});

test.describe("at its usual pace", () => {
  test.use({ clock: "paced" });

  test("a renewal of the pedal that comes too late presses nothing, and the bench says so", async ({
    robot,
    page,
  }) => {
    await page.route("**/api/bench/pedal", async (route) => {
      if (route.request().postDataJSON().renew === true)
        await expect(robot.pedalState).toContainText("released");
      await route.continue();
    });
    await robot.unlockRobot();
    await robot.expectArmed();
    await robot.latch.click();
    await expect(page.getByRole("alert").filter({ hasText: "PEDAL_LAPSED" })).toContainText(
      "Press it again.",
    );
    await expect(robot.latch).toHaveAttribute("aria-pressed", "false");
    await robot.expectMode("READY");
  });

  test("the picture of the README comes from a real run", async ({ robot, page }) => {
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
    const file = process.env.UPDATE_PICTURE ? picture : path.join(reports, "console.png");
    mkdirSync(path.dirname(file), { recursive: true });
    await page.screenshot({ path: file });
    await robot.stop.click();
    await robot.expectMode("READY");
  });
});

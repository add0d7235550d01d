import { describe, expect, it } from "vitest";
import type { Motor } from "../api/client";
import { catalog, entry } from "../generated/catalog";
import type { AxisFrame, Frame } from "../stream/decode";
import { foretell, foretellRefusal } from "./foretell";
import type { AxisWish, Foresight } from "./pageKernel";

const motor = { name: "lateral", unit: "mm", counts_per_unit: 100 } as Motor;
const frame = { mode: "READY", cause: "NONE" } as Frame;
const axis = { minCounts: -4947, maxCounts: 0 } as AxisFrame;
const move: AxisWish = { kind: "MOVE", targetCounts: 1240 };
const told = (foresight: Partial<Foresight>, shown: Partial<Frame> = {}, wish: AxisWish = move) =>
  foretell({ ...frame, ...shown }, motor, axis, wish, {
    ...{ verdict: "ACCEPTED", gate: "OPEN", mode: "MOTION" },
    ...foresight,
  });

describe("foretell", () => {
  it("names axis, target and allowed range in the axis' unit", () => {
    expect(told({ verdict: "RANGE", gate: "LEASE" })).toMatchObject({
      ...{ outcome: "refused", family: "verdict", code: "RANGE" },
      text: "would be refused: lateral 12.40\u00a0mm, allowed -49.47 to 0.00.",
    });
  });

  it("says why the system is locked, and what to do about that", () => {
    const locked = told(
      { verdict: "MODE", gate: "MODE", mode: "LOCKED" },
      { mode: "LOCKED", cause: "ESTOP" },
    );
    expect(locked.text).toBe("would be refused: LOCKED by ESTOP.");
    expect(locked.nextStep).toContain("release the E-stop");
  });

  it("does not tell to press a pedal that would start nothing", () => {
    expect(told({ verdict: "MODE", gate: "MODE", mode: "READY" }).text).toContain("required card is lost");
  });

  it.each(catalog.verdict.filter(({ name }) => !["ACCEPTED", "RANGE", "MODE"].includes(name)))(
    "gives meaning and next step of $name",
    ({ name, meaning, next_step }) => {
      expect(told({ verdict: name })).toMatchObject({
        ...{ outcome: "refused", code: name, nextStep: next_step },
        text: `would be refused: ${meaning}`,
      });
    },
  );

  it.each(["HARD_LIMIT", "SOFT_LIMIT", "UNHOMED_TRAVEL"] as const)(
    "warns that %s would hold an accepted move back",
    (gate) => {
      expect(told({ gate })).toMatchObject({ outcome: "held", family: "gate", code: gate });
    },
  );

  it("tells whether an accepted move waits for the pedal", () => {
    expect(told({})).toMatchObject({
      outcome: "moves",
      text: "would be accepted once the pedal is pressed.",
    });
    expect(told({}, { mode: "MOTION" }).text).toContain("move at once");
    expect(told({ gate: "SETPOINT" }).text).toContain("stands there already");
  });

  it("tells of homing, which has no target", () => {
    const home: AxisWish = { kind: "HOME" };
    expect(told({}, { mode: "MOTION" }, home).text).toContain("home at once");
    expect(told({ gate: "SETPOINT" }, { mode: "MOTION" }, home).text).toContain("home at once");
    expect(told({ verdict: "NO_SWITCH" }, {}, home)).toMatchObject({ outcome: "refused", code: "NO_SWITCH" });
  });
});

describe("foretellRefusal", () => {
  it("says nothing of what would be accepted, or when the kernel cannot be asked", () => {
    expect(foretellRefusal(frame, "ACCEPTED")).toBeNull();
    expect(foretellRefusal(frame, null)).toBeNull();
    expect(foretellRefusal(null, "MODE")).toBeNull();
  });

  it("gives verdict, meaning and next step", () => {
    const { meaning, next_step } = entry("verdict", "CAUSE_PRESENT");
    expect(foretellRefusal(frame, "CAUSE_PRESENT")).toBe(
      `The kernel would refuse it, CAUSE_PRESENT: ${meaning} ${next_step}`,
    );
  });

  it("says by what the system is locked, and what to do about that", () => {
    const locked = { ...frame, mode: "LOCKED", cause: "ESTOP" } as Frame;
    expect(foretellRefusal(locked, "MODE")).toBe(
      `The kernel would refuse it, MODE: The system is LOCKED by ESTOP. ${entry("cause", "ESTOP").next_step}`,
    );
  });
});

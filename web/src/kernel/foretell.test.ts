import { describe, expect, it } from "vitest";
import type { Motor } from "../api/client";
import { catalog } from "../generated/catalog";
import type { AxisFrame, Frame } from "../stream/decode";
import { foretell } from "./foretell";
import type { Foresight } from "./pageKernel";

const motor = { name: "lateral", unit: "mm", counts_per_unit: 100 } as Motor;
const frame = { mode: "READY", cause: "NONE" } as Frame;
const axis = { minCounts: -4947, maxCounts: 0 } as AxisFrame;
const told = (foresight: Partial<Foresight>, shown: Partial<Frame> = {}) =>
  foretell({ ...frame, ...shown }, motor, axis, 1240, {
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
});

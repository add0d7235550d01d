import { describe, expect, it } from "vitest";
import { nextStep, type Situation, steps } from "./steps";

const start: Situation = { mine: false, mode: "LOCKED", axes: ["DISABLED", "DISABLED"], proposals: [] };
const ready: Situation = { ...start, mine: true, mode: "READY", axes: ["DISABLED", "ENABLED"] };

describe("nextStep", () => {
  it.each<[string, Situation]>([
    ["Take control", start],
    ["Unlock", { ...start, mine: true }],
    ["Enable an axis", { ...ready, axes: ["DISABLED", "FAULTED"] }],
    ["Propose a move", { ...ready, proposals: [{ state: "refused" }, { state: "aborted" }] }],
    ["Press the pedal and hold it", { ...ready, proposals: [{ state: "approved" }] }],
    ["Release the pedal", { ...ready, mode: "MOTION", proposals: [{ state: "executing" }] }],
    ["Release the pedal", { ...ready, mode: "MOTION", proposals: [{ state: "done" }] }],
    ["Unlock", { ...ready, mode: "LOCKED", proposals: [{ state: "done" }] }],
  ])("is to %s", (title, now) => {
    expect(steps[nextStep(now)]?.title).toBe(title);
  });

  it("is none after the first move", () => {
    expect(nextStep({ ...ready, proposals: [{ state: "done" }] })).toBe(steps.length);
  });
});

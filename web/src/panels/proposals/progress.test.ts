import { describe, expect, it } from "vitest";
import type { Motor, Proposal, Robot } from "../../api/client";
import { progressOf } from "./progress";

const motor = { unit: "mm", counts_per_unit: 10 } as Motor;
const robot = {
  auto_approve: false,
  home_steps: [
    { name: "out", title: "Probe out", kind: "home", axes: ["insertion"] },
    { name: "rest", title: "The rest", kind: "home", axes: ["yaw"] },
  ],
} as unknown as Robot;
const seen = { motor, robot, fromCounts: 0, nowCounts: 30 };
const of = (fields: Partial<Proposal>): Proposal => ({ state: "executing", axes: [], ...fields }) as Proposal;

describe("progressOf", () => {
  it("is the way of a move that is behind it, and names what is left", () => {
    expect(progressOf(of({ kind: "move", target_counts: 40 }), seen)).toEqual({
      share: 0.75,
      words: "1.0\u00a0mm left",
    });
    expect(progressOf(of({ kind: "move", target_counts: 20 }), seen)?.share).toBe(1);
    expect(progressOf(of({ kind: "move", target_counts: -20 }), seen)?.share).toBe(0);
  });

  it("is the part of a path, the step of homing, the frequency of a sweep", () => {
    expect(progressOf(of({ kind: "path", leg: 1, legs: 4 }), seen)).toEqual({
      share: 0.25,
      words: "part 2 of 4",
    });
    const homing = of({ kind: "home", step: "rest", axes: ["insertion", "yaw"] });
    expect(progressOf(homing, seen)).toEqual({ share: 0.5, words: "step 2 of 2: The rest" });
    const frequencies = [
      { hz: 52000, counts_per_s: 12 },
      { hz: 51900, counts_per_s: null },
    ];
    expect(progressOf(of({ kind: "sweep", frequencies }), seen)?.words).toBe("1 of 2 frequencies measured");
  });

  it("is none before it begins, and none of a biopsy or of what ended early", () => {
    for (const state of ["checked", "approved", "aborted", "refused"] as const) {
      expect(progressOf(of({ kind: "move", target_counts: 40, state }), seen)).toBeNull();
    }
    expect(progressOf(of({ kind: "biopsy" }), seen)).toBeNull();
    expect(progressOf(of({ kind: "path", state: "done" }), seen)?.share).toBe(1);
  });
});

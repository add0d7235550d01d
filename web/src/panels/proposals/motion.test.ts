import { describe, expect, it } from "vitest";
import type { Motor } from "../../api/client";
import type { AxisFrame } from "../../stream/decode";
import { type AblationRow, ablationDraft, coordinatedDraft, movedRow, type Ranged, ranged } from "./motion";

const motor = (name: string, title: string, unit: Motor["unit"], counts_per_unit: number): Motor =>
  ({ name, title, unit, counts_per_unit, soft_min_counts: 0, soft_max_counts: 400 }) as Motor;
const yaw: Ranged = { motor: motor("yaw", "Yaw", "rad", 1800 / Math.PI), low: -900, high: 0 };
const depth: Ranged = { motor: motor("insertion", "Probe insertion", "mm", 40), low: 0, high: 400 };
const row = (id: number, rotation: string, insertion: string, dwell: string): AblationRow => ({
  id,
  rotation,
  depth: insertion,
  dwell,
});

describe("ranged", () => {
  it("takes what the kernel accepts of a homed axis, and the soft limits of another", () => {
    const axis = { homed: true, minCounts: 12, maxCounts: 388 } as AxisFrame;
    expect(ranged(depth.motor, axis)).toMatchObject({ low: 12, high: 388 });
    expect(ranged(depth.motor, { ...axis, homed: false })).toMatchObject({ low: 0, high: 400 });
    expect(ranged(depth.motor, undefined)).toMatchObject({ low: 0, high: 400 });
  });
});

describe("coordinatedDraft", () => {
  it("sends the axes that have a target, in the unit of the interface", () => {
    expect(coordinatedDraft([yaw, depth], { yaw: "-45", insertion: " " }, "")).toEqual({
      ok: true,
      draft: { kind: "coordinated", targets: { yaw: -Math.PI / 4 } },
    });
    expect(coordinatedDraft([yaw, depth], { insertion: "2,5 mm" }, "4")).toEqual({
      ok: true,
      draft: { kind: "coordinated", targets: { insertion: 2.5 }, duration_s: 4 },
    });
  });

  it.each([
    [{}, "", "No axis has a target: write one for each axis that is to move."],
    [{ yaw: "left" }, "", "Yaw: “left” is no number; expected -90.0° to 0.0°."],
    [
      { insertion: "11" },
      "",
      "Probe insertion: 11 is outside its range; expected 0.00\u00a0mm to 10.00\u00a0mm.",
    ],
    [{ yaw: "-1" }, "3601", "Shortest duration: 3601 s is outside its range; expected 0 to 3600 s."],
    [{ yaw: "-1" }, "soon", "Shortest duration: “soon” is no number; expected 0 to 3600 s."],
  ])("of %j in %j says %j", (texts, duration, words) => {
    const read = coordinatedDraft([yaw, depth], texts, duration);
    expect(read.ok ? [] : [...read.problems.values()]).toEqual([words]);
  });

  it("takes the ends of the range, as they are shown", () => {
    expect(coordinatedDraft([depth], { insertion: "10.00" }, "").ok).toBe(true);
    expect(coordinatedDraft([depth], { insertion: "0" }, "").ok).toBe(true);
  });
});

describe("ablationDraft", () => {
  it("sends the steps in their order", () => {
    expect(ablationDraft(yaw, depth, [row(7, "-90", "3", "1.5"), row(2, "0", "4", "0")])).toEqual({
      ok: true,
      draft: {
        kind: "ablation",
        steps: [
          { probe_rotation: -Math.PI / 2, insertion: 3, dwell_s: 1.5 },
          { probe_rotation: 0, insertion: 4, dwell_s: 0 },
        ],
      },
    });
  });

  it("names the step and the field that is wrong", () => {
    const read = ablationDraft(yaw, depth, [row(7, "0", "3", "1"), row(2, "9", "", "-1")]);
    expect(read.ok ? [] : [...read.problems]).toEqual([
      ["2.rotation", "Step 2, rotation: 9 is outside its range; expected -90.0° to 0.0°."],
      ["2.depth", "Step 2, depth: it is empty; expected 0.00\u00a0mm to 10.00\u00a0mm."],
      ["2.dwell", "Step 2, rest: -1 s is outside its range; expected 0 to 3600 s."],
    ]);
    expect(ablationDraft(yaw, depth, []).ok).toBe(false);
  });
});

describe("movedRow", () => {
  const rows = [row(1, "", "", ""), row(2, "", "", ""), row(3, "", "", "")];
  const order = (moved: readonly AblationRow[]): number[] => moved.map(({ id }) => id);

  it("changes places with its neighbour, and stays at an end", () => {
    expect(order(movedRow(rows, 1, -1))).toEqual([2, 1, 3]);
    expect(order(movedRow(rows, 1, 1))).toEqual([1, 3, 2]);
    expect(movedRow(rows, 0, -1)).toBe(rows);
    expect(movedRow(rows, 2, 1)).toBe(rows);
  });
});

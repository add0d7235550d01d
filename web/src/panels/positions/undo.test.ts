import { describe, expect, it } from "vitest";
import type { DeclaredPositions, Motor } from "../../api/client";
import { undoStory } from "./undo";

const motors = [
  { slot: 0, title: "Yaw", unit: "rad", counts_per_unit: 1800 / Math.PI },
  { slot: 3, title: "Insertion", unit: "mm", counts_per_unit: -10 },
] as Motor[];

type Row = DeclaredPositions["axes"][number];
const row = (slot: number, before_counts: number, declared_counts: number, more: Partial<Row> = {}): Row => ({
  ...{ slot, axis: `axis_${slot}`, request: "SET_HOME", before_counts, declared_counts },
  ...{ homed_before: "BY_SWITCH", carries_registration: false, undoable: true, ...more },
});
const story = (...axes: Row[]) =>
  undoStory({ by: "ann", time: "2026-01-01T10:00:00Z", left_s: 42, axes }, motors);

describe("undoStory", () => {
  it("says of each axis from where to where it shifted, and by how much, in its unit", () => {
    const { what, shifts } = story(row(0, 125, 0), row(3, 50, 0), row(7, 5, 9));
    expect(what).toBe("Set Home");
    expect(shifts.map(({ words }) => words.replaceAll("\u00a0", " "))).toEqual([
      "Yaw: 12.5° → 0.0° (-12.5°)",
      "Insertion: -5.0 mm → 0.0 mm (+5.0 mm)",
      "axis_7: 5 → 9 counts",
    ]);
  });

  it("names what became invalid, a registration only where one may rest on these axes", () => {
    expect(story(row(0, 125, 0)).invalid).toBe(
      "Open moves of these axes ended. After Undo the axes are not homed.",
    );
    expect(story(row(0, 125, 0), row(3, 5, 0, { carries_registration: true })).invalid).toBe(
      "Open moves of these axes ended, and a registration that rested on them expired. Undo does not make it valid again. After Undo the axes are not homed.",
    );
  });

  it("is off once no axis stands where it was declared", () => {
    const moved = row(0, 125, 60, { request: "RESTORE", undoable: false });
    expect(story(moved, row(3, 5, 7, { request: "RESTORE" }))).toMatchObject({
      what: "Load",
      shifts: [{ moved: true }, { moved: false }],
      off: null,
    });
    expect(story(moved).off).toBe("Each axis moved since then, or was given another position.");
  });
});

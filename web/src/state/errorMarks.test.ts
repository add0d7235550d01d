import { describe, expect, it } from "vitest";
import type { HistoryRows } from "../api/client";
import { noMarks, withReset, withRows } from "./errorMarks";

const empty = { least: [], greatest: [] };

/** Rows with these extremes of the error of slot 3. */
function rows(
  first: number,
  errors: ([number, number] | null)[],
  change: Partial<HistoryRows> = {},
): HistoryRows {
  return {
    app_begun_s: 7,
    period_us: 1000,
    ticks_of_bucket: 33,
    first,
    next: first + errors.length - 1,
    more: false,
    run: errors.map(() => 1),
    last_tick: errors.map((_, row) => 33 * (first + row)),
    ticks: errors.map(() => 33),
    axes: [
      {
        slot: 3,
        position_counts: empty,
        setpoint_counts: empty,
        error_counts: {
          least: errors.map((each) => each?.[0] ?? null),
          greatest: errors.map((each) => each?.[1] ?? null),
        },
        velocity_counts_per_s: empty,
        drive: empty,
      },
    ],
    forces: null,
    ...change,
  };
}

describe("withRows", () => {
  it("keeps the error that was farthest from zero, and where", () => {
    const marks = withRows(noMarks, rows(1, [null, [-4, 9], [-12, 3], [-2, 2]]));
    expect(marks.bySlot[3]).toEqual({
      largestCounts: -12,
      atTick: 99,
      sinceTick: 33,
      unwatchedTicks: 0,
      nowCounts: 2,
    });
  });

  it("goes on with the rows after, and says when nothing is followed", () => {
    const marks = withRows(withRows(noMarks, rows(1, [[-4, 9]])), rows(2, [[0, 11], null]));
    expect(marks.bySlot[3]).toMatchObject({ largestCounts: 11, atTick: 66, sinceTick: 33, nowCounts: null });
  });

  it("has no mark before the axis followed anything", () => {
    expect(withRows(noMarks, rows(1, [null])).bySlot[3]?.largestCounts).toBeNull();
    expect(withRows(noMarks, rows(1, [[0, 0]])).bySlot[3]?.largestCounts).toBe(0);
  });

  it("keeps its mark over rows that nobody saw, and tells how many ticks that were", () => {
    const before = withRows(noMarks, rows(1, [[-4, 9]]));
    const after = withRows(before, rows(9, [[0, 1]])).bySlot[3];
    expect(after).toMatchObject({ largestCounts: 9, sinceTick: 33, unwatchedTicks: 7 * 33 });
  });

  it("begins anew with another kernel or app", () => {
    const before = withRows(noMarks, rows(1, [[-4, 9]]));
    expect(withRows(before, rows(2, [[0, 1]], { run: [2] })).bySlot[3]?.largestCounts).toBe(1);
    expect(withRows(before, rows(2, [[0, 1]], { app_begun_s: 8 })).bySlot[3]?.largestCounts).toBe(1);
  });
});

describe("withReset", () => {
  it("forgets the mark of that axis only up to now", () => {
    const reset = withReset(withRows(noMarks, rows(1, [[-4, 9]])), 3);
    expect(reset.bySlot[3]).toEqual({
      largestCounts: null,
      atTick: 33,
      sinceTick: 33,
      unwatchedTicks: 0,
      nowCounts: 9,
    });
    expect(withRows(reset, rows(2, [[-1, 2]])).bySlot[3]).toMatchObject({ largestCounts: 2, sinceTick: 33 });
  });

  it("leaves alone what is not there", () => {
    expect(withReset(noMarks, 5)).toBe(noMarks);
  });
});

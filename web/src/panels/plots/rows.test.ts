import { describe, expect, it } from "vitest";
import type { Extremes, HistoryRows } from "../../api/client";
import { MOST_ROWS, type Rows, withAnswer } from "./rows";

const constant = (count: number, value: number | null): Extremes => ({
  least: Array(count).fill(value),
  greatest: Array(count).fill(value),
});

/** Rows of the ticks that end with those given, of one axis. */
function answer(first: number, lastTicks: number[], change: Partial<HistoryRows> = {}): HistoryRows {
  const count = lastTicks.length;
  return {
    app_begun_s: 7,
    period_us: 1000,
    ticks_of_bucket: 33,
    first,
    next: first + count - 1,
    more: false,
    run: Array(count).fill(1),
    last_tick: lastTicks,
    ticks: Array(count).fill(33),
    axes: [
      {
        slot: 3,
        position_counts: { least: lastTicks.map((tick) => tick - 1), greatest: lastTicks },
        setpoint_counts: constant(count, null),
        error_counts: constant(count, null),
        velocity_counts_per_s: constant(count, 0),
        drive: constant(count, 0),
      },
    ],
    forces: null,
    ...change,
  };
}

const positions = (rows: Rows) => rows.axes.get(3)?.position_counts.greatest;

describe("withAnswer", () => {
  it("appends what continues", () => {
    const rows = withAnswer(withAnswer(null, answer(1, [33, 66])), answer(3, [99]));
    expect(rows.tick).toEqual([33, 66, 99]);
    expect(positions(rows)).toEqual([33, 66, 99]);
    expect(rows.axes.get(3)?.position_counts.least).toEqual([32, 65, 98]);
    expect(rows.newest).toBe(3);
  });

  it("keeps what it has when nothing came", () => {
    const rows = withAnswer(withAnswer(null, answer(1, [33, 66])), answer(3, []));
    expect(rows.tick).toEqual([33, 66]);
    expect(rows.newest).toBe(2);
  });

  it("bridges no ticks that nobody saw", () => {
    const rows = withAnswer(withAnswer(null, answer(1, [33])), answer(2, [330]));
    expect(rows.tick).toEqual([33, 34, 330]);
    expect(positions(rows)).toEqual([33, null, 330]);
    expect(rows.unseen).toEqual([0, 264, 0]);
  });

  it("counts the ticks that the app missed, but not those before the first", () => {
    const rows = withAnswer(null, answer(1, [33, 66], { ticks: [20, 30] }));
    expect(rows.unseen).toEqual([0, 3]);
  });

  it("begins anew with another kernel, also in the middle of an answer", () => {
    const before = withAnswer(null, answer(1, [33, 66]));
    const rows = withAnswer(before, answer(3, [99, 33], { run: [1, 2] }));
    expect(rows.run).toBe(2);
    expect(rows.tick).toEqual([33]);
    expect(rows.newest).toBe(4);
  });

  it("begins anew when the app did, whatever its numbers say", () => {
    const rows = withAnswer(withAnswer(null, answer(1, [33, 66])), answer(3, [500], { app_begun_s: 9 }));
    expect(rows.tick).toEqual([500]);
  });

  it("begins anew where rows were lost in between", () => {
    const rows = withAnswer(withAnswer(null, answer(1, [33, 66])), answer(9, [330]));
    expect(rows.tick).toEqual([330]);
  });

  it("forgets the oldest rows", () => {
    let rows: Rows | null = null;
    for (let first = 1; first <= MOST_ROWS + 300; first += 300) {
      rows = withAnswer(
        rows,
        answer(
          first,
          Array.from({ length: 300 }, (_, index) => 33 * (first + index)),
        ),
      );
    }
    expect(rows?.tick).toHaveLength(MOST_ROWS);
    expect(rows === null ? [] : positions(rows)).toHaveLength(MOST_ROWS);
    expect(rows?.tick.at(-1)).toBe(33 * (rows?.newest ?? 0));
  });

  it("has the forces of a robot with a needle", () => {
    const forces = { hand_n: constant(1, 0.5), needle_n: constant(1, null) };
    const rows = withAnswer(null, answer(1, [33], { forces }));
    expect(rows.forces?.hand_n.greatest).toEqual([0.5]);
    expect(rows.forces?.needle_n.greatest).toEqual([null]);
  });
});

import { describe, expect, it } from "vitest";
import type { Capture, Motor } from "../../api/client";
import { between, captureSheet, csvOf, historySheet } from "./charts";
import type { AxisRows, Rows } from "./rows";

const motor = (countsPerUnit: number): Motor =>
  ({ slot: 3, title: "Insertion", unit: "mm", counts_per_unit: countsPerUnit }) as Motor;

const column = (...values: (number | null)[]) => ({ least: values, greatest: values.slice() });

const axis: AxisRows = {
  position_counts: { least: [90, 190], greatest: [100, 200] },
  setpoint_counts: column(null, 210),
  error_counts: column(null, 10),
  velocity_counts_per_s: column(0, 1000),
  drive: column(0, -30),
};

const rows: Rows = {
  appBegunS: 7,
  periodUs: 500,
  run: 1,
  newest: 2,
  tick: [2000, 2066],
  unseen: [0, 0],
  axes: new Map([[3, axis]]),
  forces: null,
};

const capture: Capture = {
  slot: 3,
  period_us: 1000,
  tick: [10, 11, 13],
  begun_us: [0, 1010, 3000],
  position_counts: [100, null, 120],
  setpoint_counts: [110, 112, null],
  velocity_counts_per_s: [null, null, 50],
  drive: [5, 6, 7],
  forces: null,
};

/** Without what floating point adds. */
const rounded = (values: readonly (number | null)[] = []) =>
  values.map((value) => (value === null ? null : Number(value.toFixed(9))));

const chart = (title: string, sheet: ReturnType<typeof historySheet>) =>
  sheet?.charts.find((each) => each.title === title);

describe("historySheet", () => {
  it("is in the operator's unit, over the kernel's time", () => {
    const sheet = historySheet(rows, motor(100));
    expect(sheet?.timeS).toEqual([1, 1.033]);
    expect(chart("Position", sheet)?.unit).toBe("mm");
    expect(rounded(chart("Position", sheet)?.lines[1]?.least)).toEqual([0.9, 1.9]);
    expect(rounded(chart("Position", sheet)?.lines[1]?.greatest)).toEqual([1, 2]);
    expect(chart("Velocity", sheet)?.lines[0]?.greatest).toEqual([0, 10]);
    expect(chart("Drive", sheet)?.lines[0]?.least).toEqual([0, -30]);
  });

  it("keeps least below greatest where a count is negative", () => {
    const line = chart("Position", historySheet(rows, motor(-100)))?.lines[1];
    expect(rounded(line?.least)).toEqual([-1, -2]);
    expect(rounded(line?.greatest)).toEqual([-0.9, -1.9]);
  });

  it("has forces only for a robot with a needle", () => {
    expect(chart("Force", historySheet(rows, motor(100)))).toBeUndefined();
    const forces = { hand_n: column(0.1, 0.2), needle_n: column(null, 0.3) };
    const sheet = historySheet({ ...rows, forces }, motor(100));
    expect(chart("Force", sheet)?.lines.map(({ label }) => label)).toEqual(["hand", "needle"]);
  });

  it("is nothing for an axis that the app does not tell of", () => {
    expect(historySheet({ ...rows, axes: new Map() }, motor(100))).toBeNull();
  });
});

describe("captureSheet", () => {
  const sheet = captureSheet(capture, motor(10));

  it("has an error only where setpoint and position are there", () => {
    expect(chart("Error", sheet)?.lines[0]?.least).toEqual([1, null, null]);
  });

  it("measures the time only between ticks that follow each other", () => {
    expect(chart("Since the tick before", sheet)?.lines[0]?.least).toEqual([null, 1010, null]);
  });
});

describe("captureSheet of velocity and force", () => {
  it("has the velocity in the operator's unit, and no force where there is no needle", () => {
    const sheet = captureSheet(capture, motor(10));
    expect(chart("Velocity", sheet)?.lines[0]?.least).toEqual([null, null, 5]);
    expect(chart("Force", sheet)).toBeUndefined();
  });

  it("has both forces of a robot with a needle", () => {
    const forces = { hand_n: [1, 2, 3], needle_n: [null, 0.5, 0.6] };
    const lines = chart("Force", captureSheet({ ...capture, forces }, motor(10)))?.lines ?? [];
    expect(lines.map(({ label, least }) => [label, least])).toEqual([
      ["hand", [1, 2, 3]],
      ["needle", [null, 0.5, 0.6]],
    ]);
  });
});

describe("between", () => {
  it("cuts every column at both times, which count", () => {
    const part = between(captureSheet(capture, motor(10)), 0.011, 0.013);
    expect(part.tick).toEqual([11, 13]);
    expect(rounded(part.charts[0]?.lines[0]?.least)).toEqual([11.2, null]);
  });

  it("is empty outside", () => {
    expect(between(captureSheet(capture, motor(10)), 5, 6).tick).toEqual([]);
  });
});

describe("csvOf", () => {
  it("has two columns for a line of extremes, one for single ticks, and nothing where nothing was", () => {
    const table = csvOf(captureSheet(capture, motor(10))).split("\n");
    expect(table[0]).toBe(
      "tick,time (s),Position: setpoint (mm),Position: measured (mm),Error: setpoint less measured (mm)," +
        "Velocity: of 20 ms (mm/s),Drive: sent (words),Since the tick before: real time (µs)",
    );
    expect(table[2]).toBe("11,0.011,11.2,,,,6,1010");
    const part = between(captureSheet(capture, motor(10)), 0, 1);
    expect(csvOf(part).split("\n")[0]).toBe(table[0]);
    const sheet = historySheet(rows, motor(100));
    expect(sheet === null ? "" : csvOf(sheet).split("\n")[0]).toContain(
      "Position: measured (mm) least,Position: measured (mm) greatest",
    );
  });
});

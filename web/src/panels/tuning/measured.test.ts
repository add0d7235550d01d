import { describe, expect, it } from "vitest";
import type { Motor } from "../../api/client";
import { figuresOf, HEIGHT, LEFT, type Measured, speedPlot, WIDTH } from "./measured";

const measured: Measured = {
  homing_error: null,
  dead_zone_drive: 500,
  full_speed_counts_per_s: 700,
  fit_percent: 0.31,
  lag_ms: 8.04,
  coast_counts: 6,
  backlash_counts: 2.9,
  noise_counts: 1,
  hysteresis_counts: null,
  speeds: [
    { drive: 1000, up_counts_per_s: 700, down_counts_per_s: 690 },
    { drive: 600, up_counts_per_s: 140, down_counts_per_s: 138 },
    { drive: 400, up_counts_per_s: 0, down_counts_per_s: 0 },
  ],
};
const motor = { unit: "mm", counts_per_unit: 10, max_drive: 1000 } as Motor;

describe("speed over drive", () => {
  it("has the fastest mark highest, what stood on the ground, and its line from the dead zone to full speed", () => {
    const { up, down, line } = speedPlot(measured, 1000);
    const [fast, slow, stood] = up;
    expect(fast?.y).toBeLessThan(slow?.y ?? 0);
    expect(slow?.y).toBeLessThan(stood?.y ?? 0);
    expect(down[2]).toEqual(stood);
    expect(line?.[0]).toEqual({ x: ((fast?.x ?? 0) + LEFT) / 2, y: stood?.y });
    expect(line?.[1]).toEqual(fast);
    for (const { x, y } of [...up, ...down]) {
      expect(x).toBeGreaterThanOrEqual(LEFT);
      expect(x).toBeLessThan(WIDTH);
      expect(y).toBeGreaterThan(0);
      expect(y).toBeLessThan(HEIGHT);
    }
  });

  it("has no line before the figures are known, and no mark before the first move", () => {
    const plot = speedPlot({ ...measured, full_speed_counts_per_s: 0, dead_zone_drive: 0, speeds: [] }, 1000);
    expect(plot.line).toBeNull();
    expect(plot.up).toEqual([]);
  });
});

describe("figures", () => {
  it("come with counts, the operator's unit, and what was not measured", () => {
    const values = figuresOf({ ...measured, coast_counts: null }, motor).map(({ value }) => value);
    expect(values).toEqual([
      "500 (50.0 % of the largest drive)",
      "700 counts/s (70.0\u00a0mm/s)",
      "0.31 % of full speed",
      "8.0 ms",
      "not seen whole",
      "2.9 counts (0.3\u00a0mm)",
      "1 counts (0.1\u00a0mm)",
      "not measured here",
    ]);
  });
});

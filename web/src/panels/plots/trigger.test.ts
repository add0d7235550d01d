import { describe, expect, it } from "vitest";
import type { Motor } from "../../api/client";
import type { AxisFrame } from "../../stream/decode";
import type { AxisRows, Rows } from "./rows";
import { type Armed, firedAt, lastTickOf, type Trigger } from "./trigger";

const motor = (countsPerUnit = 100): Motor =>
  ({ slot: 3, unit: "mm", counts_per_unit: countsPerUnit }) as Motor;

const none = { least: [null, null, null], greatest: [null, null, null] };
const axis: AxisRows = {
  position_counts: { least: [0, 0, 0], greatest: [0, 0, 0] },
  setpoint_counts: none,
  error_counts: { least: [-5, -20, -5], greatest: [5, 30, 5] },
  velocity_counts_per_s: none,
  drive: { least: [0, 0, -7], greatest: [0, 0, 0] },
};
const rows: Rows = {
  appBegunS: 7,
  periodUs: 1000,
  run: 1,
  newest: 3,
  tick: [33, 66, 99],
  unseen: [0, 0, 0],
  axes: new Map([[3, axis]]),
  forces: null,
};

const armed = (trigger: Trigger, sinceTick = 0): Armed => ({ trigger, sinceTick, seconds: 2 });
const level = (
  quantity: "error_counts" | "velocity_counts_per_s" | "drive",
  edge: "above" | "below",
  at: number,
) => armed({ on: "level", quantity, edge, level: at });
const quiet = { fault: "NONE", faultTick: 0 } as AxisFrame;

describe("firedAt", () => {
  it("finds a peak of one tick by the extremes, in the operator's unit", () => {
    expect(firedAt(level("error_counts", "above", 0.29), rows, motor(), quiet)).toBe(66);
    expect(firedAt(level("error_counts", "above", 0.3), rows, motor(), quiet)).toBeNull();
    expect(firedAt(level("error_counts", "below", -0.1), rows, motor(), quiet)).toBe(66);
  });

  it("turns the sense round where a count is negative", () => {
    expect(firedAt(level("error_counts", "above", 0.19), rows, motor(-100), quiet)).toBe(66);
    expect(firedAt(level("error_counts", "above", 0.21), rows, motor(-100), quiet)).toBeNull();
  });

  it("takes the drive in words", () => {
    expect(firedAt(level("drive", "below", -6), rows, motor(), quiet)).toBe(99);
  });

  it("counts only what came after it was armed, and nothing that is not there", () => {
    const later = { ...level("error_counts", "above", 0.29), sinceTick: 66 };
    expect(firedAt(later, rows, motor(), quiet)).toBeNull();
    expect(firedAt(level("velocity_counts_per_s", "above", -1), rows, motor(), quiet)).toBeNull();
  });

  it("waits for a fault that is new", () => {
    const faulted = { fault: "STALL", faultTick: 70 } as AxisFrame;
    expect(firedAt(armed({ on: "fault" }, 60), rows, motor(), faulted)).toBe(70);
    expect(firedAt(armed({ on: "fault" }, 70), rows, motor(), faulted)).toBeNull();
    expect(firedAt(armed({ on: "fault" }, 60), rows, motor(), quiet)).toBeNull();
  });
});

describe("lastTickOf", () => {
  it("leaves as much after the trigger as before it", () => {
    expect(lastTickOf(armed({ on: "fault" }), 5000, 1000)).toBe(6000);
    expect(lastTickOf(armed({ on: "fault" }), 5000, 500)).toBe(7000);
  });
});

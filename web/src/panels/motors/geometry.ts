/** Where counts lie on a track. */
import type { Motor } from "../../api/client";
import type { AxisFrame } from "../../stream/decode";

export interface Domain {
  readonly min: number;
  readonly max: number;
}

/** Share of the soft range shown beyond each soft limit, so that a position outside can be seen and proposed. */
const MARGIN = 0.06;
/** An axis beyond the margin widens the track in such steps of the soft range, so that the track does not swim. */
const WIDENING = 0.25;

/** The counts that a track shows: the soft range, and the measured position wherever it is. */
export function trackDomain(motor: Motor, axis: AxisFrame): Domain {
  const range = motor.soft_max_counts - motor.soft_min_counts;
  const min = motor.soft_min_counts - MARGIN * range;
  const max = motor.soft_max_counts + MARGIN * range;
  const widening = (beyond: number): number =>
    Math.ceil(Math.max(0, beyond) / (WIDENING * range)) * WIDENING * range;
  return { min: min - widening(min - axis.positionCounts), max: max + widening(axis.positionCounts - max) };
}

/** Place of a count from 0 (left end) to 1 (right end), held inside the track. */
export function fractionOf(domain: Domain, counts: number): number {
  const fraction = (counts - domain.min) / (domain.max - domain.min);
  return Math.min(1, Math.max(0, fraction));
}

/** The whole count at that place of the track. */
export function countsAt(domain: Domain, fraction: number): number {
  const held = Math.min(1, Math.max(0, fraction));
  return Math.round(domain.min + held * (domain.max - domain.min));
}

/** Preview after a key, or null when the key does not move it. Steps: 1 % of the soft range, 10 % by page keys. */
export function previewAfterKey(motor: Motor, axis: AxisFrame, preview: number, key: string): number | null {
  const domain = trackDomain(motor, axis);
  const range = motor.soft_max_counts - motor.soft_min_counts;
  const step = Math.max(1, Math.round(range / 100));
  const clamp = (counts: number): number =>
    Math.min(Math.floor(domain.max), Math.max(Math.ceil(domain.min), counts));
  switch (key) {
    case "ArrowRight":
    case "ArrowUp":
      return clamp(preview + step);
    case "ArrowLeft":
    case "ArrowDown":
      return clamp(preview - step);
    case "PageUp":
      return clamp(preview + 10 * step);
    case "PageDown":
      return clamp(preview - 10 * step);
    case "Home":
      return axis.minCounts;
    case "End":
      return axis.maxCounts;
    default:
      return null;
  }
}

export function isAllowed(axis: AxisFrame, counts: number): boolean {
  return counts >= axis.minCounts && counts <= axis.maxCounts;
}

/** Where the axis may still go when its drive is taken away now; null while it is not driven. */
export function stoppingRange(motor: Motor, axis: AxisFrame): Domain | null {
  const { positionCounts } = axis;
  if (axis.direction === "INCREASING")
    return { min: positionCounts, max: positionCounts + motor.coast_counts };
  if (axis.direction === "DECREASING")
    return { min: positionCounts - motor.coast_counts, max: positionCounts };
  return null;
}

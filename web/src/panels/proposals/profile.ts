/** How an axis will go, as curves beside its limits. Numbers come from the app's plan; nothing is planned here. */
import type { AxisProfile, Motor, ProposalPlan } from "../../api/client";
import { formatCounts, formatNumber, shownPerCount, unitName } from "../../units/units";

export type Profile = ProposalPlan["profile"];

/** Of the drawings, in their own units. */
export const WIDTH = 400;
export const HEIGHT = 100;

export interface Curve {
  readonly title: string;
  /** What the curve says to whoever does not see it. */
  readonly words: string;
  /** Of an SVG polyline, within `WIDTH` and `HEIGHT`. */
  readonly points: string;
  /** Heights of lines that the curve must not cross. */
  readonly limits: readonly number[];
  /** Where the kernel takes setpoints: top and bottom of a band, or its left and right end for a curve over positions. */
  readonly band: readonly [number, number] | null;
  /** Whether the curve runs over positions, so that the band stands upright. */
  readonly overWay: boolean;
  /** Below the left and the right end. */
  readonly ends: readonly [string, string];
  /** Whether it keeps to its limits. */
  readonly within: boolean;
}

interface Span {
  readonly low: number;
  readonly high: number;
}

/** Room on both sides, so that a curve at its limit is told from the edge. */
const MARGIN = 0.06;
/** Rounding of the answer. */
const SLACK = 0.01;

export function curvesOf(profile: Profile, axis: AxisProfile, motor: Motor): readonly Curve[] {
  if (profile.basis === "time")
    return [positionOverTime(profile, axis, motor), speedOverTime(profile, axis, motor)];
  return profile.basis === "way" ? [driveOverWay(axis, motor)] : [];
}

/** The end of the motion. */
export function endCounts(axis: AxisProfile): number {
  return axis.positions_counts.at(-1) ?? 0;
}

function positionOverTime({ times_s }: Profile, axis: AxisProfile, motor: Motor): Curve {
  const span = withMargin(positionsOf(axis));
  const height = heights(span);
  const times = spanOf(times_s);
  return {
    title: "Position",
    words: `${positionWords(axis, motor)}, ${rangeWords(axis, motor)}`,
    points: pointsOf(times_s.map(places(times)), axis.positions_counts.map(height)),
    limits: softLimits(axis).map(height),
    band: [height(axis.highest_setpoint_counts), height(axis.lowest_setpoint_counts)],
    overWay: false,
    ends: timeEnds(times),
    within: keepsWithin(axis),
  };
}

function speedOverTime({ times_s }: Profile, axis: AxisProfile, motor: Motor): Curve {
  const limit = axis.velocity_limit_counts_per_s ?? 0;
  const most = Math.max(limit, axis.fastest_counts_per_s, 1);
  const height = heights(withMargin({ low: -most, high: most }));
  const times = spanOf(times_s);
  return {
    title: "Velocity",
    words: `at most ${speedText(motor, axis.fastest_counts_per_s)} of ${speedText(motor, limit)}`,
    points: pointsOf(times_s.map(places(times)), axis.velocities_counts_per_s.map(height)),
    limits: [height(limit), height(-limit)],
    band: null,
    overWay: false,
    ends: timeEnds(times),
    within: axis.fastest_counts_per_s <= limit + SLACK,
  };
}

/** A move of one axis has no plan in time: its drive follows the way that is left. */
function driveOverWay(axis: AxisProfile, motor: Motor): Curve {
  const span = withMargin(positionsOf(axis));
  const place = places(span);
  const most = Math.max(axis.drive_limit, ...axis.drives, 1);
  const height = heights({ low: 0, high: most * (1 + MARGIN) });
  return {
    title: "Drive over the way",
    words:
      `${positionWords(axis, motor)}, ${rangeWords(axis, motor)}; ` +
      `drive up to ${percent(Math.max(0, ...axis.drives), axis.drive_limit)} of the axis' bound`,
    points: pointsOf(axis.positions_counts.map(place), axis.drives.map(height)),
    limits: [height(axis.drive_limit)],
    band: [place(axis.lowest_setpoint_counts), place(axis.highest_setpoint_counts)],
    overWay: true,
    ends: [formatCounts(motor, Math.round(span.low)), formatCounts(motor, Math.round(span.high))],
    within: keepsWithin(axis) && axis.drives.every((drive) => drive <= axis.drive_limit),
  };
}

/** Whether it ends where the kernel takes setpoints, and never leaves the soft limits on the way. */
function keepsWithin(axis: AxisProfile): boolean {
  const end = endCounts(axis);
  const ends = end >= axis.lowest_setpoint_counts - 0.5 && end <= axis.highest_setpoint_counts + 0.5;
  const stays =
    axis.lowest_counts >= axis.soft_min_counts - 0.5 && axis.highest_counts <= axis.soft_max_counts + 0.5;
  return ends && (stays || !axis.homed);
}

/** Soft limits say nothing of an axis that is not homed. */
function softLimits(axis: AxisProfile): number[] {
  return axis.homed ? [axis.soft_min_counts, axis.soft_max_counts] : [];
}

function positionsOf(axis: AxisProfile): Span {
  const all = [
    ...softLimits(axis),
    axis.lowest_setpoint_counts,
    axis.highest_setpoint_counts,
    axis.lowest_counts,
    axis.highest_counts,
  ];
  return spanOf(all);
}

function positionWords(axis: AxisProfile, motor: Motor): string {
  const from = Math.round(axis.positions_counts[0] ?? 0);
  return `${formatCounts(motor, from)} to ${formatCounts(motor, Math.round(endCounts(axis)))}`;
}

function rangeWords(axis: AxisProfile, motor: Motor): string {
  const lowest = formatNumber(motor, axis.lowest_setpoint_counts);
  return `allowed ${lowest} to ${formatCounts(motor, axis.highest_setpoint_counts)}`;
}

function speedText(motor: Motor, countsPerS: number): string {
  return `${(countsPerS * shownPerCount(motor)).toFixed(1)} ${unitName(motor)}/s`;
}

function percent(share: number, whole: number): string {
  return whole === 0 ? "none" : `${Math.round((100 * share) / whole)} %`;
}

function timeEnds({ low, high }: Span): readonly [string, string] {
  return [`${low.toFixed(1)} s`, `${high.toFixed(1)} s`];
}

function spanOf(values: readonly number[]): Span {
  return values.length === 0 ? { low: 0, high: 1 } : { low: Math.min(...values), high: Math.max(...values) };
}

function withMargin({ low, high }: Span): Span {
  const room = Math.max((high - low) * MARGIN, 1);
  return { low: low - room, high: high + room };
}

function places({ low, high }: Span): (value: number) => number {
  return (value) => (high > low ? (WIDTH * (value - low)) / (high - low) : 0);
}

function heights({ low, high }: Span): (value: number) => number {
  return (value) => HEIGHT - (HEIGHT * (value - low)) / (high - low);
}

function pointsOf(xs: readonly number[], ys: readonly number[]): string {
  return xs.map((x, index) => `${x.toFixed(1)},${(ys[index] ?? 0).toFixed(1)}`).join(" ");
}

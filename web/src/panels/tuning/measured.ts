/** What was measured of an axis, as figures for people and as a drawing of speed over drive. */
import type { Motor, Proposal } from "../../api/client";
import { formatCounts } from "../../units/units";

export type Measured = NonNullable<Proposal["measured"]>;

export const WIDTH = 560;
export const HEIGHT = 260;
/** Of the drawing, for its numbers. */
export const LEFT = 52;
export const BOTTOM = 30;
const TOP = 10;
const RIGHT = 12;
/** Counts a second that the drawing covers before anything was measured. */
const LEAST_SPEED = 100;

export interface Mark {
  readonly x: number;
  readonly y: number;
}

export interface SpeedPlot {
  readonly up: readonly Mark[];
  readonly down: readonly Mark[];
  /** From the dead zone to the largest drive; null before it is known. */
  readonly line: readonly [Mark, Mark] | null;
  readonly drives: readonly { readonly x: number; readonly words: string }[];
  readonly speeds: readonly { readonly y: number; readonly words: string }[];
}

/** Where the marks of an axis with that largest drive come to lie. */
export function speedPlot(measured: Measured, maxDrive: number): SpeedPlot {
  const { speeds, full_speed_counts_per_s: full, dead_zone_drive: deadZone } = measured;
  const fastest = niceAbove(
    Math.max(
      LEAST_SPEED,
      full,
      ...speeds.flatMap(({ up_counts_per_s, down_counts_per_s }) => [up_counts_per_s, down_counts_per_s]),
    ),
  );
  const x = (drive: number): number => LEFT + (drive / maxDrive) * (WIDTH - LEFT - RIGHT);
  const y = (speed: number): number => HEIGHT - BOTTOM - (speed / fastest) * (HEIGHT - BOTTOM - TOP);
  return {
    up: speeds.map(({ drive, up_counts_per_s }) => ({ x: x(drive), y: y(up_counts_per_s) })),
    down: speeds.map(({ drive, down_counts_per_s }) => ({ x: x(drive), y: y(down_counts_per_s) })),
    line:
      full === 0
        ? null
        : [
            { x: x(deadZone), y: y(0) },
            { x: x(maxDrive), y: y(full) },
          ],
    drives: [0, 25, 50, 75, 100].map((share) => ({ x: x((share / 100) * maxDrive), words: `${share} %` })),
    speeds: [0, 0.25, 0.5, 0.75, 1].map((share) => ({
      y: y(share * fastest),
      words: String(Math.round(share * fastest)),
    })),
  };
}

/** One, two, four or five times a power of ten. */
function niceAbove(value: number): number {
  const power = 10 ** Math.floor(Math.log10(value));
  const factor = [1, 2, 4, 5, 8, 10].find((each) => each * power >= value) ?? 10;
  return factor * power;
}

export interface Figure {
  readonly name: string;
  readonly value: string;
  readonly meaning: string;
}

/** All figures with their units, once they are known. */
export function figuresOf(measured: Measured, motor: Motor): readonly Figure[] {
  const share = (100 * measured.dead_zone_drive) / motor.max_drive;
  const { coast_counts, full_speed_counts_per_s } = measured;
  return [
    {
      name: "Dead zone",
      value: `${measured.dead_zone_drive.toFixed(0)} (${share.toFixed(1)} % of the largest drive)`,
      meaning: "largest drive that does not move the axis",
    },
    {
      name: "Full speed",
      value: `${full_speed_counts_per_s.toFixed(0)} counts/s (${formatCounts(motor, full_speed_counts_per_s)}/s)`,
      meaning: "at the largest drive, in the faster direction",
    },
    {
      name: "Straightness",
      value: `${measured.fit_percent.toFixed(2)} % of full speed`,
      meaning: "standard deviation of the speeds from their line",
    },
    { name: "Lag", value: `${measured.lag_ms.toFixed(1)} ms`, meaning: "time constant of the speed" },
    {
      name: "Coast",
      value: coast_counts === null ? "not seen whole" : counts(motor, coast_counts),
      meaning: "farthest from the last drive until rest",
    },
    {
      name: "Play",
      value: counts(motor, measured.backlash_counts, 1),
      meaning: "lost motion when the direction changes",
    },
    {
      name: "Noise",
      value: counts(motor, measured.noise_counts),
      meaning: "of the counter at rest, peak to peak in 5 s",
    },
    {
      name: "Switch hysteresis",
      value: "not measured here",
      meaning: "only homing shows it: interlock identify",
    },
  ];
}

function counts(motor: Motor, value: number, digits = 0): string {
  return `${value.toFixed(digits)} counts (${formatCounts(motor, value)})`;
}

/** Rigid poses: 16 numbers row by row, in the scanner's frame (RAS), mm. */

export const rowNames = ["R", "A", "S"] as const;
export const columnNames = ["x", "y", "z", "origin"] as const;

/** What the app accepts of a pose: spec/openapi.yaml, schema Pose. */
const RIGID_TOLERANCE = 1e-3;
export const FARTHEST_MM = 10_000;

const IDENTITY_LAST_ROW = [0, 0, 0, 1] as const;
const DEGREES = 180 / Math.PI;

/** The upper three rows, which are all that can differ. */
export function upperRows(pose: readonly number[]): readonly number[] {
  return pose.slice(0, 12);
}

export function wholePose(upper: readonly number[]): number[] {
  return [...upper, ...IDENTITY_LAST_ROW];
}

type Vector = readonly [number, number, number];

function column(pose: readonly number[], at: number): Vector {
  const value = (row: number): number => pose[4 * row + at] ?? Number.NaN;
  return [value(0), value(1), value(2)];
}

export function originOf(pose: readonly number[]): Vector {
  return column(pose, 3);
}

function dot(a: Vector, b: Vector): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

function cross(a: Vector, b: Vector): Vector {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

/** Why a matrix is no rigid pose: what, where, what was expected. Empty when it is one. */
export function poseProblems(pose: readonly number[]): string[] {
  const axes = [column(pose, 0), column(pose, 1), column(pose, 2)] as const;
  const problems: string[] = [];
  for (const [at, value] of originOf(pose).entries()) {
    if (!(Math.abs(value) <= FARTHEST_MM)) {
      problems.push(
        `Row ${rowNames[at]}, origin: ${value} mm is too far away; expected ${-FARTHEST_MM} to ${FARTHEST_MM} mm.`,
      );
    }
  }
  for (const [at, axis] of axes.entries()) {
    if (!(Math.abs(dot(axis, axis) - 1) <= RIGID_TOLERANCE)) {
      const length = Math.sqrt(dot(axis, axis)).toFixed(4);
      problems.push(
        `Column ${columnNames[at]}: its length is ${length}; expected 1, its square within 0.001.`,
      );
    }
  }
  for (const [one, other] of [
    [0, 1],
    [0, 2],
    [1, 2],
  ] as const) {
    const product = dot(axes[one], axes[other]);
    if (!(Math.abs(product) <= RIGID_TOLERANCE)) {
      problems.push(
        `Columns ${columnNames[one]} and ${columnNames[other]}: they are not perpendicular, their product is ` +
          `${product.toFixed(4)}; expected 0 within 0.001.`,
      );
    }
  }
  const determinant = dot(axes[0], cross(axes[1], axes[2]));
  if (problems.length === 0 && !(Math.abs(determinant - 1) <= 3 * RIGID_TOLERANCE)) {
    problems.push(
      `The rotation mirrors: its determinant is ${determinant.toFixed(4)}; expected +1. Check the signs of a column.`,
    );
  }
  return problems;
}

export interface Deviation {
  readonly offset_mm: readonly number[];
  readonly distance_mm: number;
  /** Between the two ways in which the probe advances. */
  readonly angle_deg: number;
}

/** How far a reached pose is from a desired one, as the app tells it of its own. */
export function deviationOf(reached: readonly number[], desired: readonly number[]): Deviation {
  const [to, from] = [originOf(reached), originOf(desired)];
  const offset: Vector = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
  return {
    offset_mm: offset,
    distance_mm: Math.hypot(...offset),
    angle_deg: angleBetween(column(reached, 2), column(desired, 2)),
  };
}

/** By atan2: the arc cosine knows no small angles. */
function angleBetween(a: Vector, b: Vector): number {
  return Math.atan2(Math.hypot(...cross(a, b)), dot(a, b)) * DEGREES;
}

/** By how much one pose is turned against another, about whichever axis. */
export function turnBetween(one: readonly number[], other: readonly number[]): number {
  const trace = [0, 1, 2].reduce((sum, at) => sum + dot(column(one, at), column(other, at)), 0);
  return Math.acos(Math.min(1, Math.max(-1, (trace - 1) / 2))) * DEGREES;
}

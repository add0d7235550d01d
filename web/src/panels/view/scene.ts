/**
 * What the 3D view shows, in the scanner's frame (RAS), mm: poses and points that the app knows, and nothing else. A pose
 * is a homogeneous matrix, row by row.
 */
import type { AlignmentView, Targeting } from "../../api/client";

export type Point = readonly [x: number, y: number, z: number];

export interface Axes {
  readonly name: string;
  /** Row by row, 16 numbers. */
  readonly pose: readonly number[];
  readonly lengthMm: number;
}

/** The probe from its cannula to its tip, along z of the treatment point. */
export interface Probe {
  readonly name: string;
  readonly kind: "current" | "reachable" | "desired";
  readonly cannula: Point;
  readonly treatment: Point;
  readonly tip: Point;
}

export interface Mark {
  readonly name: string;
  readonly kind: "entry" | "target";
  readonly at: Point;
}

export interface Scene {
  readonly axes: readonly Axes[];
  readonly probes: readonly Probe[];
  readonly marks: readonly Mark[];
  /** From the current treatment point to the desired one. */
  readonly deviation: readonly [Point, Point] | null;
  /** What is not shown, and why. */
  readonly missing: readonly string[];
}

const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
const FRAME_MM = 40;
const TOOL_MM = 18;

export function sceneOf(targeting: Targeting, view: AlignmentView): Scene {
  const { alignment, current } = view;
  const probe = (name: string, kind: Probe["kind"], pose: readonly number[]): Probe => ({
    name,
    kind,
    cannula: along(pose, -targeting.cannula_to_treatment_offset),
    treatment: along(pose, 0),
    tip: along(pose, targeting.treatment_to_tip_offset),
  });
  const probes: Probe[] = [];
  if (alignment !== null) {
    probes.push(probe("desired", "desired", alignment.desired));
    probes.push(probe("reachable", "reachable", alignment.reachable));
  }
  if (current !== null) probes.push(probe("current", "current", current));
  return {
    axes: [
      { name: "scanner (RAS)", pose: IDENTITY, lengthMm: FRAME_MM },
      { name: "zFrame", pose: targeting.registration, lengthMm: FRAME_MM },
      ...(current === null ? [] : [{ name: "treatment point", pose: current, lengthMm: TOOL_MM }]),
    ],
    probes,
    marks: [...markOf("entry", targeting.entry_point), ...markOf("target", targeting.target_point)],
    deviation:
      current === null || alignment === null ? null : [along(current, 0), along(alignment.desired, 0)],
    missing: [view.current_problem, view.alignment_problem].flatMap((problem) =>
      problem === null ? [] : [`${problem.code}: ${problem.text}`],
    ),
  };
}

function markOf(kind: Mark["kind"], point: readonly number[] | null): Mark[] {
  const at = point === null ? null : pointOf(point);
  return at === null ? [] : [{ name: kind, kind, at }];
}

function pointOf([x, y, z]: readonly number[]): Point | null {
  return x === undefined || y === undefined || z === undefined ? null : [x, y, z];
}

/** The point so far along z of a pose. */
export function along(pose: readonly number[], mm: number): Point {
  const at = (row: number): number => (pose[4 * row + 3] ?? 0) + mm * (pose[4 * row + 2] ?? 0);
  return [at(0), at(1), at(2)];
}

export interface Ball {
  readonly centre: Point;
  readonly radiusMm: number;
}

const LEAST_RADIUS_MM = 30;

/** A ball around everything that is there. */
export function ballAround(scene: Scene): Ball {
  const points: Point[] = [
    ...scene.axes.map(({ pose }) => along(pose, 0)),
    ...scene.probes.flatMap(({ cannula, tip }) => [cannula, tip]),
    ...scene.marks.map(({ at }) => at),
  ];
  const ends = ([0, 1, 2] as const).map((axis) => {
    const values = points.map((point) => point[axis]);
    return { low: Math.min(...values), high: Math.max(...values) };
  });
  const [x, y, z] = ends.map(({ low, high }) => (low + high) / 2);
  const centre: Point = [x ?? 0, y ?? 0, z ?? 0];
  const farthest = Math.max(...points.map((point) => distance(point, centre)));
  return { centre, radiusMm: Math.max(LEAST_RADIUS_MM, farthest + FRAME_MM / 2) };
}

export function distance(a: Point, b: Point): number {
  return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/** What the scene says to whoever does not see it. */
export function wordsOf(scene: Scene): string {
  const text = (point: Point): string => point.map((value) => value.toFixed(1)).join(", ");
  const probes = scene.probes.map(({ name, treatment }) => `${name} treatment point ${text(treatment)}`);
  const marks = scene.marks.map(({ name, at }) => `${name} ${text(at)}`);
  return [...probes, ...marks].join("; ") || "frames alone";
}

/**
 * What the 3D view shows, in the scanner's frame (RAS), mm, or in the robot's own while no registration is valid: poses and
 * points that the app knows, and nothing else. A pose is a homogeneous matrix, row by row.
 */
import type { AlignmentView, BodyPart, ErrorBudget, ProposalPlan, Reach, Targeting } from "../../api/client";

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

/** A straight part of the robot, as long as its kinematics say. */
export interface Part {
  readonly name: BodyPart["name"];
  readonly from: Point;
  readonly to: Point;
}

export interface Body {
  readonly kind: "current" | "ghost";
  readonly parts: readonly Part[];
}

/** Where a proposal leads: its tip at the end, and the way there. */
export interface Ghost {
  readonly id: number;
  readonly tip: Point;
  readonly path: readonly Point[];
}

/** Where the treatment point is with a probability of 95 %, as far as its error is known. */
export interface Ellipsoid {
  readonly centre: Point;
  /** The longest first. */
  readonly halfAxesMm: Point;
  /** Unit vectors along the half axes, one after the other. */
  readonly directions: readonly number[];
}

export interface Scene {
  readonly bodies: readonly Body[];
  readonly ghost: Ghost | null;
  readonly axes: readonly Axes[];
  readonly probes: readonly Probe[];
  readonly marks: readonly Mark[];
  /** Of the reachable pose; null where it has no error budget. */
  readonly ellipsoid: Ellipsoid | null;
  /** From the current treatment point to the desired one. */
  readonly deviation: readonly [Point, Point] | null;
  /** What is not shown, and why. */
  readonly missing: readonly string[];
}

const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
const FRAME_MM = 40;
const TOOL_MM = 18;

/** What is looked at besides the targeting. */
export interface Wanted {
  /** Whether the robot itself is drawn. */
  readonly robot: boolean;
  readonly plan: ProposalPlan | null;
}

const NOTHING_MORE: Wanted = { robot: false, plan: null };

export function sceneOf(
  targeting: Targeting,
  view: AlignmentView,
  { robot, plan }: Wanted = NOTHING_MORE,
): Scene {
  const { alignment, current } = view;
  const registration = registrationOf(targeting, view);
  const ghost = plan?.ghost?.frame === view.frame ? plan.ghost : null;
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
    bodies: [
      ...(robot && view.current_body !== null ? [bodyOf("current", view.current_body)] : []),
      ...(ghost === null ? [] : [bodyOf("ghost", ghost.body)]),
    ],
    ghost:
      plan === null || ghost === null
        ? null
        : { id: plan.id, tip: pointAt(ghost.tip), path: ghost.tip_path.map(pointAt) },
    axes: [
      ...(registration === null ? [] : [{ name: "scanner (RAS)", pose: IDENTITY, lengthMm: FRAME_MM }]),
      { name: "zFrame", pose: registration ?? IDENTITY, lengthMm: FRAME_MM },
      ...(current === null ? [] : [{ name: "treatment point", pose: current, lengthMm: TOOL_MM }]),
    ],
    probes,
    marks:
      registration === null
        ? []
        : [...markOf("entry", targeting.entry_point), ...markOf("target", targeting.target_point)],
    ellipsoid: ellipsoidOf(alignment?.error_budget ?? null),
    deviation:
      current === null || alignment === null ? null : [along(current, 0), along(alignment.desired, 0)],
    missing: [
      ...new Set(
        [view.current_body_problem, view.current_problem, view.alignment_problem].flatMap((problem) =>
          problem === null ? [] : [`${problem.code}: ${problem.text}`],
        ),
      ),
      ...(plan?.ghost_problem == null
        ? []
        : [`Ghost of proposal ${plan.id}: ${plan.ghost_problem.code}: ${plan.ghost_problem.text}`]),
    ],
  };
}

/** Where the robot is in the scanner; null while everything is in its own frame. */
function registrationOf(targeting: Targeting, { frame }: AlignmentView): readonly number[] | null {
  return frame === "scanner" && targeting.registration_state === "valid" ? targeting.registration : null;
}

function bodyOf(kind: Body["kind"], parts: readonly BodyPart[]): Body {
  return {
    kind,
    parts: parts.map(({ name, from, to }) => ({ name, from: pointAt(from), to: pointAt(to) })),
  };
}

function ellipsoidOf(budget: ErrorBudget | null): Ellipsoid | null {
  if (budget === null) return null;
  const { centre_mm, half_axes_mm, directions } = budget.treatment;
  return { centre: pointAt(centre_mm), halfAxesMm: pointAt(half_axes_mm), directions };
}

/** Its half axes. */
export function wordsOfEllipsoid({ halfAxesMm }: Ellipsoid): string {
  return `95 % ellipsoid with half axes of ${halfAxesMm.map((mm) => mm.toFixed(2)).join(", ")} mm`;
}

function pointAt([x = 0, y = 0, z = 0]: readonly number[]): Point {
  return [x, y, z];
}

/** The outer cells of the space that the robot reaches, where they are in the scanner. */
export interface Cells {
  readonly cellMm: number;
  readonly centres: readonly Point[];
}

/** They come in the zFrame; null where there are none. */
export function cellsOf(reach: Reach, targeting: Targeting, view: AlignmentView): Cells | null {
  if (reach.centres.length === 0) return null;
  const registration = registrationOf(targeting, view);
  return {
    cellMm: reach.cell_mm,
    centres: reach.centres.map((centre) => placed(registration ?? IDENTITY, pointAt(centre))),
  };
}

/** A point of the pose's frame. */
function placed(pose: readonly number[], [x, y, z]: Point): Point {
  const at = (row: number): number =>
    (pose[4 * row] ?? 0) * x +
    (pose[4 * row + 1] ?? 0) * y +
    (pose[4 * row + 2] ?? 0) * z +
    (pose[4 * row + 3] ?? 0);
  return [at(0), at(1), at(2)];
}

/** What cells say to whoever does not see them. */
export function wordsOfCells({ cellMm, centres }: Cells): string {
  const [x, y, z] = ([0, 1, 2] as const).map((axis) => {
    const { low, high } = endsOf(centres.map((centre) => centre[axis]));
    return `${(low - cellMm / 2).toFixed(0)} to ${(high + cellMm / 2).toFixed(0)}`;
  });
  return `workspace: x ${x}, y ${y}, z ${z}`;
}

/** Without a call of as many arguments as there are values. */
function endsOf(values: readonly number[]): { low: number; high: number } {
  return values.reduce(
    ({ low, high }, value) => ({ low: Math.min(low, value), high: Math.max(high, value) }),
    { low: Number.POSITIVE_INFINITY, high: Number.NEGATIVE_INFINITY },
  );
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
export function ballAround(scene: Scene, cells: Cells | null = null): Ball {
  const points: Point[] = [
    ...(cells?.centres ?? []),
    ...scene.bodies.flatMap(({ parts }) => parts.flatMap(({ from, to }) => [from, to])),
    ...(scene.ghost?.path ?? []),
    ...scene.axes.map(({ pose }) => along(pose, 0)),
    ...scene.probes.flatMap(({ cannula, tip }) => [cannula, tip]),
    ...scene.marks.map(({ at }) => at),
  ];
  const ends = ([0, 1, 2] as const).map((axis) => {
    return endsOf(points.map((point) => point[axis]));
  });
  const [x, y, z] = ends.map(({ low, high }) => (low + high) / 2);
  const centre: Point = [x ?? 0, y ?? 0, z ?? 0];
  const farthest = endsOf(points.map((point) => distance(point, centre))).high;
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
  const { ghost } = scene;
  const led =
    ghost === null
      ? []
      : [
          `ghost of proposal ${ghost.id}: tip to ${text(ghost.tip)} by a way of ${wayOf(ghost).toFixed(1)} mm`,
        ];
  const error = scene.ellipsoid === null ? [] : [wordsOfEllipsoid(scene.ellipsoid)];
  return [...probes, ...error, ...marks, ...led].join("; ") || "frames alone";
}

/** How far the tip goes. */
export function wayOf({ path }: Ghost): number {
  return path.reduce((way, point, index) => way + distance(point, path[index - 1] ?? point), 0);
}

/** Runs as they are read: which are shown, their largest errors in words, and what is drawn of them. Nothing here asks for anything. */
import type { ListedRun, Run, RunAxis, RunList, RunQuery, RunSamples } from "../../api/client";
import { decimals, formatCounts, shownPerCount, unitName } from "../../units/units";
import type { Span } from "../plots/ChartCanvas";
import type { Chart, Ink, Line, Sheet } from "../plots/charts";
import type { Column } from "../plots/rows";

/** As spec/openapi.yaml has them. */
export const bounds = { count: [20, 100_000], days: [1, 100_000] } as const;

/** What a list is narrowed to, as it is chosen; empty: everything. */
export interface Filter {
  readonly case: string;
  readonly outcome: string;
  readonly kind: string;
  readonly axis: string;
}

export const noFilter: Filter = { case: "", outcome: "", kind: "", axis: "" };

export const outcomes: readonly ListedRun["outcome"][] = [
  "running",
  "done",
  "refused",
  "aborted",
  "expired",
  "interrupted",
];

export const kinds: Readonly<Record<ListedRun["kind"], string>> = {
  move: "One axis",
  home: "Homing",
  path: "Several axes",
  sweep: "Frequency sweep",
  biopsy: "Biopsy",
  identify: "Measurement",
};

/** The filter that a text describes; none when it describes no filter. */
export function filterOf(text: string): Filter {
  return { ...noFilter, ...Object.fromEntries(new URLSearchParams(text)) };
}

/** What the app is asked for. */
export function queryOf(filter: Filter, before?: number): RunQuery {
  const { case: number, ...texts } = filter;
  const chosen = Object.entries(texts).filter(([, value]) => value !== "");
  return {
    ...Object.fromEntries(chosen),
    ...(number === "" ? {} : { case: Number(number) }),
    ...(before === undefined ? {} : { before }),
  };
}

/** The runs that are known, and whether there are older ones. */
export type Known = Pick<RunList, "runs" | "more">;

export const nothingKnown: Known = { runs: [], more: false };

/** What is known once the newest page was read again: what has gone from there is gone here, older pages stay. */
export function withNewest(known: Known, page: Known): Known {
  const oldest = page.runs.at(-1)?.id ?? 0;
  const older = page.more ? known.runs.filter(({ id }) => id < oldest) : [];
  return { runs: [...page.runs, ...older], more: older.length > 0 ? known.more : page.more };
}

/** What is known with the page that follows. */
export function withOlder(known: Known, page: Known): Known {
  return { runs: [...known.runs, ...page.runs], more: page.more };
}

function capital(word: string): string {
  return word.charAt(0).toUpperCase() + word.slice(1).replaceAll("_", " ");
}

/** What it did: `Lateral to -3.00 mm`, `Coordinated: Lateral, Head`. */
export function titleOf({ kind, mode, axes }: Pick<ListedRun, "kind" | "mode" | "axes">): string {
  const names = axes.map(({ title }) => title).join(", ");
  const [axis] = axes;
  if (kind === "home") return `Home ${names}`;
  if (kind !== "move") return `${capital(kind === "path" ? mode : kinds[kind])}: ${names}`;
  if (axis === undefined || axis.target_counts === null) return `Jog ${names}`;
  return `${axis.title} to ${formatCounts(axis, axis.target_counts)}`;
}

/** The largest following error of its axes, one for each unit: `0.12 mm, 0.3°`; null where no axis has one. */
export function largestError(axes: readonly RunAxis[]): string | null {
  const worst = new Map<string, RunAxis>();
  const sizeOf = (axis: RunAxis): number => Math.abs((axis.largest_error_counts ?? 0) * shownPerCount(axis));
  for (const axis of axes) {
    const known = worst.get(axis.unit);
    if (axis.largest_error_counts !== null && (known === undefined || sizeOf(known) < sizeOf(axis)))
      worst.set(axis.unit, axis);
  }
  const words = [...worst.values()].map((axis) => sizeWords(axis, axis.largest_error_counts));
  return words.length === 0 ? null : words.join(", ");
}

/** The size of a difference, whatever the sign of the axis' scale; a dash where nobody knows it. */
export function sizeWords(axis: RunAxis, counts: number | null): string {
  return counts === null ? "–" : formatCounts(axis, Math.abs(counts) * Math.sign(axis.counts_per_unit));
}

/** A position; a dash where nobody knows it. */
export function placeWords(axis: RunAxis, counts: number | null): string {
  return counts === null ? "–" : formatCounts(axis, counts);
}

/** By how much it came to rest beside its target; null where there is no such target or place. */
export function missCounts({ target_counts, end_counts }: RunAxis): number | null {
  return target_counts === null || end_counts === null ? null : end_counts - target_counts;
}

/** A run with its samples. */
export interface WholeRun {
  readonly run: Run;
  readonly samples: RunSamples;
}

/** What is drawn of a run. */
export interface Drawn {
  readonly run: Pick<Run, "id" | "axes">;
  readonly samples: RunSamples;
}

/**
 * A chart for each axis that is shown: where it was planned to be, or commanded where nothing was planned in time, and
 * where it was; and one of what lies between, where that is wanted.
 */
export function runSheet(
  run: Drawn,
  other: Drawn | null,
  hidden: ReadonlySet<string>,
  deviation: boolean,
): Sheet {
  const drawn = other === null ? [run] : [run, other];
  const timeS = [
    ...new Set(drawn.flatMap(({ samples: { times_s, plan } }) => [...times_s, ...plan.times_s])),
  ].sort((a, b) => a - b);
  const charts = run.run.axes
    .filter(({ axis }) => !hidden.has(axis))
    .flatMap((axis): Chart[] => {
      const chart = {
        title: axis.title,
        unit: unitName(axis),
        decimals: decimals(axis),
        leastSpan: 10 * Math.abs(shownPerCount(axis)),
      };
      const pairs = drawn.map((each) => linesOf(each, axis, timeS, each === other, other !== null));
      const positions = { ...chart, lines: pairs.flat() };
      if (!deviation) return [positions];
      return [positions, { ...chart, title: `${axis.title}: deviation`, lines: pairs.flatMap(between) }];
    });
  return { timeS, tick: [], charts };
}

/** What lies between the two lines of a run. */
function between([wish, actual]: readonly Line[]): Line[] {
  if (wish === undefined || actual === undefined) return [];
  const column = actual.least.map((value, row) => {
    const wanted = wish.least[row] ?? null;
    return value === null || wanted === null ? null : value - wanted;
  });
  return [{ label: `${actual.label} less ${wish.label}`, ink: actual.ink, least: column, greatest: column }];
}

/** The times that are shown of themselves: of a run that is over as long as it was followed, else all of its plan. */
export function wholeSpan(runs: readonly WholeRun[]): Span {
  const ends = runs.map(({ run, samples: { times_s, plan } }) =>
    Math.max(times_s.at(-1) ?? 0, run.outcome === "running" ? (plan.times_s.at(-1) ?? 0) : 0),
  );
  return { fromS: 0, toS: Math.max(...ends, 0.1) };
}

/** Lines of the axis of that name; none where the run did not move it. */
function linesOf(
  { run: { id, axes }, samples }: Drawn,
  { axis: name, unit }: RunAxis,
  timeS: readonly number[],
  second: boolean,
  named: boolean,
): Line[] {
  const axis = axes.find((each) => each.axis === name && each.unit === unit);
  const sampled = samples.axes.find(({ slot }) => slot === axis?.slot);
  if (axis === undefined || sampled === undefined) return [];
  const { basis, times_s: planned_s, axes: plans } = samples.plan;
  const planned = plans.find(({ slot }) => slot === axis.slot)?.positions_counts ?? [];
  const rest = planned.slice(-1);
  // Where the plan has ended the axis was to rest.
  const rests_s = rest.map(() => Math.max(samples.times_s.at(-1) ?? 0, planned_s.at(-1) ?? 0));
  const line = (label: string, ink: Ink, times: readonly number[], counts: Column): Line => {
    const column = valuesAt(times, counts, timeS).map((each) => each && each * shownPerCount(axis));
    return { label: named ? `${label} #${id}` : label, ink, least: column, greatest: column };
  };
  return [
    basis === "time"
      ? line("planned", second ? "other-wish" : "wish", [...planned_s, ...rests_s], [...planned, ...rest])
      : line("commanded", second ? "other-wish" : "wish", samples.times_s, sampled.commanded_counts),
    line("actual", second ? "other" : "measured", samples.times_s, sampled.actual_counts),
  ];
}

/** Values at rising times of their own, at those of a grid: straight between two that are known, null elsewhere. */
export function valuesAt(times: readonly number[], values: Column, grid: readonly number[]): Column {
  let next = 0;
  return grid.map((time) => {
    while (next < times.length && (times[next] ?? 0) < time) next += 1;
    const [t1, v1] = [times[next], values[next]];
    if (t1 === undefined || v1 === undefined || v1 === null) return null;
    if (t1 === time) return v1;
    const [t0, v0] = [times[next - 1], values[next - 1]];
    if (t0 === undefined || v0 === undefined || v0 === null) return null;
    return v0 + ((v1 - v0) * (time - t0)) / (t1 - t0);
  });
}

/** A whole number as it was typed, or what is wrong with it. */
export function wholeNumber(title: string, text: string, [least, most]: readonly [number, number]) {
  const typed = text.trim();
  const value = Number(typed);
  return /^\d+$/.test(typed) && value >= least && value <= most
    ? value
    : `${title}: “${typed}” does not fit; expected a whole number from ${least} to ${most}.`;
}

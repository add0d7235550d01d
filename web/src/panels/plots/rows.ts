/**
 * The history of all axes in the page, as the app decimated it: a row for the ticks of 33 ms, with the least and the
 * greatest value of every tick among them. Nothing here asks for anything or draws.
 */
import type { Extremes, HistoryRows } from "../../api/client";

/** As many as the app keeps: two minutes. */
export const MOST_ROWS = 3636;

export type Column = (number | null)[];

export interface Quantity {
  readonly least: Column;
  readonly greatest: Column;
}

export const axisQuantities = [
  "position_counts",
  "setpoint_counts",
  "error_counts",
  "velocity_counts_per_s",
  "drive",
] as const;
export type AxisQuantity = (typeof axisQuantities)[number];
export type AxisRows = Readonly<Record<AxisQuantity, Quantity>>;

export const forceQuantities = ["hand_n", "needle_n"] as const;
export type ForceQuantity = (typeof forceQuantities)[number];

/** Grows at its end; the columns are as long as `tick`. */
export interface Rows {
  readonly appBegunS: number;
  readonly periodUs: number;
  /** Of the kernel's ticks, which begin anew with each kernel. */
  readonly run: number;
  /** Number of the newest row; what to ask for next comes after it. */
  readonly newest: number;
  /** Last tick of each row. */
  readonly tick: number[];
  /** Ticks of each row that the app did not see; the black box has them. */
  readonly unseen: number[];
  readonly axes: ReadonlyMap<number, AxisRows>;
  /** Null for a robot without a needle. */
  readonly forces: Readonly<Record<ForceQuantity, Quantity>> | null;
}

/** Takes in an answer of the app; begins anew when it does not continue what is there. */
export function withAnswer(rows: Rows | null, answer: HistoryRows): Rows {
  let taken = continues(rows, answer) ? rows : begun(answer);
  for (let row = 0; row < answer.last_tick.length; row++) {
    const run = answer.run[row] ?? 0;
    if (run !== taken.run) taken = begun(answer, run);
    append(taken, answer, row);
  }
  forget(taken);
  return { ...taken, newest: answer.next };
}

function continues(rows: Rows | null, answer: HistoryRows): rows is Rows {
  return rows !== null && rows.appBegunS === answer.app_begun_s && rows.newest + 1 === answer.first;
}

function begun(answer: HistoryRows, run = answer.run[0] ?? 0): Rows {
  return {
    appBegunS: answer.app_begun_s,
    periodUs: answer.period_us,
    run,
    newest: 0,
    tick: [],
    unseen: [],
    axes: new Map(
      answer.axes.map(({ slot }) => [
        slot,
        Object.fromEntries(axisQuantities.map((name) => [name, empty()])) as Record<AxisQuantity, Quantity>,
      ]),
    ),
    forces: answer.forces === null ? null : { hand_n: empty(), needle_n: empty() },
  };
}

function empty(): Quantity {
  return { least: [], greatest: [] };
}

/** One row of the answer; ticks that nobody saw make a row of nothing before it, so that no line bridges them. */
function append(rows: Rows, answer: HistoryRows, row: number): void {
  const tick = answer.last_tick[row] ?? 0;
  const before = rows.tick.at(-1);
  if (before !== undefined && tick - before > 2 * answer.ticks_of_bucket) {
    rows.tick.push(before + 1);
    rows.unseen.push(tick - before - answer.ticks_of_bucket);
    for (const quantity of quantitiesOf(rows)) push(quantity, null, null);
  }
  rows.tick.push(tick);
  // The first row of a run begins in the middle of its 33 ms.
  rows.unseen.push(before === undefined ? 0 : answer.ticks_of_bucket - (answer.ticks[row] ?? 0));
  for (const axis of answer.axes) {
    const columns = rows.axes.get(axis.slot);
    if (columns === undefined) continue;
    for (const name of axisQuantities) copy(columns[name], axis[name], row);
  }
  if (rows.forces !== null && answer.forces !== null) {
    for (const name of forceQuantities) copy(rows.forces[name], answer.forces[name], row);
  }
}

function copy(to: Quantity, from: Extremes, row: number): void {
  push(to, from.least[row] ?? null, from.greatest[row] ?? null);
}

function push(to: Quantity, least: number | null, greatest: number | null): void {
  to.least.push(least);
  to.greatest.push(greatest);
}

function forget(rows: Rows): void {
  const beyond = rows.tick.length - MOST_ROWS;
  if (beyond <= 0) return;
  rows.tick.splice(0, beyond);
  rows.unseen.splice(0, beyond);
  for (const { least, greatest } of quantitiesOf(rows)) {
    least.splice(0, beyond);
    greatest.splice(0, beyond);
  }
}

function quantitiesOf(rows: Rows): Quantity[] {
  const ofAxes = [...rows.axes.values()].flatMap((axis) => Object.values(axis));
  return rows.forces === null ? ofAxes : [...ofAxes, ...Object.values(rows.forces)];
}

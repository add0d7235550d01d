/**
 * The largest following error of each axis since somebody reset it. No peak is missed while somebody looks: the app tells the
 * extremes of all ticks, and keeps two minutes of them. What nobody looked at for longer is told as not watched.
 */
import { create } from "zustand";
import type { HistoryRows } from "../api/client";

export interface ErrorMark {
  /** Setpoint less position that was largest either way; null as long as the axis followed nothing. */
  readonly largestCounts: number | null;
  /** Last tick of the 33 ms in which that was. */
  readonly atTick: number;
  /** From which tick on it was watched. */
  readonly sinceTick: number;
  /** Of the ticks since then: those that nobody watched. */
  readonly unwatchedTicks: number;
  /** In the newest 33 ms; null while the axis follows no setpoint. */
  readonly nowCounts: number | null;
}

export interface ErrorMarks {
  readonly appBegunS: number;
  readonly run: number;
  /** Number of the newest row that was looked at. */
  readonly newest: number;
  readonly tick: number;
  readonly bySlot: Readonly<Record<number, ErrorMark>>;
}

export const noMarks: ErrorMarks = { appBegunS: 0, run: 0, newest: 0, tick: 0, bySlot: {} };

export const useErrorMarks = create<ErrorMarks>(() => noMarks);

/** Looks at further rows; marks begin anew with another app or run of the kernel. */
export function withRows(marks: ErrorMarks, answer: HistoryRows): ErrorMarks {
  const goesOn = marks.appBegunS === answer.app_begun_s && marks.newest < answer.first;
  let seen: ErrorMarks = goesOn ? withGap(marks, answer) : { ...noMarks, appBegunS: answer.app_begun_s };
  answer.last_tick.forEach((tick, row) => {
    const run = answer.run[row] ?? 0;
    if (run !== seen.run) seen = { ...seen, run, bySlot: {} };
    const bySlot = Object.fromEntries(
      answer.axes.map(({ slot, error_counts }) => {
        const error = fartherOf(error_counts.least[row] ?? null, error_counts.greatest[row] ?? null);
        return [slot, marked(seen.bySlot[slot], error, tick)];
      }),
    );
    seen = { ...seen, tick, bySlot };
  });
  return { ...seen, newest: answer.next };
}

/** Notes how many ticks lie between what was looked at and the rows. */
function withGap(marks: ErrorMarks, answer: HistoryRows): ErrorMarks {
  const firstTick = (answer.last_tick[0] ?? 0) - (answer.ticks[0] ?? 0);
  const unwatched = firstTick - marks.tick;
  if (marks.newest + 1 === answer.first || unwatched <= 0) return marks;
  const bySlot = Object.fromEntries(
    Object.entries(marks.bySlot).map(([slot, mark]) => [
      slot,
      { ...mark, unwatchedTicks: mark.unwatchedTicks + unwatched },
    ]),
  );
  return { ...marks, bySlot };
}

function marked(mark: ErrorMark | undefined, error: number | null, tick: number): ErrorMark {
  const known = mark ?? { largestCounts: null, atTick: tick, sinceTick: tick, unwatchedTicks: 0 };
  const largest = known.largestCounts;
  const larger = error !== null && (largest === null || Math.abs(error) > Math.abs(largest));
  return {
    sinceTick: known.sinceTick,
    unwatchedTicks: known.unwatchedTicks,
    ...(larger
      ? { largestCounts: error, atTick: tick }
      : { largestCounts: known.largestCounts, atTick: known.atTick }),
    nowCounts: error,
  };
}

/** The one that is farther from zero. */
function fartherOf(least: number | null, greatest: number | null): number | null {
  if (least === null || greatest === null) return null;
  return Math.abs(least) > Math.abs(greatest) ? least : greatest;
}

/** Forgets what an axis had up to now. */
export function withReset(marks: ErrorMarks, slot: number): ErrorMarks {
  const mark = marks.bySlot[slot];
  if (mark === undefined) return marks;
  const { nowCounts } = mark;
  const { tick } = marks;
  const fresh = { largestCounts: null, atTick: tick, sinceTick: tick, unwatchedTicks: 0, nowCounts };
  return { ...marks, bySlot: { ...marks.bySlot, [slot]: fresh } };
}

/** The largest following error of each axis since somebody reset it. No peak is missed: the app tells the extremes of all ticks. */
import { create } from "zustand";
import type { HistoryRows } from "../api/client";

export interface ErrorMark {
  /** Setpoint less position that was largest either way; null as long as the axis followed nothing. */
  readonly largestCounts: number | null;
  /** Last tick of the 33 ms in which that was. */
  readonly atTick: number;
  /** From which tick on it was watched. */
  readonly sinceTick: number;
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

/** Looks at further rows; marks that they do not continue begin anew. */
export function withRows(marks: ErrorMarks, answer: HistoryRows): ErrorMarks {
  const continues = marks.appBegunS === answer.app_begun_s && marks.newest + 1 === answer.first;
  let seen: ErrorMarks = continues ? marks : { ...noMarks, appBegunS: answer.app_begun_s };
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

function marked(mark: ErrorMark | undefined, error: number | null, tick: number): ErrorMark {
  const known = mark ?? { largestCounts: null, atTick: tick, sinceTick: tick };
  const largest = known.largestCounts;
  const larger = error !== null && (largest === null || Math.abs(error) > Math.abs(largest));
  return {
    sinceTick: known.sinceTick,
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
  const fresh = { largestCounts: null, atTick: marks.tick, sinceTick: marks.tick, nowCounts: mark.nowCounts };
  return { ...marks, bySlot: { ...marks.bySlot, [slot]: fresh } };
}

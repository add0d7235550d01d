/** How long the phases of the kernel's tick took, from its histograms by powers of two. */
import type { Status } from "../../api/client";

export const phases = ["wake", "bus", "step", "publish"] as const;
export type PhaseName = (typeof phases)[number];

export const phaseMeaning: Readonly<Record<PhaseName, string>> = {
  wake: "from the deadline to running code; not measured by a simulated clock",
  bus: "bus transaction with the cards",
  step: "reading requests and the kernel's decision",
  publish: "snapshot and events for the app",
};

export interface PhaseFigures {
  readonly phase: PhaseName;
  readonly ticks: number;
  /** Upper ends of the buckets that hold these shares of the ticks, in µs; null without ticks. */
  readonly medianUs: number | null;
  readonly p999Us: number | null;
  readonly maxUs: number;
  /** Share of the period that the longest one took. */
  readonly ofPeriod: number;
}

export type Timing = Status["timing"];

const NS_PER_US = 1000;

export function figuresOf(timing: Timing, periodUs: number): PhaseFigures[] {
  return phases.map((phase) => {
    const { buckets, max_ns } = timing[phase];
    const maxUs = max_ns / NS_PER_US;
    return {
      phase,
      ticks: sum(buckets),
      medianUs: shareUs(buckets, 0.5),
      p999Us: shareUs(buckets, 0.999),
      maxUs,
      ofPeriod: maxUs / periodUs,
    };
  });
}

/** The phase whose longest time took most of the period; null before the first tick. */
export function blamed(figures: readonly PhaseFigures[]): PhaseFigures | null {
  const measured = figures.filter(({ ticks }) => ticks > 0);
  return measured.reduce<PhaseFigures | null>(
    (worst, each) => (worst === null || each.maxUs > worst.maxUs ? each : worst),
    null,
  );
}

/** Upper end of the bucket up to which that share of all counts lies: bucket n ends at 2^(n+1) ns. */
function shareUs(buckets: readonly number[], share: number): number | null {
  const wanted = share * sum(buckets);
  if (wanted === 0) return null;
  let counted = 0;
  const bucket = buckets.findIndex((count) => {
    counted += count;
    return counted >= wanted;
  });
  return bucketEndUs(bucket);
}

export function bucketEndUs(bucket: number): number {
  return 2 ** (bucket + 1) / NS_PER_US;
}

/** The buckets that any phase fills, from the first to the last; null when none does. */
export function filledRange(timing: Timing): { readonly first: number; readonly last: number } | null {
  const totals = timing.wake.buckets.map((_, bucket) =>
    phases.reduce((total, phase) => total + (timing[phase].buckets[bucket] ?? 0), 0),
  );
  const first = totals.findIndex((count) => count > 0);
  return first === -1 ? null : { first, last: totals.findLastIndex((count) => count > 0) };
}

/** A time for people, with as many digits as it bears. */
export function formatUs(us: number | null): string {
  if (us === null) return "–";
  if (us >= 1000) return `${(us / 1000).toFixed(1)} ms`;
  return `${us < 10 ? us.toFixed(1) : us.toFixed(0)} µs`;
}

function sum(counts: readonly number[]): number {
  return counts.reduce((total, count) => total + count, 0);
}

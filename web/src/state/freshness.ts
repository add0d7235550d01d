/** How far what the console shows can be trusted: data older than 250 ms are greyed, older than 1 s covered. */
import type { Phase } from "../stream/connection";

/** Ages at which data are greyed and covered. */
export interface Patience {
  readonly greyAfterMs: number;
  readonly coverAfterMs: number;
}

export const streamed: Patience = { greyAfterMs: 250, coverAfterMs: 1000 };
/** For what is asked for once a second: one answer may be late. */
export const polled: Patience = { greyAfterMs: 2500, coverAfterMs: 4000 };

export interface Freshness {
  readonly level: "live" | "grey" | "covered";
  /** Age of the data when the message was sent plus the time since it arrived; null before the first. */
  readonly ageMs: number | null;
  /** Why there is no live data; null while live. */
  readonly reason: "late" | "no-app" | "no-kernel" | "unreadable" | null;
}

export interface Evidence {
  readonly phase: Phase;
  readonly glance: { readonly connected: boolean; readonly ageMs: number } | null;
  readonly arrivedAtMs: number;
  /** What was wrong with the newest message; null when it was understood. */
  readonly frameError: string | null;
}

/** Judges the data at the time `nowMs`, on the same clock as `arrivedAtMs`. */
export function judgeFreshness(evidence: Evidence, nowMs: number, patience: Patience = streamed): Freshness {
  const { phase, glance, arrivedAtMs, frameError } = evidence;
  const ageMs = glance === null ? null : glance.ageMs + Math.max(0, nowMs - arrivedAtMs);
  if (frameError !== null) return { level: "covered", ageMs, reason: "unreadable" };
  if (glance === null || ageMs === null) return { level: "covered", ageMs, reason: "no-app" };
  if (!glance.connected) return { level: "covered", ageMs, reason: "no-kernel" };
  if (ageMs <= patience.greyAfterMs) return { level: "live", ageMs, reason: null };
  return {
    level: ageMs > patience.coverAfterMs ? "covered" : "grey",
    ageMs,
    reason: phase === "open" ? "late" : "no-app",
  };
}

/** How long until streamed data that do not change are judged anew; null when they cannot fall further. */
export function untilWorseMs({ level, ageMs }: Freshness): number | null {
  if (level === "covered" || ageMs === null) return null;
  const boundMs = level === "live" ? streamed.greyAfterMs : streamed.coverAfterMs;
  return Math.max(0, boundMs - ageMs);
}

/** An age for people: milliseconds up to a second, then seconds. */
export function formatAge(ageMs: number | null): string {
  if (ageMs === null) return "none";
  return ageMs < 1000 ? `${Math.round(ageMs)} ms` : `${(ageMs / 1000).toFixed(1)} s`;
}

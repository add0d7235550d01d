/** How far what the console shows can be trusted: data older than 250 ms are greyed, older than 1 s covered. */
import type { Phase } from "../stream/connection";
import type { Frame } from "../stream/decode";

export const GREY_AFTER_MS = 250;
export const COVER_AFTER_MS = 1000;

export interface Freshness {
  readonly level: "live" | "grey" | "covered";
  /** Age of the data when the message was sent plus the time since it arrived; null before the first. */
  readonly ageMs: number | null;
  /** Why there is no live data; null while live. */
  readonly reason: "late" | "no-app" | "no-kernel" | "unreadable" | null;
}

export interface Evidence {
  readonly phase: Phase;
  readonly frame: Frame | null;
  readonly arrivedAtMs: number;
  /** What was wrong with the newest message; null when it was understood. */
  readonly frameError: string | null;
}

/** Judges the data at the time `nowMs`, on the same clock as `arrivedAtMs`. */
export function judgeFreshness(evidence: Evidence, nowMs: number): Freshness {
  const { phase, frame, arrivedAtMs, frameError } = evidence;
  const ageMs = frame === null ? null : frame.ageMs + Math.max(0, nowMs - arrivedAtMs);
  if (frameError !== null) return { level: "covered", ageMs, reason: "unreadable" };
  if (frame === null || ageMs === null) return { level: "covered", ageMs, reason: "no-app" };
  if (!frame.connected) return { level: "covered", ageMs, reason: "no-kernel" };
  if (ageMs <= GREY_AFTER_MS) return { level: "live", ageMs, reason: null };
  return {
    level: ageMs > COVER_AFTER_MS ? "covered" : "grey",
    ageMs,
    reason: phase === "open" ? "late" : "no-app",
  };
}

/** An age for people: milliseconds up to a second, then seconds. */
export function formatAge(ageMs: number | null): string {
  if (ageMs === null) return "none";
  return ageMs < 1000 ? `${Math.round(ageMs)} ms` : `${(ageMs / 1000).toFixed(1)} s`;
}

/** What holds motion still from outside, in words: a breathing gate, a scan. */
import type { Holds } from "../api/client";
import type { ConsoleState } from "./store";

const MINUTE_S = 60;

const OF_GATE: Record<Holds["gate"]["state"], string> = {
  off: "off",
  open: "open",
  hold: "hold",
  no_signal: "no signal",
};

/** The gate while it is in use; null else. */
export function gateWords(holds: Holds | null): string | null {
  if (holds === null || !holds.gate.in_use) return null;
  const { state, source } = holds.gate;
  return `Breathing gate: ${OF_GATE[state]}${source === null ? "" : `, from ${source}`}.`;
}

/** Whose scan goes on and for how long; null while none does. */
export function scanWords({ holds, holdsAtMs, nowMs }: ConsoleState): string | null {
  if (holds === null || !holds.scan.active) return null;
  const seconds = Math.floor((holds.scan.age_s ?? 0) + Math.max(0, nowMs - holdsAtMs) / 1000);
  return `for ${duration(seconds)}, by ${holds.scan.source}. Nothing moves until it has ended.`;
}

function duration(seconds: number): string {
  const minutes = Math.floor(seconds / MINUTE_S);
  return minutes === 0 ? `${seconds} s` : `${minutes} min ${seconds % MINUTE_S} s`;
}

/** How figures of a connection are written. A figure that there is not is a dash. */

const UNKNOWN = "–";
const SECONDS_PER_MINUTE = 60;

/** Since a message came: tenths of a second at first, then seconds, then whole minutes. */
export function formatHeardAge(seconds: number): string {
  if (seconds < 10) return `${seconds.toFixed(1)} s`;
  if (seconds < SECONDS_PER_MINUTE) return `${Math.floor(seconds)} s`;
  return `${Math.floor(seconds / SECONDS_PER_MINUTE)} min`;
}

/** Messages a second, by the last two. */
export function formatRate(hertz: number | null): string {
  if (hertz === null) return UNKNOWN;
  return hertz < 10 ? `${hertz.toFixed(1)} Hz` : `${Math.round(hertz)} Hz`;
}

export function formatRoundTrip(milliseconds: number | null): string {
  return milliseconds === null ? UNKNOWN : `${milliseconds.toFixed(2)} ms`;
}

/** A number with its noun, in the plural unless it is one. */
export function countWord(count: number, noun: string): string {
  return `${count} ${noun}${count === 1 ? "" : "s"}`;
}

/** Counts in the operator's unit: degrees where the API says radians, millimetres as they are. */
import type { components } from "../generated/api";

export type Scale = Pick<components["schemas"]["Motor"], "unit" | "counts_per_unit">;

const DEGREES_PER_RADIAN = 180 / Math.PI;
const MOST_DECIMALS = 3;

/** The unit's short name as shown behind a number. */
export function unitName(scale: Scale): string {
  return scale.unit === "rad" ? "°" : "mm";
}

/** The unit in words, for assistive technology and messages. */
export function unitWord(scale: Scale): string {
  return scale.unit === "rad" ? "degrees" : "millimetres";
}

/** What one count is in the unit that is shown. */
export function shownPerCount(scale: Scale): number {
  return (scale.unit === "rad" ? DEGREES_PER_RADIAN : 1) / scale.counts_per_unit;
}

/** Decimals that tell neighbouring counts apart. */
export function decimals(scale: Scale): number {
  const needed = Math.ceil(-Math.log10(Math.abs(shownPerCount(scale))));
  return Math.min(MOST_DECIMALS, Math.max(0, needed));
}

/** The number alone, e.g. `-12.35`. */
export function formatNumber(scale: Scale, counts: number): string {
  const shown = (counts * shownPerCount(scale)).toFixed(decimals(scale));
  return Number(shown) === 0 ? shown.replace("-", "") : shown;
}

/** The number with its unit, never parted by a line break, e.g. `-12.35°` or `31.2 mm`. */
export function formatCounts(scale: Scale, counts: number): string {
  const separator = scale.unit === "rad" ? "" : "\u00a0";
  return `${formatNumber(scale, counts)}${separator}${unitName(scale)}`;
}

/** With its sign, e.g. `+31.2 mm`. */
export function formatDifference(scale: Scale, counts: number): string {
  const shown = formatCounts(scale, counts);
  return shown.startsWith("-") || Number(formatNumber(scale, counts)) === 0 ? shown : `+${shown}`;
}

/** From one position to another, and by how much, e.g. `12.35° → 0.00° (-12.35°)`. */
export function formatShift(scale: Scale, from: number, to: number): string {
  return `${formatCounts(scale, from)} → ${formatCounts(scale, to)} (${formatDifference(scale, to - from)})`;
}

export type ParsedEntry = { ok: true; value: number } | { ok: false; expected: string };

/** What an operator typed, as a value in the API's unit (mm or rad). Comma and point both work. */
export function parseEntry(scale: Scale, text: string): ParsedEntry {
  const plain = text
    .trim()
    .replace(/\s*(°|deg|mm)$/i, "")
    .replace("−", "-")
    .replace(",", ".");
  if (!/^[+-]?(\d+\.?\d*|\.\d+)$/.test(plain)) {
    return { ok: false, expected: `a number of ${unitWord(scale)}, such as 12.5` };
  }
  const shown = Number(plain);
  return { ok: true, value: scale.unit === "rad" ? shown / DEGREES_PER_RADIAN : shown };
}

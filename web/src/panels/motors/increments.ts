/** Increments by which an axis is jogged, in the unit that the operator sees. */
import type { Motor } from "../../api/client";
import { shownPerCount } from "../../units/units";

export const increments = [0.1, 0.5, 1, 5] as const;

/** The increment in counts, at least one. */
export function countsOf(motor: Motor, increment: number): number {
  return Math.max(1, Math.round(Math.abs(increment / shownPerCount(motor))));
}

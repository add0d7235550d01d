/** When a capture begins by itself: no peak can slip through, as each row has the extremes of all its ticks. */
import type { Motor } from "../../api/client";
import type { AxisFrame } from "../../stream/decode";
import { shownPerCount } from "../../units/units";
import type { AxisQuantity, Rows } from "./rows";

export type Edge = "above" | "below";

export type Trigger =
  | { readonly on: "fault" }
  | { readonly on: "level"; readonly quantity: AxisQuantity; readonly edge: Edge; readonly level: number };

/** How a quantity is asked for, in the operator's unit. */
export const triggerQuantities: readonly { readonly name: AxisQuantity; readonly title: string }[] = [
  { name: "error_counts", title: "Error" },
  { name: "position_counts", title: "Position" },
  { name: "velocity_counts_per_s", title: "Velocity" },
  { name: "drive", title: "Drive" },
];

/** What waits for a trigger. */
export interface Armed {
  readonly trigger: Trigger;
  /** Only ticks after it count. */
  readonly sinceTick: number;
  readonly seconds: number;
}

/** The tick at which an armed trigger fired; null as long as it has not. */
export function firedAt(armed: Armed, rows: Rows, motor: Motor, axis: AxisFrame | undefined): number | null {
  const { trigger, sinceTick } = armed;
  if (trigger.on === "fault") {
    const faulted = axis !== undefined && axis.fault !== "NONE" && axis.faultTick > sinceTick;
    return faulted ? axis.faultTick : null;
  }
  const quantity = rows.axes.get(motor.slot)?.[trigger.quantity];
  if (quantity === undefined) return null;
  const scale = trigger.quantity === "drive" ? 1 : shownPerCount(motor);
  const level = trigger.level / scale;
  // In counts the sense turns round where a count is negative.
  const above = (trigger.edge === "above") === scale > 0;
  const column = above ? quantity.greatest : quantity.least;
  const row = rows.tick.findIndex((tick, index) => {
    const value = column[index] ?? null;
    return tick > sinceTick && value !== null && (above ? value > level : value < level);
  });
  return rows.tick[row] ?? null;
}

/** The last tick of a capture that has as much after the trigger as before it. */
export function lastTickOf(armed: Armed, fired: number, periodUs: number): number {
  return fired + Math.round((armed.seconds * 1e6) / (2 * periodUs));
}

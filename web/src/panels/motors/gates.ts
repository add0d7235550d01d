/** The gates that a drive has to pass, in the kernel's order, and how they stand by the newest snapshot. */
import { type CatalogEntry, catalog, entry } from "../../generated/catalog";
import type { GateStand } from "../../kernel/pageKernel";
import type { AxisFrame, Frame } from "../../stream/decode";

/**
 * `blocks`: the first closed one, which the robot's kernel names. Behind it the kernel in the page tells: `closed` ones
 * block next, `follows` opens by itself once those before are open, `later` can only be judged then.
 */
export type Stand = "open" | "blocks" | "closed" | "follows" | "later";

export interface GateLine extends Pick<CatalogEntry, "name" | "meaning" | "cause" | "next_step"> {
  readonly stand: Stand;
}

/** `stands`: by number, of the kernel in the page; null when it tells nothing. */
export function gateLines(
  frame: Frame,
  axis: AxisFrame,
  stands: readonly GateStand[] | null,
): readonly GateLine[] {
  const gates = catalog.gate.filter((gate) => gate.name !== "OPEN");
  const blocking = gates.findIndex((gate) => gate.name === axis.gate);
  return gates.map((gate, index) => {
    const { name, meaning, cause, next_step } = gate;
    const open = axis.gate === "OPEN" || index < blocking;
    const stand = open ? "open" : index === blocking ? "blocks" : standBehind(stands?.[gate.number]);
    if (name === "LEASE" && stand === "closed" && axis.setpointCounts !== null) {
      const waiting = "The open proposal is sent as soon as the gates before are open.";
      return { name, meaning: waiting, cause, next_step: "", stand: "follows" };
    }
    return { name, meaning, cause, next_step: name === "MODE" ? modeStep(frame) : next_step, stand };
  });
}

function standBehind(stand: GateStand | undefined): Stand {
  return stand === undefined || stand === "unjudged" ? "later" : stand;
}

/** What leads to MOTION from here. */
export function modeStep(frame: Frame): string {
  if (frame.mode === "LOCKED") return entry("cause", frame.cause).next_step;
  if (frame.mode !== "READY") return entry("mode", frame.mode).next_step;
  if (frame.power === "coming_up") return "Wait until power is up, with the pedal released.";
  return frame.pedalArmed
    ? "The pedal is armed: press and hold the pedal."
    : "Release the pedal until it is armed, then press and hold the pedal.";
}

/** The gates that a drive has to pass, in the kernel's order, and how they stand by the newest snapshot. */
import { type CatalogEntry, type CodeName, catalog } from "../../generated/catalog";
import type { AxisFrame, Frame } from "../../stream/decode";

type GateName = CodeName<"gate">;

/**
 * `blocks`: the first closed one, which the kernel names. Behind it the kernel judges nothing: `closed` and `open`
 * are then what the snapshot shows, `later` what only the kernel can tell once the gates before are open.
 */
export type Stand = "open" | "blocks" | "closed" | "later";

export interface GateLine extends Pick<CatalogEntry, "name" | "meaning" | "cause" | "next_step"> {
  readonly stand: Stand;
}

export function gateLines(frame: Frame, axis: AxisFrame): readonly GateLine[] {
  const gates = catalog.gate.filter((gate) => gate.name !== "OPEN");
  const blocking = gates.findIndex((gate) => gate.name === axis.gate);
  return gates.map((gate, index) => {
    const { name, meaning, cause, next_step } = gate;
    return { name, meaning, cause, next_step, stand: standOf(name, index, blocking, frame, axis) };
  });
}

function standOf(name: GateName, index: number, blocking: number, frame: Frame, axis: AxisFrame): Stand {
  if (axis.gate === "OPEN" || index < blocking) return "open";
  if (index === blocking) return "blocks";
  const open = isOpenBySnapshot(name, frame, axis);
  if (open === null) return "later";
  return open ? "open" : "closed";
}

function isOpenBySnapshot(name: GateName, frame: Frame, axis: AxisFrame): boolean | null {
  switch (name) {
    case "MODE":
      return frame.mode === "MOTION";
    case "PEDAL":
      return frame.pedal === "PRESSED";
    case "ESTOP":
      return !frame.estop;
    case "CARD":
      return axis.cardValid;
    case "ENABLE":
      return axis.state !== "DISABLED" && axis.state !== "FAULTED";
    default:
      return null;
  }
}

/** Why an axis does what it does, in words. */
import type { Motor } from "../../api/client";
import { entry } from "../../generated/catalog";
import type { AxisFrame, Frame } from "../../stream/decode";
import { modeStep } from "./gates";

export interface DriveStory {
  readonly driven: boolean;
  /** Name of the gate that blocks; OPEN when driven. */
  readonly gate: string;
  readonly text: string;
  readonly nextStep: string;
}

/** The gate that keeps the axis from being driven, or how it is driven. */
export function explainDrive(frame: Frame, motor: Motor, axis: AxisFrame): DriveStory {
  const gate = entry("gate", axis.gate);
  if (axis.gate !== "OPEN") {
    const nextStep = axis.gate === "MODE" ? modeStep(frame) : gate.next_step;
    return { driven: false, gate: gate.name, text: gate.meaning, nextStep };
  }
  const share = Math.round((100 * axis.drive) / motor.max_drive);
  const sense = entry("direction", axis.direction).meaning.replace(/\.$/, "").toLowerCase();
  return { driven: true, gate: gate.name, text: `Driven ${sense}, ${share} % of full drive.`, nextStep: "" };
}

export interface FaultStory {
  readonly name: string;
  readonly meaning: string;
  readonly cause: string;
  readonly nextStep: string;
  /** Tick and measured value, for those who look closer. */
  readonly evidence: string;
}

/** Null unless the axis is FAULTED. */
export function explainFault(axis: AxisFrame): FaultStory | null {
  if (axis.state !== "FAULTED") return null;
  const fault = entry("fault", axis.fault);
  return {
    name: fault.name,
    meaning: fault.meaning,
    cause: fault.cause,
    nextStep: fault.next_step,
    evidence: `tick ${axis.faultTick}, value ${axis.faultValue}`,
  };
}

/** What an alignment asks of each axis, and what stands against it now. */
import type { Alignment, Motor } from "../../api/client";
import type { AxisFrame, Glance } from "../../stream/decode";

export interface AxisLine {
  readonly motor: Motor;
  /** The setpoint: within the axis' range. */
  readonly counts: number;
  /** The aim asks for more than the axis' range. */
  readonly clamped: boolean;
}

/** In the order of the motors. */
export function axisLines(alignment: Alignment, motors: readonly Motor[]): AxisLine[] {
  return motors.flatMap((motor) => {
    const setpoint = alignment.setpoints[motor.name];
    return setpoint === undefined
      ? []
      : [{ motor, counts: setpoint.counts, clamped: alignment.clamped.includes(motor.name) }];
  });
}

export interface Hindrance {
  readonly code: string;
  readonly text: string;
}

/** Why a proposal of these axes would be refused now, whatever the target. The app names the first. */
export function hindrances(
  lines: readonly AxisLine[],
  axisAt: (slot: number) => Pick<AxisFrame, "state" | "homed"> | undefined,
  mode: Glance["mode"] | undefined,
): Hindrance[] {
  const which = (is: (axis: Pick<AxisFrame, "state" | "homed">) => boolean): string =>
    lines
      .filter(({ motor }) => {
        const axis = axisAt(motor.slot);
        return axis !== undefined && is(axis);
      })
      .map(({ motor }) => motor.title)
      .join(", ");
  const faulted = which(({ state }) => state === "FAULTED");
  const homing = which(({ state }) => state === "HOMING");
  const disabled = which(({ state }) => state === "DISABLED");
  const unhomed = which(({ homed }) => !homed);
  return [
    ...(mode === "LOCKED" ? [{ code: "MODE", text: "the system is locked. Unlock it." }] : []),
    ...(faulted === "" ? [] : [{ code: "FAULTED", text: `${faulted}. Clear the fault.` }]),
    ...(homing === "" ? [] : [{ code: "BUSY", text: `homing: ${homing}. Wait, or abort it.` }]),
    ...(disabled === "" ? [] : [{ code: "DISABLED", text: `${disabled}. Enable.` }]),
    ...(unhomed === "" ? [] : [{ code: "NOT_HOMED", text: `${unhomed}. Home.` }]),
  ];
}

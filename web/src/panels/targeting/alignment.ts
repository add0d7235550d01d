/** What an alignment asks of each axis, and what stands against it now. */
import type { Alignment, Motor } from "../../api/client";
import { type CodeName, entry } from "../../generated/catalog";

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

/**
 * Why a proposal of these axes would be refused now. `verdicts`: the kernel's on a move of each to its setpoint, null when
 * it cannot be asked. That an axis has to be homed is a rule of the app.
 */
export function hindrances(
  lines: readonly AxisLine[],
  verdicts: readonly CodeName<"verdict">[] | null,
  isHomed: (slot: number) => boolean,
): Hindrance[] {
  const titlesOf = new Map<CodeName<"verdict">, string[]>();
  lines.forEach(({ motor }, index) => {
    const verdict = verdicts?.[index] ?? "ACCEPTED";
    if (verdict !== "ACCEPTED") titlesOf.set(verdict, [...(titlesOf.get(verdict) ?? []), motor.title]);
  });
  const refused = [...titlesOf].map(([code, titles]) => ({
    code,
    text: `${titles.join(", ")}. ${entry("verdict", code).next_step}`,
  }));
  const unhomed = lines.filter(({ motor }) => !isHomed(motor.slot)).map(({ motor }) => motor.title);
  return unhomed.length === 0
    ? refused
    : [...refused, { code: "NOT_HOMED", text: `${unhomed.join(", ")}. Home.` }];
}

import type { Motor } from "../../api/client";
import type { AxisFrame } from "../../stream/decode";

interface SwitchLampProps {
  readonly motor: Motor;
  readonly axis: AxisFrame;
  readonly side: "LOWER" | "UPPER";
}

/** The limit switch at its end of the track; an empty place at the end without one. */
export function SwitchLamp({ motor, axis, side }: SwitchLampProps) {
  if (motor.limit_side !== side) return <span className="switch-lamp absent" />;
  const triggered = axis.switchTriggered;
  const end = side === "LOWER" ? "lower" : "upper";
  return (
    <span
      className={`switch-lamp ${triggered ? "triggered" : "open"}`}
      role="img"
      aria-label={`${end} switch ${triggered ? "triggered" : "open"}`}
      title={`Limit switch at the ${end} end: ${triggered ? "triggered" : "open"}`}
    >
      <i />
      {triggered ? "at switch" : "switch"}
    </span>
  );
}

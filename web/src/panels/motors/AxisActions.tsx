import type { Motor } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { KernelButton } from "../../kernel/KernelButton";
import { useRefusal } from "../../kernel/useRefusal";
import { act, propose, setHome } from "../../state/commands";
import type { HomingPart } from "../../state/proposals";
import type { AxisFrame } from "../../stream/decode";

interface AxisActionsProps {
  readonly motor: Motor;
  readonly axis: AxisFrame;
  readonly homing: HomingPart | null;
  /** Set Home would shift an axis that is homed, or override its switch. */
  readonly onAskHome: () => void;
}

export function AxisActions({ motor, axis, homing, onAskHome }: AxisActionsProps) {
  const { slot, title, has_switch } = motor;
  const homeRefusal = useRefusal((kernel) => kernel.foresee(slot, { kind: "HOME" }).verdict);
  const disabled = axis.state === "DISABLED";
  const faulted = axis.state === "FAULTED";
  return (
    <div className="axis-actions">
      <KernelButton
        request="ENABLE"
        slot={slot}
        need="holder"
        label={`Enable ${title}`}
        off={disabled ? null : faulted ? "Clear the fault first." : "The axis is enabled."}
        onCommand={() => act(slot, "enable")}
      >
        Enable
      </KernelButton>
      <CommandButton
        need="holder"
        label={`Disable ${title}`}
        off={disabled || faulted ? "The axis is not enabled." : null}
        onCommand={() => act(slot, "disable")}
      >
        Disable
      </CommandButton>
      <CommandButton
        need="holder"
        label={`${homing === null ? "Go Home" : homingWords[homing]} ${title}`}
        className={homing === "homing" ? "homing" : ""}
        off={whyNotHome(motor, homing)}
        warning={homeRefusal}
        onCommand={() => propose({ kind: "home", slot })}
      >
        {homing === null ? "Go Home" : homingWords[homing]}
      </CommandButton>
      <KernelButton
        request="SET_HOME"
        slot={slot}
        need="holder"
        label={`Set Home ${title}`}
        onCommand={() => (has_switch || axis.homed ? onAskHome() : setHome(motor))}
      >
        Set Home
      </KernelButton>
    </div>
  );
}

const homingWords: Record<HomingPart, string> = { homing: "Homing..", waiting: "Waits" };

function whyNotHome(motor: Motor, homing: HomingPart | null): string | null {
  if (homing === "homing") return "It homes while the pedal is held.";
  if (homing === "waiting") return "It homes after the steps before.";
  return motor.has_switch ? null : "It has no switch: bring it to its home position and press Set Home.";
}

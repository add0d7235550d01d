import { useCallback, useState } from "react";
import type { Motor } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { Confirm } from "../../design/Confirm";
import { act, propose, setHomeAgainstSwitch } from "../../state/commands";
import type { HomingPart } from "../../state/proposals";
import type { AxisFrame } from "../../stream/decode";

interface AxisActionsProps {
  readonly motor: Motor;
  readonly axis: AxisFrame;
  readonly homing: HomingPart | null;
}

export function AxisActions({ motor, axis, homing }: AxisActionsProps) {
  const { slot, title } = motor;
  const disabled = axis.state === "DISABLED";
  const faulted = axis.state === "FAULTED";
  return (
    <div className="axis-actions">
      <CommandButton
        need="holder"
        label={`Enable ${title}`}
        off={disabled ? null : faulted ? "Clear the fault first." : "The axis is enabled."}
        onCommand={() => act(slot, "enable")}
      >
        Enable
      </CommandButton>
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
        onCommand={() => propose({ kind: "home", slot })}
      >
        {homing === null ? "Go Home" : homingWords[homing]}
      </CommandButton>
      <SetHome motor={motor} />
    </div>
  );
}

/** Where a switch tells where home is, the operator is asked before it is overridden. */
function SetHome({ motor }: { readonly motor: Motor }) {
  const { slot, title, has_switch } = motor;
  const [asked, setAsked] = useState(false);
  const close = useCallback(() => setAsked(false), []);
  const declare = (): Promise<void> => {
    close();
    return setHomeAgainstSwitch(slot);
  };
  return (
    <>
      <CommandButton
        need="holder"
        label={`Set Home ${title}`}
        onCommand={() => (has_switch ? setAsked(true) : act(slot, "set-home"))}
      >
        Set Home
      </CommandButton>
      {asked && (
        <Confirm
          title={`Override the switch of ${title}?`}
          action="Set Home all the same"
          onConfirm={declare}
          onCancel={close}
        >
          <p>
            Its limit switch tells where home is: Go Home asks it. If the axis does not stand at home now, its
            other end has no limit that holds. Do this only when the switch is broken and you know where the
            axis stands.
          </p>
        </Confirm>
      )}
    </>
  );
}

const homingWords: Record<HomingPart, string> = { homing: "Homing..", waiting: "Waits" };

function whyNotHome(motor: Motor, homing: HomingPart | null): string | null {
  if (homing === "homing") return "It homes while the pedal is held.";
  if (homing === "waiting") return "It homes after the steps before.";
  return motor.has_switch ? null : "It has no switch: bring it to its home position and press Set Home.";
}

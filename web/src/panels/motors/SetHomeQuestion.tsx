import type { Motor } from "../../api/client";
import { Confirm } from "../../design/Confirm";
import { setHome } from "../../state/commands";
import { DeclaredShift, WhatBecomesInvalid } from "../positions/DeclaredShift";

interface SetHomeQuestionProps {
  readonly motor: Motor;
  readonly onClose: () => void;
}

/** Asks before Set Home shifts an axis that is homed, or overrides its switch. */
export function SetHomeQuestion({ motor, onClose }: SetHomeQuestionProps) {
  const { title, has_switch } = motor;
  const declare = (): Promise<void> => {
    onClose();
    return setHome(motor);
  };
  return (
    <Confirm
      title={has_switch ? `Override the switch of ${title}?` : `Set Home of ${title} again?`}
      action={has_switch ? "Set Home all the same" : "Set Home"}
      onConfirm={declare}
      onCancel={onClose}
    >
      <p>
        <DeclaredShift motor={motor} to={0} />
      </p>
      {has_switch && (
        <p>
          Its limit switch says where home is: Go Home looks for it. If the axis does not stand at home now,
          its other limit does not hold, and until the next Go Home nothing compares the switch with the
          position. Do this only when the switch is broken and you know where the axis stands.
        </p>
      )}
      <WhatBecomesInvalid />
    </Confirm>
  );
}

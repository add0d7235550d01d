import type { Motor } from "../../api/client";
import { Confirm } from "../../design/Confirm";
import { setHomeAgainstSwitch } from "../../state/commands";

interface OverrideSwitchProps {
  readonly motor: Motor;
  readonly onClose: () => void;
}

/** Asks before Set Home declares something else than the axis' switch would tell. */
export function OverrideSwitch({ motor: { slot, title }, onClose }: OverrideSwitchProps) {
  const declare = (): Promise<void> => {
    onClose();
    return setHomeAgainstSwitch(slot);
  };
  return (
    <Confirm
      title={`Override the switch of ${title}?`}
      action="Set Home all the same"
      onConfirm={declare}
      onCancel={onClose}
    >
      <p>
        Its limit switch tells where home is: Go Home asks it. If the axis does not stand at home now, its
        other end has no limit that holds, and until the next Go Home nothing compares the switch with the
        position. Do this only when the switch is broken and you know where the axis stands.
      </p>
    </Confirm>
  );
}

import type { Motor } from "../../api/client";
import { useConsole } from "../../state/store";
import { formatShift } from "../../units/units";

interface DeclaredShiftProps {
  readonly motor: Motor;
  /** The position that it would be given, in counts. */
  readonly to: number;
}

/** How far an axis that is given another position would shift, without a motion. */
export function DeclaredShift({ motor, to }: DeclaredShiftProps) {
  const now = useConsole((state) => state.frame?.axes[motor.slot]?.positionCounts);
  return (
    <>
      {motor.title}: {now === undefined ? "position unknown" : formatShift(motor, now, to)}
    </>
  );
}

/** What becomes invalid by it, and how it is undone. */
export function WhatBecomesInvalid() {
  return (
    <p>
      Open moves of these axes end. A registration that rests on these axes expires. You can undo it for 60 s,
      as long as the axis does not move; after Undo the axis is not homed.
    </p>
  );
}

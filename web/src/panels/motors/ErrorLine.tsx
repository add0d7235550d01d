import type { Motor } from "../../api/client";
import { useErrorMarks, withReset } from "../../state/errorMarks";
import { formatCounts } from "../../units/units";

/** How far the axis is behind its setpoint, and the largest that it ever was since the mark was reset. */
export function ErrorLine({ motor }: { readonly motor: Motor }) {
  const mark = useErrorMarks((marks) => marks.bySlot[motor.slot]);
  if (mark === undefined || mark.largestCounts === null) return null;
  return (
    <p className="error-line">
      Following error{" "}
      <output aria-live="off" aria-label={`Following error of ${motor.title}`}>
        {mark.nowCounts === null ? "none now" : formatCounts(motor, mark.nowCounts)}
      </output>
      <span aria-hidden="true"> · ⌃ </span>largest{" "}
      <output
        aria-live="off"
        aria-label={`Largest following error of ${motor.title}`}
        title={`at tick ${mark.atTick}, watched since tick ${mark.sinceTick}`}
      >
        {formatCounts(motor, mark.largestCounts)}
      </output>
      {mark.unwatchedTicks > 0 && <span> · not watched for {mark.unwatchedTicks} ticks</span>}
      <button
        type="button"
        className="button small"
        aria-label={`Reset the largest following error of ${motor.title}`}
        onClick={() => useErrorMarks.setState((marks) => withReset(marks, motor.slot), true)}
      >
        Reset
      </button>
    </p>
  );
}

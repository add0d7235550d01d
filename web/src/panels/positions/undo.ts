/** What can be undone of the newest Set Home, Zero all or Load, in words. */
import type { DeclaredPositions, Motor } from "../../api/client";
import { formatShift } from "../../units/units";

type Axes = DeclaredPositions["axes"];

export interface UndoStory {
  readonly what: string;
  readonly shifts: readonly { readonly slot: number; readonly words: string; readonly moved: boolean }[];
  readonly invalid: string;
  /** Why there is nothing to undo any more; null when there is. */
  readonly off: string | null;
}

export function undoStory({ axes }: DeclaredPositions, motors: readonly Motor[]): UndoStory {
  return {
    what: axes[0]?.request === "SET_HOME" ? "Set Home" : "Load",
    shifts: axes.map((row) => ({
      slot: row.slot,
      words: shiftWords(row, motors),
      moved: !row.undoable,
    })),
    invalid: invalidWords(axes),
    off: axes.some(({ undoable }) => undoable)
      ? null
      : "Each axis moved since then, or was given another position.",
  };
}

function shiftWords({ slot, axis, before_counts, declared_counts }: Axes[number], motors: readonly Motor[]) {
  const motor = motors.find((each) => each.slot === slot);
  if (motor === undefined) return `${axis}: ${before_counts} → ${declared_counts} counts`;
  return `${motor.title}: ${formatShift(motor, before_counts, declared_counts)}`;
}

function invalidWords(axes: Axes): string {
  const expired = axes.some(({ carries_registration }) => carries_registration);
  return `Open moves of these axes ended${expired ? ", and a registration that rested on them expired" : ""}. ${
    expired ? "Undo does not make it valid again. " : ""
  }After Undo the axes are not homed.`;
}

import type { Motor, PositionsComparison, ProposalDraft } from "../../api/client";

/**
 * The axes worth setting: restoring one that stands there already would only cost its reference. An axis stands
 * where it was saved when it is within its deadband, as for the kernel; a reading may be a count off by noise.
 */
export function axesThatDiffer(
  axes: PositionsComparison["axes"],
  motors: readonly Pick<Motor, "slot" | "deadband_counts">[],
): ReadonlySet<string> {
  const deadbands = new Map(motors.map((motor) => [motor.slot, motor.deadband_counts ?? 0]));
  const worth = axes.filter((row) => {
    const distance = Math.abs(row.saved_counts - row.now_counts);
    return row.restorable && distance > (deadbands.get(row.slot) ?? 0);
  });
  return new Set(worth.map((row) => row.axis));
}

export type Motion =
  | { readonly off: null; readonly draft: ProposalDraft }
  /** Why it cannot be proposed. */
  | { readonly off: string };

/** The motion of the chosen axes to where they were saved; all arrive together. An axis that is not homed has no place to go to. */
export function motionTo(
  axes: readonly Pick<PositionsComparison["axes"][number], "axis" | "slot" | "saved_counts">[],
  chosen: ReadonlySet<string>,
  motors: readonly Pick<Motor, "slot" | "title" | "counts_per_unit">[],
  isHomed: (slot: number) => boolean,
): Motion {
  const going = axes.flatMap((row) => {
    const motor = motors.find(({ slot }) => slot === row.slot);
    return motor !== undefined && chosen.has(row.axis) ? [{ row, motor }] : [];
  });
  if (going.length === 0) return { off: "No axis is chosen." };
  const unhomed = going.filter(({ row }) => !isHomed(row.slot)).map(({ motor }) => motor.title);
  if (unhomed.length > 0) return { off: `Not homed: ${unhomed.join(", ")}. Home it, or do not choose it.` };
  const targets = going.map(({ row, motor }) => [row.axis, row.saved_counts / motor.counts_per_unit]);
  return { off: null, draft: { kind: "coordinated", targets: Object.fromEntries(targets) } };
}

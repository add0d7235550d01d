import type { Motor, PositionsComparison } from "../../api/client";

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

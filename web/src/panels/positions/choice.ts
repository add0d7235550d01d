import type { PositionsComparison } from "../../api/client";

/** The axes worth setting: restoring one that stands there already would only cost its reference. */
export function axesThatDiffer(axes: PositionsComparison["axes"]): ReadonlySet<string> {
  const worth = axes.filter((row) => row.restorable && row.saved_counts !== row.now_counts);
  return new Set(worth.map((row) => row.axis));
}

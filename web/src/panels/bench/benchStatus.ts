/** The part of the simulator's `status` answer (models/plant/README.md) that the bench shows. */

/** Slots of the jammed axes; none when the answer has another shape. */
export function jammedSlots(status: unknown): ReadonlySet<number> {
  const axes = hasAxes(status) ? status.axes : [];
  return new Set(axes.filter(isJammedAxis).map((axis) => axis.slot));
}

function hasAxes(status: unknown): status is { axes: unknown[] } {
  return typeof status === "object" && status !== null && "axes" in status && Array.isArray(status.axes);
}

function isJammedAxis(axis: unknown): axis is { slot: number } {
  if (typeof axis !== "object" || axis === null) return false;
  return "slot" in axis && typeof axis.slot === "number" && "jammed" in axis && axis.jammed === true;
}

import { expect, it } from "vitest";
import type { PositionsComparison } from "../../api/client";
import { axesThatDiffer } from "./choice";

const row = (slot: number, now_counts: number, saved_counts: number, restorable = true) =>
  ({
    axis: `axis ${slot}`,
    slot,
    now_counts,
    saved_counts,
    restorable,
  }) as PositionsComparison["axes"][number];

it("proposes to set the axes that differ and may be set", () => {
  const axes = [row(0, 0, 10), row(1, 5, 5), row(2, 0, 99999, false)];
  expect([...axesThatDiffer(axes, [])]).toEqual(["axis 0"]);
});

it("leaves an axis its reference that stands where it was saved but for noise within its deadband", () => {
  const axes = [row(0, -1, 0), row(1, 2, 0), row(2, -1, 0)];
  const motors = [
    { slot: 0, deadband_counts: 1 },
    { slot: 1, deadband_counts: 1 },
  ];
  expect([...axesThatDiffer(axes, motors)]).toEqual(["axis 1", "axis 2"]);
});

import { describe, expect, it } from "vitest";
import type { PositionsComparison } from "../../api/client";
import { axesThatDiffer, motionTo } from "./choice";

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

describe("the motion to saved positions", () => {
  const axes = [row(0, 0, 900), row(1, 5, -20), row(2, 0, 7)];
  const motors = [
    { slot: 0, title: "Yaw", counts_per_unit: 1800 / Math.PI },
    { slot: 1, title: "Insertion", counts_per_unit: -10 },
    { slot: 2, title: "Head", counts_per_unit: 10 },
  ];
  const to = (chosen: string[], unhomed: number[] = []) =>
    motionTo(axes, new Set(chosen), motors, (slot) => !unhomed.includes(slot));

  it("takes the chosen axes together, in their units", () => {
    expect(to(["axis 0", "axis 1"], [2])).toEqual({
      off: null,
      draft: { kind: "coordinated", targets: { "axis 0": Math.PI / 2, "axis 1": 2 } },
    });
  });

  it("is none without an axis", () => {
    expect(to([])).toEqual({ off: "No axis is chosen." });
  });

  it("is none of an axis that is not homed", () => {
    expect(to(["axis 0", "axis 1", "axis 2"], [0, 2])).toEqual({
      off: "Not homed: Yaw, Head. Home it, or do not choose it.",
    });
  });
});

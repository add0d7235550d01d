import { describe, expect, it } from "vitest";
import type { Motor } from "../../api/client";
import type { AxisFrame } from "../../stream/decode";
import { countsAt, fractionOf, isAllowed, previewAfterKey, stoppingRange, trackDomain } from "./geometry";

const motor = { soft_min_counts: -1000, soft_max_counts: 1000 } as Motor;
const axis = { positionCounts: 0, minCounts: -988, maxCounts: 988 } as AxisFrame;

describe("trackDomain", () => {
  it("shows the soft range and a margin", () => {
    expect(trackDomain(motor, axis)).toEqual({ min: -1120, max: 1120 });
  });

  it("widens in steps towards an axis that is outside", () => {
    expect(trackDomain(motor, { ...axis, positionCounts: 1121 })).toEqual({ min: -1120, max: 1620 });
    expect(trackDomain(motor, { ...axis, positionCounts: 1600 })).toEqual({ min: -1120, max: 1620 });
    expect(trackDomain(motor, { ...axis, positionCounts: -1700 })).toEqual({ min: -2120, max: 1120 });
  });
});

describe("places on the track", () => {
  const domain = { min: -100, max: 300 };

  it("map to counts and back for every count", () => {
    for (let counts = domain.min; counts <= domain.max; counts++) {
      expect(countsAt(domain, fractionOf(domain, counts))).toBe(counts);
    }
  });

  it("stay inside the track", () => {
    expect([fractionOf(domain, -500), fractionOf(domain, 500)]).toEqual([0, 1]);
    expect([countsAt(domain, -1), countsAt(domain, 2)]).toEqual([-100, 300]);
  });
});

describe("previewAfterKey", () => {
  it.each([
    ["ArrowRight", 120],
    ["ArrowUp", 120],
    ["ArrowLeft", 80],
    ["ArrowDown", 80],
    ["PageUp", 300],
    ["PageDown", -100],
    ["Home", -988],
    ["End", 988],
    ["Enter", null],
    ["a", null],
  ])("%s moves a preview at 100 to %s", (key, preview) => {
    expect(previewAfterKey(motor, axis, 100, key)).toBe(preview);
  });

  it("stays on the track", () => {
    expect(previewAfterKey(motor, axis, 1119, "PageUp")).toBe(1120);
    expect(previewAfterKey(motor, axis, -1119, "PageDown")).toBe(-1120);
  });

  it("moves at least one count on a short axis", () => {
    const short = { soft_min_counts: 0, soft_max_counts: 10 } as Motor;
    expect(previewAfterKey(short, axis, 5, "ArrowRight")).toBe(6);
  });
});

describe("isAllowed", () => {
  it("includes the ends of the range", () => {
    expect([-989, -988, 988, 989].map((counts) => isAllowed(axis, counts))).toEqual([
      false,
      true,
      true,
      false,
    ]);
  });
});

describe("stoppingRange", () => {
  const coasting = { ...motor, coast_counts: 12 } as Motor;
  const at = (direction: AxisFrame["direction"]) =>
    ({ ...axis, positionCounts: 100, direction }) as AxisFrame;

  it("lies ahead of an axis that is driven", () => {
    expect(stoppingRange(coasting, at("INCREASING"))).toEqual({ min: 100, max: 112 });
    expect(stoppingRange(coasting, at("DECREASING"))).toEqual({ min: 88, max: 100 });
  });

  it("is nothing without drive", () => {
    expect(stoppingRange(coasting, at("NONE"))).toBeNull();
  });
});

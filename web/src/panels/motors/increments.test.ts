import { describe, expect, it } from "vitest";
import type { Motor } from "../../api/client";
import { countsOf } from "./increments";

describe("countsOf", () => {
  it("counts millimetres, and degrees of an axis that turns", () => {
    expect(countsOf({ unit: "mm", counts_per_unit: 40 } as Motor, 0.5)).toBe(20);
    expect(countsOf({ unit: "rad", counts_per_unit: 1800 / Math.PI } as Motor, 5)).toBe(50);
  });

  it("is a count at least, so that every step moves", () => {
    expect(countsOf({ unit: "mm", counts_per_unit: 1 } as Motor, 0.1)).toBe(1);
  });
});

import { describe, expect, it } from "vitest";
import {
  decimals,
  formatCounts,
  formatDifference,
  formatNumber,
  formatShift,
  parseEntry,
  type Scale,
} from "./units";

const yaw: Scale = { unit: "rad", counts_per_unit: 1800 / Math.PI };
const insertion: Scale = { unit: "mm", counts_per_unit: 40 };

describe("formatting", () => {
  it("shows radians as degrees", () => {
    expect(formatCounts(yaw, 125)).toBe("12.5°");
  });

  it("shows as many decimals as tell counts apart, at most three", () => {
    expect(decimals(yaw)).toBe(1);
    expect(formatCounts(insertion, 1)).toBe("0.03\u00a0mm");
    expect(decimals({ unit: "mm", counts_per_unit: 1e9 })).toBe(3);
    expect(decimals({ unit: "mm", counts_per_unit: 0.01 })).toBe(0);
  });

  it("never shows a negative zero", () => {
    expect(formatNumber({ unit: "mm", counts_per_unit: 1e6 }, -1)).toBe("0.000");
  });
});

describe("a shift", () => {
  it("has a sign unless it rounds to zero, whichever way the counts go", () => {
    const turned: Scale = { unit: "mm", counts_per_unit: -10 };
    expect(formatDifference(turned, -50)).toBe("+5.0\u00a0mm");
    expect(formatDifference(turned, 50)).toBe("-5.0\u00a0mm");
    expect(formatDifference({ unit: "mm", counts_per_unit: 1e6 }, 1)).toBe("0.000\u00a0mm");
  });

  it("says from where, to where and by how much", () => {
    expect(formatShift(yaw, 125, 0)).toBe("12.5° → 0.0° (-12.5°)");
  });
});

describe("parseEntry", () => {
  it.each([
    ["12.5", 12.5],
    [" -3,25 mm ", -3.25],
    ["−4", -4],
    [".5", 0.5],
    ["+7.", 7],
  ])("reads %j", (text, value) => {
    expect(parseEntry(insertion, text)).toEqual({ ok: true, value });
  });

  it("turns degrees into radians", () => {
    expect(parseEntry(yaw, "180°")).toEqual({ ok: true, value: Math.PI });
  });

  it.each(["", "abc", "1e3", "1.2.3", "Infinity", "NaN", "--1", "0x10"])("refuses %j", (text) => {
    expect(parseEntry(yaw, text)).toEqual({ ok: false, expected: "a number of degrees, such as 12.5" });
  });
});

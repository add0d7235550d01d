import { describe, expect, it } from "vitest";
import { entry } from "../../generated/catalog";
import { isFound } from "./find";

describe("isFound", () => {
  const range = entry("verdict", "RANGE");

  it.each(["", "range", "RANGE setpoint", "  coasting ", "home full"])("finds RANGE by %j", (sought) => {
    expect(isFound(range, sought)).toBe(true);
  });

  it.each(["stall", "range stall"])("does not find RANGE by %j", (sought) => {
    expect(isFound(range, sought)).toBe(false);
  });
});

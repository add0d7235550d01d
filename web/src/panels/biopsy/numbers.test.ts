import { describe, expect, it } from "vitest";
import { numbersIn } from "./numbers";

describe("numbers that people type", () => {
  it("are parted by commas or blanks", () => {
    expect(numbersIn("25, 50")).toEqual([25, 50]);
    expect(numbersIn(" 3 -2.5\t70 ")).toEqual([3, -2.5, 70]);
  });

  it("may be none", () => {
    expect(numbersIn(" ")).toEqual([]);
  });

  it("are no numbers when one of them is none", () => {
    expect(numbersIn("25, deep")).toBeNull();
    expect(numbersIn("25, Infinity")).toBeNull();
  });
});

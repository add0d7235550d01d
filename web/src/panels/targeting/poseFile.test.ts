import { describe, expect, it } from "vitest";
import { MOST_CHARACTERS, readPose } from "./poseFile";

const pose = [0, -1, 0, 10.5, 1, 0, 0, -20, 0, 0, 1, 30, 0, 0, 0, 1];
const text = "# zFrame\n0 -1 0 10.5\n1 0 0 -20\n0 0 1 30 % mm\n0 0 0 1\n";
const problemOf = (words: string): string => {
  const read = readPose(words);
  return read.ok ? "" : read.problem;
};

describe("readPose", () => {
  it.each([
    ["rows as text with comments", text],
    ["commas", pose.join(", ")],
    ["semicolons between rows", "0,-1,0,10.5; 1,0,0,-20; 0,0,1,30; 0,0,0,1"],
    ["a list", JSON.stringify(pose)],
    ["a list of rows", "[[0,-1,0,10.5],[1,0,0,-20],[0,0,1,30],[0,0,0,1]]"],
    ["a registration as the interface tells it", JSON.stringify({ registration: pose })],
    ["exponents", pose.join(" ").replace("10.5", "1.05e1")],
  ])("reads %s", (_, words) => {
    expect(readPose(words)).toEqual({ ok: true, pose });
  });

  it("says how many numbers there are when they are not 16", () => {
    expect(problemOf("1 2 3")).toBe(
      "It has 3 numbers; expected 16 numbers, four rows of four, in the scanner's frame (RAS), mm.",
    );
    expect(problemOf("")).toContain("It has 0 numbers");
  });

  it("names the line of what is no number", () => {
    expect(problemOf("1 0 0 0\n0 1 zero 0")).toContain('Line 2: "zero" is no number');
    expect(problemOf("[1, null]")).toContain("Number 2: null is no number");
  });

  it("notices a matrix that is written column by column", () => {
    expect(problemOf("1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 1")).toContain("last row is 5 6 7 1 instead of 0 0 0 1");
  });

  it("refuses a transform that counts from the other side, whatever its numbers", () => {
    expect(problemOf(`#Insight Transform File V1.0\n${text}`)).toContain("LPS");
  });

  it.each([
    ["{", "is none"],
    ['{"pose": []}', '"registration"'],
    ["x".repeat(MOST_CHARACTERS + 1), "longer than 64 KiB"],
  ])("refuses %s", (words, problem) => {
    expect(problemOf(words)).toContain(problem);
  });
});

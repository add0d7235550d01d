import { describe, expect, it } from "vitest";
import type { LogLevel, LogLine } from "../api/client";
import { atLeast, levels, MOST_LINES, matching, mergeLines } from "./log";

const line = (sequence: number, level: LogLevel = "info"): LogLine => ({
  sequence,
  level,
  time: "2026-01-01T00:00:00Z",
  text: `line ${sequence}`,
  repeated: 0,
});

describe("mergeLines", () => {
  it("puts lines of the stream and of an answer in order, each once", () => {
    const merged = mergeLines([line(3), line(4)], [line(1), line(3), line(2)]);
    expect(merged.map(({ sequence }) => sequence)).toEqual([1, 2, 3, 4]);
  });

  it("keeps the newest lines when there are too many", () => {
    const many = Array.from({ length: MOST_LINES + 3 }, (_, index) => line(index));
    const merged = mergeLines(many, []);
    expect([merged.length, merged[0]?.sequence]).toEqual([MOST_LINES, 3]);
  });
});

describe("atLeast", () => {
  it.each(levels.map((level, index) => [level, levels.length - index] as const))(
    "%s lets %i levels through",
    (level, count) => {
      const lines = levels.map((each, index) => line(index, each));
      expect(atLeast(lines, level).length).toBe(count);
    },
  );
});

describe("matching", () => {
  const lines = [
    { ...line(1, "warning"), text: "Card 3 is silent" },
    { ...line(2), text: "Card 3 is back" },
    line(3, "error"),
  ];
  it.each([
    ["", [1, 2, 3]],
    ["  ", [1, 2, 3]],
    ["card 3", [1, 2]],
    ["SILENT card", [1]],
    ["warning", [1]],
    ["error", [3]],
    ["card 4", []],
  ] as const)("%j finds %j", (words, found) => {
    expect(matching(lines, words).map(({ sequence }) => sequence)).toEqual(found);
  });
});

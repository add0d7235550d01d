import { describe, expect, it } from "vitest";
import { blamed, bucketEndUs, figuresOf, filledRange, formatUs, type Timing } from "./loopTime";

const buckets = (counts: Record<number, number>): number[] =>
  Array.from({ length: 32 }, (_, bucket) => counts[bucket] ?? 0);

const timing: Timing = {
  wake: { max_ns: 0, buckets: buckets({}) },
  bus: { max_ns: 90_000, buckets: buckets({ 13: 998, 16: 2 }) },
  step: { max_ns: 1_200_000, buckets: buckets({ 10: 999, 20: 1 }) },
  publish: { max_ns: 3000, buckets: buckets({ 11: 1000 }) },
};

describe("figuresOf", () => {
  const [wake, bus, step] = figuresOf(timing, 1000);

  it("gives the upper end of the bucket that holds the share", () => {
    expect(bus?.medianUs).toBe(bucketEndUs(13));
    expect(bus?.p999Us).toBe(bucketEndUs(16));
    expect(step?.p999Us).toBe(bucketEndUs(10));
  });

  it("has no share of nothing", () => {
    expect(wake).toMatchObject({ ticks: 0, medianUs: null, p999Us: null });
  });

  it("relates the longest to the period", () => {
    expect(step?.ofPeriod).toBeCloseTo(1.2);
  });
});

describe("blamed", () => {
  it("is the phase that took longest", () => {
    expect(blamed(figuresOf(timing, 1000))?.phase).toBe("step");
  });

  it("is nobody before the first tick", () => {
    const idle = { max_ns: 0, buckets: buckets({}) };
    expect(blamed(figuresOf({ wake: idle, bus: idle, step: idle, publish: idle }, 1000))).toBeNull();
  });
});

describe("filledRange", () => {
  it("spans what any phase fills", () => {
    expect(filledRange(timing)).toEqual({ first: 10, last: 20 });
  });
});

describe("formatUs", () => {
  it.each([
    [null, "–"],
    [2.048, "2.0 µs"],
    [131.072, "131 µs"],
    [1200, "1.2 ms"],
  ])("shows %j as %j", (us, text) => {
    expect(formatUs(us)).toBe(text);
  });
});

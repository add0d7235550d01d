import { describe, expect, it } from "vitest";
import { type Evidence, formatAge, judgeFreshness, polled, untilWorseMs } from "./freshness";

const glance = { connected: true, ageMs: 40 };
const evidence: Evidence = { phase: "open", glance, arrivedAtMs: 1000, frameError: null };

describe("judgeFreshness", () => {
  it("adds the age at sending to the time since arrival", () => {
    expect(judgeFreshness(evidence, 1100)).toEqual({ level: "live", ageMs: 140, reason: null });
  });

  it.each([
    [1210, "live", null],
    [1211, "grey", "late"],
    [1960, "grey", "late"],
    [1961, "covered", "late"],
  ] as const)("at %i ms judges %s", (now, level, reason) => {
    expect(judgeFreshness(evidence, now)).toMatchObject({ level, reason });
  });

  it("covers before the first message", () => {
    expect(judgeFreshness({ ...evidence, glance: null }, 0)).toMatchObject({
      level: "covered",
      reason: "no-app",
    });
  });

  it("covers at once when the app has no kernel, however new the message", () => {
    const withoutKernel = { ...evidence, glance: { ...glance, connected: false } };
    expect(judgeFreshness(withoutKernel, 1000)).toMatchObject({ level: "covered", reason: "no-kernel" });
  });

  it("covers at once when a message cannot be read", () => {
    const unreadable = { ...evidence, frameError: "stream version 2, expected 1" };
    expect(judgeFreshness(unreadable, 1000)).toMatchObject({ level: "covered", reason: "unreadable" });
  });

  it("blames the connection for late data once it is lost", () => {
    expect(judgeFreshness({ ...evidence, phase: "lost" }, 1500)).toMatchObject({
      level: "grey",
      reason: "no-app",
    });
  });

  it.each([
    [2000, "live"],
    [3000, "grey"],
    [4000, "covered"],
  ])("is more patient with what is asked for once a second: at %i ms %s", (age, level) => {
    expect(judgeFreshness(evidence, evidence.arrivedAtMs + age, polled)).toMatchObject({ level });
  });

  it("does not grow younger when the clock steps back", () => {
    expect(judgeFreshness(evidence, 0).ageMs).toBe(40);
  });
});

describe("untilWorseMs", () => {
  it.each([
    [1000, 210],
    [1210, 0],
    [1211, 749],
    [1960, 0],
    [1961, null],
  ])("at %i ms waits %j ms for the next bound", (now, wait) => {
    expect(untilWorseMs(judgeFreshness(evidence, now))).toBe(wait);
  });
});

describe("formatAge", () => {
  it("speaks in milliseconds, then in seconds", () => {
    expect([formatAge(null), formatAge(12.4), formatAge(1000)]).toEqual(["none", "12 ms", "1.0 s"]);
  });
});

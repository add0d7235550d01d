import { describe, expect, it } from "vitest";
import { catalog } from "../generated/catalog";
import { alarmOfFreshness, alarmOfMode } from "./alarms";

describe("alarmOfMode", () => {
  it("has a priority for every cause of a lock but the start", () => {
    for (const { name } of catalog.cause) {
      const none = name === "NONE" || name === "BOOT";
      expect(alarmOfMode("LOCKED", name) === null, name).toBe(none);
    }
  });

  it("asks to act at once for the E-stop, damaged memory and an axis that runs away alone", () => {
    const high = catalog.cause.filter(({ name }) => alarmOfMode("LOCKED", name) === "high");
    expect(high.map(({ name }) => name)).toEqual(["ESTOP", "INTEGRITY", "RUNAWAY"]);
  });

  it("is silent once the lock is left, though the cause is still told", () => {
    expect(alarmOfMode("READY", "ESTOP")).toBeNull();
    expect(alarmOfMode("UNKNOWN", "ESTOP")).toBeNull();
  });
});

describe("alarmOfFreshness", () => {
  it("begins when the data are covered", () => {
    expect(alarmOfFreshness({ level: "grey", ageMs: 300, reason: "late" })).toBeNull();
    expect(alarmOfFreshness({ level: "covered", ageMs: 1500, reason: "late" })).toBe("medium");
  });
});

import { describe, expect, it } from "vitest";
import type { Alignment, Motor } from "../../api/client";
import { axisLines, hindrances } from "./alignment";

const motors = [
  { slot: 0, name: "yaw", title: "Yaw" },
  { slot: 2, name: "lateral", title: "Lateral" },
  { slot: 9, name: "spare", title: "Spare" },
] as Motor[];
const alignment = {
  setpoints: { lateral: { counts: -300, position: -6.4 }, yaw: { counts: 20, position: 0.01 } },
  clamped: ["lateral"],
} as unknown as Alignment;
const lines = axisLines(alignment, motors);

describe("axisLines", () => {
  it("are those of the axes with a role, in the order of the motors, with what is clamped", () => {
    expect(lines.map(({ motor, counts, clamped }) => [motor.title, counts, clamped])).toEqual([
      ["Yaw", 20, false],
      ["Lateral", -300, true],
    ]);
  });
});

describe("hindrances", () => {
  const ready = { state: "ENABLED", homed: true } as const;

  it("are none when every axis is enabled and homed", () => {
    expect(hindrances(lines, () => ready, "READY")).toEqual([]);
  });

  it("name the lock and the axes, of those that take part alone", () => {
    const states = [
      { state: "DISABLED", homed: true } as const,
      ready,
      { state: "FAULTED", homed: false } as const,
    ];
    const axisAt = (slot: number) => (slot === 0 ? states[0] : slot === 2 ? states[2] : undefined);
    expect(hindrances(lines, axisAt, "LOCKED").map(({ code, text }) => `${code}: ${text}`)).toEqual([
      "MODE: the system is locked. Unlock it.",
      "FAULTED: Lateral. Clear the fault.",
      "DISABLED: Yaw. Enable.",
      "NOT_HOMED: Lateral. Home.",
    ]);
  });
});

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
  it("are none when the kernel would accept every axis and all are homed", () => {
    expect(hindrances(lines, ["ACCEPTED", "ACCEPTED"], () => true)).toEqual([]);
  });

  it("name what the kernel would answer, with the axes and the next step, and who is not homed", () => {
    const found = hindrances(lines, ["DISABLED", "DISABLED"], (slot) => slot === 0);
    expect(found.map(({ code, text }) => `${code}: ${text}`)).toEqual([
      "DISABLED: Yaw, Lateral. Enable the axis.",
      "NOT_HOMED: Lateral. Home.",
    ]);
  });

  it("tell axes apart that the kernel would answer otherwise", () => {
    const found = hindrances(lines, ["RANGE", "FAULTED"], () => true);
    expect(found.map(({ code }) => code)).toEqual(["RANGE", "FAULTED"]);
  });

  it("say nothing in the name of a kernel that cannot be asked", () => {
    expect(hindrances(lines, null, () => true)).toEqual([]);
  });
});

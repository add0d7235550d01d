import { describe, expect, it } from "vitest";
import { catalog } from "../../generated/catalog";
import type { AxisFrame, Frame } from "../../stream/decode";
import { gateLines } from "./gates";

const frame = { mode: "READY", pedal: "RELEASED", estop: false } as Frame;
const axis = { state: "DISABLED", cardValid: true, gate: "MODE" } as AxisFrame;
const stands = (changed: Partial<Frame>, changedAxis: Partial<AxisFrame>): string[] =>
  gateLines({ ...frame, ...changed }, { ...axis, ...changedAxis }).map(
    ({ name, stand }) => `${name} ${stand}`,
  );

describe("gateLines", () => {
  it("marks the gate that the kernel names and shows what else the snapshot finds closed", () => {
    expect(stands({}, {}).slice(0, 7)).toEqual([
      "MODE blocks",
      "PEDAL closed",
      "ESTOP open",
      "CARD open",
      "ENABLE closed",
      "LEASE later",
      "SETPOINT later",
    ]);
  });

  it("takes every gate before the blocking one for open", () => {
    const motion = { mode: "MOTION", pedal: "PRESSED" } as Partial<Frame>;
    expect(stands(motion, { gate: "LEASE", state: "ENABLED" }).slice(0, 7)).toEqual([
      "MODE open",
      "PEDAL open",
      "ESTOP open",
      "CARD open",
      "ENABLE open",
      "LEASE blocks",
      "SETPOINT later",
    ]);
  });

  it("has every gate open when the axis is driven", () => {
    expect(gateLines(frame, { ...axis, gate: "OPEN" }).every(({ stand }) => stand === "open")).toBe(true);
  });

  it.each(catalog.gate.filter(({ name }) => name !== "OPEN"))("says the next step at $name", (gate) => {
    const line = gateLines(frame, { ...axis, gate: gate.name }).find(({ stand }) => stand === "blocks");
    expect(line).toMatchObject({ name: gate.name, next_step: gate.next_step });
  });
});

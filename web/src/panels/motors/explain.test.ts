import { describe, expect, it } from "vitest";
import type { Motor } from "../../api/client";
import { catalog, entry } from "../../generated/catalog";
import type { AxisFrame, Frame } from "../../stream/decode";
import { explainDrive, explainFault } from "./explain";

const frame = { mode: "LOCKED", cause: "BUS" } as Frame;
const motor = { max_drive: 1000 } as Motor;
const axis = { state: "ENABLED", fault: "NONE", gate: "LEASE", direction: "NONE", drive: 0 } as AxisFrame;

describe("explainDrive", () => {
  it.each(catalog.gate.filter((gate) => gate.name !== "OPEN"))(
    "names gate $name and its next step",
    (gate) => {
      expect(explainDrive(frame, motor, { ...axis, gate: gate.name })).toEqual({
        driven: false,
        gate: gate.name,
        text: gate.meaning,
        nextStep: gate.name === "MODE" ? entry("cause", "BUS").next_step : gate.next_step,
      });
    },
  );

  it("says where and how hard a driven axis is driven", () => {
    const driven = { ...axis, gate: "OPEN", direction: "DECREASING", drive: 100 } as AxisFrame;
    expect(explainDrive(frame, motor, driven).text).toBe(
      "Driven towards smaller positions, 10 % of full drive.",
    );
  });
});

describe("explainFault", () => {
  it("is silent about a sound axis, even when an old fault code is left", () => {
    expect(explainFault({ ...axis, fault: "STALL" })).toBeNull();
  });

  it.each(catalog.fault)("explains $name with cause and next step", (fault) => {
    const faulted = {
      ...axis,
      state: "FAULTED",
      fault: fault.name,
      faultTick: 7,
      faultValue: -3,
    } as AxisFrame;
    expect(explainFault(faulted)).toEqual({
      name: fault.name,
      meaning: fault.meaning,
      cause: fault.cause,
      nextStep: fault.next_step,
      evidence: "tick 7, value -3",
    });
  });
});

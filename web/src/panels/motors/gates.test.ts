import { describe, expect, it } from "vitest";
import { catalog } from "../../generated/catalog";
import type { GateStand } from "../../kernel/pageKernel";
import type { AxisFrame, Frame } from "../../stream/decode";
import { gateLines } from "./gates";

const frame = { mode: "READY", cause: "NONE", pedalArmed: true, power: "on" } as Frame;
const axis = { gate: "MODE", setpointCounts: null } as AxisFrame;
/** As the kernel in the page gives them: by number, `closed` ones named, up to the last one judged. */
const walked = (closed: readonly string[], last = "DRIVE"): GateStand[] =>
  catalog.gate.map(({ name, number }) =>
    number > (catalog.gate.find((gate) => gate.name === last)?.number ?? 0)
      ? "unjudged"
      : closed.includes(name)
        ? "closed"
        : "open",
  );
const stands = (lines: ReturnType<typeof gateLines>): string[] =>
  lines.map(({ name, stand }) => `${name} ${stand}`);

describe("gateLines", () => {
  it("marks the gate that the robot's kernel names, and behind it what the kernel in the page finds", () => {
    const lines = gateLines(frame, axis, walked(["MODE", "PEDAL", "ENABLE", "LEASE"], "LEASE"));
    expect(stands(lines).slice(0, 7)).toEqual([
      "MODE blocks",
      "PEDAL closed",
      "ESTOP open",
      "CARD open",
      "ENABLE closed",
      "LEASE closed",
      "SETPOINT later",
    ]);
  });

  it("guesses nothing behind the blocking gate without a kernel in the page", () => {
    const lines = gateLines(frame, { ...axis, gate: "CARD" }, null);
    expect(stands(lines).slice(0, 5)).toEqual([
      "MODE open",
      "PEDAL open",
      "ESTOP open",
      "CARD blocks",
      "ENABLE later",
    ]);
  });

  it("says of an open proposal that it follows, not that one has to be made", () => {
    const waiting = { ...axis, setpointCounts: 100 };
    const lease = gateLines(frame, waiting, walked(["MODE", "PEDAL", "LEASE"]))[5];
    expect(lease).toMatchObject({ name: "LEASE", stand: "follows", next_step: "" });
  });

  it("has every gate open when the axis is driven", () => {
    const lines = gateLines(frame, { ...axis, gate: "OPEN" }, walked([]));
    expect(lines.every(({ stand }) => stand === "open")).toBe(true);
  });

  it.each([
    [{ mode: "READY", pedalArmed: true, power: "coming_up" }, "Wait until power is up"],
    [{ mode: "READY", pedalArmed: true }, "press and hold the pedal"],
    [{ mode: "READY", pedalArmed: false }, "Release the pedal until it is armed"],
    [{ mode: "LOCKED", cause: "ESTOP" }, "release the E-stop"],
    [{ mode: "LOCKED", cause: "BUS" }, "cable of the card rack"],
    [{ mode: "INIT" }, "Correct the robot file"],
  ])("leads to MOTION from %j", (shown, step) => {
    const [mode] = gateLines({ ...frame, ...shown } as Frame, axis, null);
    expect(mode?.next_step).toContain(step);
  });

  it.each(catalog.gate.filter(({ name }) => name !== "OPEN" && name !== "MODE"))(
    "says the next step at $name",
    (gate) => {
      const line = gateLines(frame, { ...axis, gate: gate.name }, null).find(
        ({ stand }) => stand === "blocks",
      );
      expect(line).toMatchObject({ name: gate.name, next_step: gate.next_step });
    },
  );
});

import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { decodeFrame, FrameError, headerFields, STATE_WORDS, signedSlotFields, slotFields } from "./decode";

type Words = Record<string, number>;

const soundHeader: Words = { magic: 0x53574b49, version: 3, connected: 1, slots: 10 };

function message(
  header: Words = {},
  slots: Record<number, Words> = {},
  state: readonly number[] = [],
): ArrayBuffer {
  const values = { ...soundHeader, ...header };
  const words = headerFields.map((name) => values[name] ?? 0);
  for (let slot = 0; slot < 10; slot++) words.push(...slotFields.map((name) => slots[slot]?.[name] ?? 0));
  words.push(...Array.from({ length: STATE_WORDS }, (_, index) => state[index] ?? 0));
  const view = new DataView(new ArrayBuffer(words.length * 4));
  words.forEach((word, index) => {
    view.setUint32(index * 4, word >>> 0, true);
  });
  return view.buffer;
}

function contract(): string {
  const yaml = readFileSync(new URL("../../../spec/openapi.yaml", import.meta.url), "utf8");
  return yaml.slice(yaml.indexOf("x-stream:\n"));
}

function contractFields(block: "header" | "slot"): { name: string; signed: boolean }[] {
  const stream = contract();
  const section = stream.slice(stream.indexOf(`    ${block}:`));
  const lines = section.split("\n").slice(1);
  const end = lines.findIndex((line) => !line.startsWith("      - "));
  return lines.slice(0, end).map((line) => ({
    name: /name: (\w+)/.exec(line)?.[1] ?? line,
    signed: line.includes("signed: true"),
  }));
}

describe("the field tables", () => {
  it("are those of spec/openapi.yaml, in its order", () => {
    expect(headerFields).toEqual(contractFields("header").map((field) => field.name));
    expect(slotFields).toEqual(contractFields("slot").map((field) => field.name));
  });

  it("leave room for the state that spec/openapi.yaml names", () => {
    expect(contract()).toContain(`state_words: ${STATE_WORDS}\n`);
  });

  it("agree with spec/openapi.yaml about signs", () => {
    const signed = contractFields("slot").filter((field) => field.signed);
    expect([...signedSlotFields]).toEqual(signed.map((field) => field.name));
    expect(contractFields("header").some((field) => field.signed)).toBe(false);
  });
});

describe("decodeFrame", () => {
  it("names modes, causes, pedal and lamps by the catalog", () => {
    const frame = decodeFrame(
      message({ mode: 1, cause: 2, causes_seen: 0b1100, pedal: 2, lamps: 0x03_02_01_00, estop: 1 }),
    );
    expect(frame.mode).toBe("LOCKED");
    expect(frame.cause).toBe("ESTOP");
    expect(frame.causesSeen).toEqual(["ESTOP", "BUS"]);
    expect(frame.pedal).toBe("DISAGREE");
    expect(frame.lamps).toEqual(["OFF", "GREEN", "RED", "AMBER"]);
    expect(frame.estop).toBe(true);
  });

  it("reads flags, age and configuration CRC", () => {
    const frame = decodeFrame(message({ flags: 0b1101, age_us: 2500, config_crc: 0xabc }));
    expect(frame).toMatchObject({
      simulated: true,
      degraded: false,
      simulatedClock: true,
      replay: true,
      ageMs: 2.5,
    });
    expect(frame.configCrc).toBe("00000abc");
  });

  it.each([
    [0b000000, "off"],
    [0b010000, "coming_up"],
    [0b110000, "on"],
  ])("reads from flags %i that power is %s", (flags, power) => {
    expect(decodeFrame(message({ flags })).power).toBe(power);
  });

  it("tells a home by hand from one at the switch, and how far that lies from the one before", () => {
    const { axes } = decodeFrame(
      message({}, { 2: { flags: 0b000001, home_difference_counts: -3 }, 4: { flags: 0b100001 } }),
    );
    expect(axes[2]).toMatchObject({ homed: true, homedByHand: false, homeDifferenceCounts: -3 });
    expect(axes[4]).toMatchObject({ homed: true, homedByHand: true, homeDifferenceCounts: 0 });
  });

  it("reads signed counts and shows a setpoint only with an open proposal", () => {
    const slot = { position_counts: -12, setpoint_counts: 34, min_counts: -2147483648, max_counts: 7 };
    const frame = decodeFrame(
      message({}, { 0: { ...slot, flags: 0b10001 }, 9: { ...slot, flags: 0b00110 } }),
    );
    expect(frame.axes[0]).toMatchObject({ positionCounts: -12, setpointCounts: 34, minCounts: -2147483648 });
    expect(frame.axes[0]).toMatchObject({ homed: true, switchTriggered: false });
    expect(frame.axes[9]).toMatchObject({ setpointCounts: null, homed: false, switchTriggered: true });
    expect(frame.axes[9]?.cardValid).toBe(true);
  });

  it("hands the kernel's state on byte for byte", () => {
    const { state } = decodeFrame(message({}, {}, [0x04030201]));
    expect(state.length).toBe(4 * STATE_WORDS);
    expect([...state.subarray(0, 5)]).toEqual([1, 2, 3, 4, 0]);
  });

  it("keeps tick and counters unsigned", () => {
    expect(decodeFrame(message({ tick: 0xffffffff })).tick).toBe(4294967295);
  });

  it("treats any E-stop word but zero as pulled", () => {
    expect(decodeFrame(message({ estop: 0x80000000 })).estop).toBe(true);
  });

  it("names a code that the catalog does not have", () => {
    expect(decodeFrame(message({ mode: 77 })).mode).toBe("UNKNOWN_77");
  });

  it.each([
    ["too short", message().slice(4)],
    ["empty", new ArrayBuffer(0)],
    ["of another magic", message({ magic: 1 })],
    ["of another version", message({ version: 2 })],
    ["of another slot count", message({ slots: 9 })],
  ])("refuses a message that is %s", (_, bytes) => {
    expect(() => decodeFrame(bytes)).toThrow(FrameError);
  });
});

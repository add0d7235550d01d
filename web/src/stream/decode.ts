/**
 * The stream's binary message, as `components/x-stream` of spec/openapi.yaml lays it down:
 * little-endian 32-bit words, a header, one block for each slot, and the kernel's whole state.
 */
import { type CodeName, entry, type Family } from "../generated/catalog";

const MAGIC = 0x53574b49;
const VERSION = 3;
const SLOTS = 10;
export const STATE_WORDS = 592;

export const headerFields = [
  "magic",
  "version",
  "connected",
  "tick",
  "mode",
  "cause",
  "cause_tick",
  "cause_value",
  "causes_seen",
  "pedal",
  "pedal_armed",
  "estop",
  "app_alive",
  "holder",
  "overruns",
  "age_us",
  "flags",
  "config_crc",
  "lamps",
  "slots",
] as const;

export const slotFields = [
  "state",
  "fault",
  "fault_tick",
  "fault_value",
  "flags",
  "gate",
  "position_counts",
  "setpoint_counts",
  "direction",
  "drive",
  "lease_ticks",
  "checksum_failures",
  "heartbeat",
  "min_counts",
  "max_counts",
  "home_difference_counts",
] as const;

export const signedSlotFields: ReadonlySet<string> = new Set([
  "fault_value",
  "position_counts",
  "setpoint_counts",
  "min_counts",
  "max_counts",
  "home_difference_counts",
]);

/** A name of the catalog, or one that says that this console does not know the number. */
export type Code<F extends Family> = CodeName<F> | `UNKNOWN_${number}`;

export interface AxisFrame {
  readonly state: Code<"axis_state">;
  readonly fault: Code<"fault">;
  readonly faultTick: number;
  readonly faultValue: number;
  readonly homed: boolean;
  /** By Set Home, a person's word, and not at its switch. */
  readonly homedByHand: boolean;
  readonly switchTriggered: boolean;
  readonly cardValid: boolean;
  readonly cardSeen: boolean;
  readonly gate: Code<"gate">;
  readonly positionCounts: number;
  /** Of the open proposal; null without one. */
  readonly setpointCounts: number | null;
  readonly direction: Code<"direction">;
  readonly drive: number;
  readonly leaseTicks: number;
  readonly checksumFailures: number;
  readonly heartbeat: number;
  /** Range that the kernel allows for a setpoint now. */
  readonly minCounts: number;
  readonly maxCounts: number;
  /** Of the last two homes at the switch; 0 before the second. */
  readonly homeDifferenceCounts: number;
}

/** Of the amplifiers: `coming_up` while it is on and they do not obey yet. */
export type Power = "off" | "coming_up" | "on";

/** What the header shows of the system, with or without login. */
export interface Glance {
  readonly connected: boolean;
  readonly mode: Code<"mode">;
  readonly cause: Code<"cause">;
  readonly causeTick: number;
  readonly causeValue: number;
  readonly causesSeen: readonly Code<"cause">[];
  readonly pedal: Code<"pedal">;
  readonly pedalArmed: boolean;
  readonly power: Power;
  readonly estop: boolean;
  readonly appAlive: boolean;
  /** Age of the data when the message was sent. */
  readonly ageMs: number;
  readonly simulated: boolean;
  readonly degraded: boolean;
  readonly simulatedClock: boolean;
  /** A recording plays: nothing moves, and nothing can be asked of the robot. */
  readonly replay: boolean;
}

export interface Frame extends Glance {
  readonly tick: number;
  readonly holder: number;
  readonly overruns: number;
  readonly configCrc: string;
  /** By lamp number. */
  readonly lamps: readonly Code<"colour">[];
  /** By slot. */
  readonly axes: readonly AxisFrame[];
  /** `ilk_state_t`, for the kernel in the page. */
  readonly state: Uint8Array;
}

/** The message is not one that this console understands; the text says what differs. */
export class FrameError extends Error {}

const WORD = 4;
const STATE_OFFSET = (headerFields.length + SLOTS * slotFields.length) * WORD;
const MESSAGE_BYTES = STATE_OFFSET + STATE_WORDS * WORD;

/** @throws FrameError when length, magic, version or slot count is not that of version 3. */
export function decodeFrame(message: ArrayBuffer): Frame {
  if (message.byteLength !== MESSAGE_BYTES) {
    throw new FrameError(`stream message of ${message.byteLength} bytes, expected ${MESSAGE_BYTES}`);
  }
  const view = new DataView(message);
  const header = readWords(view, 0, headerFields);
  if (header.magic !== MAGIC)
    throw new FrameError(`stream message starts with 0x${header.magic.toString(16)}`);
  if (header.version !== VERSION)
    throw new FrameError(`stream version ${header.version}, expected ${VERSION}`);
  if (header.slots !== SLOTS) throw new FrameError(`stream of ${header.slots} slots, expected ${SLOTS}`);

  return {
    connected: header.connected === 1,
    tick: header.tick,
    mode: nameOf("mode", header.mode),
    cause: nameOf("cause", header.cause),
    causeTick: header.cause_tick,
    causeValue: header.cause_value,
    causesSeen: bits(header.causes_seen).map((number) => nameOf("cause", number)),
    pedal: nameOf("pedal", header.pedal),
    pedalArmed: header.pedal_armed === 1,
    power: hasBit(header.flags, 5) ? "on" : hasBit(header.flags, 4) ? "coming_up" : "off",
    // Anything but a clear "no" counts as pulled: a damaged word must not look safe.
    estop: header.estop !== 0,
    appAlive: header.app_alive === 1,
    holder: header.holder,
    overruns: header.overruns,
    ageMs: header.age_us / 1000,
    simulated: hasBit(header.flags, 0),
    degraded: hasBit(header.flags, 1),
    simulatedClock: hasBit(header.flags, 2),
    replay: hasBit(header.flags, 3),
    configCrc: header.config_crc.toString(16).padStart(8, "0"),
    lamps: [0, 8, 16, 24].map((shift) => nameOf("colour", (header.lamps >>> shift) & 0xff)),
    axes: Array.from({ length: SLOTS }, (_, slot) => decodeAxis(view, slot)),
    state: new Uint8Array(message, STATE_OFFSET),
  };
}

function decodeAxis(view: DataView, slot: number): AxisFrame {
  const offset = (headerFields.length + slot * slotFields.length) * WORD;
  const words = readWords(view, offset, slotFields, signedSlotFields);
  return {
    state: nameOf("axis_state", words.state),
    fault: nameOf("fault", words.fault),
    faultTick: words.fault_tick,
    faultValue: words.fault_value,
    homed: hasBit(words.flags, 0),
    homedByHand: hasBit(words.flags, 5),
    switchTriggered: hasBit(words.flags, 1),
    cardValid: hasBit(words.flags, 2),
    cardSeen: hasBit(words.flags, 3),
    gate: nameOf("gate", words.gate),
    positionCounts: words.position_counts,
    setpointCounts: hasBit(words.flags, 4) ? words.setpoint_counts : null,
    direction: nameOf("direction", words.direction),
    drive: words.drive,
    leaseTicks: words.lease_ticks,
    checksumFailures: words.checksum_failures,
    heartbeat: words.heartbeat,
    minCounts: words.min_counts,
    maxCounts: words.max_counts,
    homeDifferenceCounts: words.home_difference_counts,
  };
}

function readWords<Name extends string>(
  view: DataView,
  offset: number,
  names: readonly Name[],
  signed: ReadonlySet<string> = new Set(),
): Record<Name, number> {
  const words = names.map((name, index) => {
    const at = offset + index * WORD;
    return [name, signed.has(name) ? view.getInt32(at, true) : view.getUint32(at, true)];
  });
  return Object.fromEntries(words);
}

function nameOf<F extends Family>(family: F, number: number): Code<F> {
  return entry(family, number).name as Code<F>;
}

function hasBit(word: number, bit: number): boolean {
  return ((word >>> bit) & 1) === 1;
}

function bits(word: number): number[] {
  return Array.from({ length: 32 }, (_, bit) => bit).filter((bit) => hasBit(word, bit));
}

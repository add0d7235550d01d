/** For tests: a kernel of its own in WebAssembly, ticked with ideal cards, and the native kernel's vectors. */
import { spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { catalog } from "../generated/catalog";

const folder = new URL("../../kernel/", import.meta.url);
const SLOTS = 10;
const FRAME_WORDS = 32;
const REQUESTS = 16;
const VERDICT_WORDS = 5;

/** Sizes and places in words, as web/kernel/vectors.c writes them. */
const LAYOUT = [
  ...(["config", "state", "inputs", "request", "outputs", "axisConfig", "axis"] as const),
  ...(["maxDrive", "unhomedMaxDrive", "tick", "mode", "cause", "consent", "lastSequence"] as const),
  ...(["homed", "frames", "gates", "verdicts"] as const),
];
type Layout = Readonly<Record<(typeof LAYOUT)[number], number>>;

export interface Vector {
  readonly state: Uint32Array;
  readonly inputs: Uint32Array;
  readonly count: number;
  readonly requests: Uint32Array;
  readonly stateAfter: Uint32Array;
  readonly outputs: Uint32Array;
  /** Which gate blocks each axis in the state after the tick. */
  readonly gatesAfter: Uint32Array;
}

/** What web/kernel/vectors.c writes: the native kernel's layout, a configuration, and so many vectors. */
function nativeWords(count: number): Uint32Array {
  const run = spawnSync(new URL("../../build/console/vectors", folder).pathname, [String(count)], {
    maxBuffer: 2 ** 28,
  });
  if (run.status !== 0) throw new Error(`vectors: ${run.error?.message ?? run.stderr.toString()}`);
  return new Uint32Array(run.stdout.buffer.slice(run.stdout.byteOffset), 0, run.stdout.length / 4);
}

function layoutOf(words: Uint32Array): Layout {
  return Object.fromEntries(LAYOUT.map((name, index) => [name, words[index] ?? 0])) as Layout;
}

export const layout = layoutOf(nativeWords(0));

export function nativeVectors(count: number): { config: Uint32Array; vectors: Iterable<Vector> } {
  const words = nativeWords(count);
  let at = LAYOUT.length;
  const take = (length: number): Uint32Array => {
    at += length;
    return words.subarray(at - length, at);
  };
  const config = take(layout.config);
  function* each(): Iterable<Vector> {
    while (at < words.length) {
      const state = take(layout.state);
      const inputs = take(layout.inputs);
      const [number = 0] = take(1);
      const requests = take(REQUESTS * layout.request);
      yield {
        ...{ state, inputs, count: number, requests },
        ...{ stateAfter: take(layout.state), outputs: take(layout.outputs), gatesAfter: take(SLOTS) },
      };
    }
  }
  return { config, vectors: each() };
}

export function verdictIn(outputs: Uint32Array, request: number): string {
  return codeName("verdict", outputs[layout.verdicts + VERDICT_WORDS * (request + 1) - 1] ?? -1);
}

export function modeIn(state: Uint32Array): string {
  return codeName("mode", state[layout.mode] ?? -1);
}

export function instantiate(): WebAssembly.Instance {
  return new WebAssembly.Instance(new WebAssembly.Module(readFileSync(new URL("kernel.wasm", folder))));
}

interface RawExports {
  readonly memory: WebAssembly.Memory;
  readonly ilk_init: (verdict: number, config: number, state: number) => void;
  readonly ilk_request_crc: (request: number) => number;
  readonly ilk_step: (
    config: number,
    state: number,
    inputs: number,
    requests: number,
    count: number,
    outputs: number,
  ) => void;
}

export interface Wish {
  readonly kind: (typeof catalog.request)[number]["name"];
  readonly slot?: number;
  readonly target?: number;
  readonly drive?: number;
  readonly lease?: number;
  /** That of this press if left out. */
  readonly consent?: number;
}

/** The kernel by its own functions, on memory behind everything that the module uses itself. */
export class KernelBench {
  readonly config: Uint32Array;
  readonly state: Uint32Array;
  readonly inputs: Uint32Array;
  readonly requests: Uint32Array;
  readonly outputs: Uint32Array;
  private readonly kernel: RawExports;
  private heartbeat = 0;
  /** What each card reads: counter and whether the axis stands at its switch. */
  readonly raw = new Uint32Array(SLOTS);
  readonly atSwitch = new Set<number>();
  /** Slots that do not answer. */
  readonly silent = new Set<number>();
  pressed = false;
  estop = false;

  constructor(config: Uint32Array, instance = instantiate()) {
    this.kernel = instance.exports as unknown as RawExports;
    let at = this.kernel.memory.grow(1) * 65536;
    const block = (words: number): Uint32Array => {
      at += words * 4;
      return new Uint32Array(this.kernel.memory.buffer, at - words * 4, words);
    };
    this.config = block(layout.config);
    this.state = block(layout.state);
    this.inputs = block(layout.inputs);
    this.requests = block(REQUESTS * layout.request);
    this.outputs = block(layout.outputs);
    this.config.set(config);
    this.kernel.ilk_init(block(2).byteOffset, this.config.byteOffset, this.state.byteOffset);
  }

  step(count: number): void {
    const { config, state, inputs, requests, outputs } = this;
    this.kernel.ilk_step(
      ...([config.byteOffset, state.byteOffset, inputs.byteOffset] as const),
      ...([requests.byteOffset, count, outputs.byteOffset] as const),
    );
  }

  /** One tick with a living app; the verdicts on the wishes. */
  tick(...wishes: readonly Wish[]): string[] {
    this.writeInputs();
    const all: Wish[] = [{ kind: "HEARTBEAT" }, ...wishes];
    all.forEach((wish, index) => {
      this.writeRequest(index, wish);
    });
    this.step(all.length);
    return wishes.map((_, index) => verdictIn(this.outputs, index + 1));
  }

  ticks(count: number): void {
    for (let tick = 0; tick < count; tick++) this.tick();
  }

  /** Unlocked, with the axis enabled and, if wanted, homed where it stands. */
  ready(slot: number, homed: boolean): void {
    this.ticks(20);
    this.expectAccepted(this.tick({ kind: "RESET" }));
    this.ticks(20);
    if (homed) this.expectAccepted(this.tick({ kind: "SET_HOME", slot }));
    this.expectAccepted(this.tick({ kind: "ENABLE", slot }));
  }

  /** Releases the pedal, then presses it, each until the kernel has taken note. */
  press(): void {
    this.pressed = false;
    this.ticks(10);
    this.pressed = true;
    this.ticks(10);
  }

  /** The verdict on a MOVE as the app sends it. */
  move(slot: number, target: number): string {
    const homed = this.state[layout.homed + layout.axis * slot] !== 0;
    const drive =
      this.config[(homed ? layout.maxDrive : layout.unhomedMaxDrive) + layout.axisConfig * slot] ?? 0;
    const [verdict = ""] = this.tick({ kind: "MOVE", slot, target, drive, lease: 10 });
    return verdict;
  }

  gate(slot: number): string {
    return codeName("gate", this.outputs[layout.gates + slot] ?? -1);
  }

  get mode(): string {
    return modeIn(this.state);
  }

  get cause(): string {
    return codeName("cause", this.state[layout.cause] ?? -1);
  }

  /** State and configuration as the app passes them on. */
  stateBytes(): Uint8Array {
    return bytesOf(this.state);
  }

  private expectAccepted(verdicts: readonly string[]): void {
    if (verdicts.some((verdict) => verdict !== "ACCEPTED"))
      throw new Error(`refused: ${verdicts.join(", ")}`);
  }

  private writeInputs(): void {
    this.heartbeat += 1;
    const tick = this.state[layout.tick] ?? 0;
    const answering = Array.from({ length: SLOTS }, (_, slot) => (this.silent.has(slot) ? 0 : 1 << slot));
    this.inputs.set([
      ...[1, 7, 0, 1, answering.reduce((mask, bit) => mask | bit, 0)],
      ...[this.pressed ? 1 : 0, this.pressed ? 0 : 1, this.estop ? 0 : 1],
    ]);
    for (let slot = 0; slot < SLOTS; slot++) {
      const at = layout.frames + slot * FRAME_WORDS;
      const frame = this.inputs.subarray(at, at + FRAME_WORDS);
      frame.fill(0);
      frame[0] = 0xfefefe01;
      frame[2] = this.atSwitch.has(slot) ? 0 : 0x00080000;
      frame[3] = this.raw[slot] ?? 0;
      frame[9] = this.heartbeat;
      frame[10] = tick * 1000;
      frame[11] = tick - 2;
      frame[31] = 0xffffffff - (frame.reduce((sum, word) => (sum + word) >>> 0, 0) >>> 0);
    }
  }

  private writeRequest(index: number, wish: Wish): void {
    const request = this.requests.subarray(index * layout.request, (index + 1) * layout.request);
    const number = catalog.request.find((each) => each.name === wish.kind)?.number ?? 0;
    request.set([
      ...[(this.state[layout.lastSequence] ?? 0) + 1 + index, number, wish.slot ?? 0, wish.target ?? 0],
      ...[wish.drive ?? 0, 0, wish.lease ?? 0, wish.consent ?? this.state[layout.consent] ?? 0, 1, 0],
    ]);
    request[layout.request - 1] = this.kernel.ilk_request_crc(request.byteOffset);
  }
}

export function bytesOf(words: Uint32Array): Uint8Array {
  return new Uint8Array(words.slice().buffer);
}

function codeName(family: "mode" | "cause" | "gate" | "verdict", number: number): string {
  const codes: readonly { readonly number: number; readonly name: string }[] = catalog[family];
  return codes.find((code) => code.number === number)?.name ?? `UNKNOWN_${number}`;
}

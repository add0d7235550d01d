/**
 * The safety kernel itself, compiled to WebAssembly (web/kernel): says what the robot's kernel would answer, from the
 * configuration and the state that the app passes on word for word. Nothing here decides or drives anything.
 */
import { type CodeName, entry } from "../generated/catalog";

/** What web/kernel/page_kernel.c exports. */
interface Exports extends WebAssembly.Exports {
  readonly memory: WebAssembly.Memory;
  readonly configuration: () => number;
  readonly configuration_bytes: () => number;
  readonly configuration_is_valid: () => number;
  readonly state: () => number;
  readonly state_bytes: () => number;
  readonly state_is_sound: () => number;
  readonly judge: (kind: number, slot: number, targetCounts: number) => number;
  readonly foresee: (kind: number, slot: number, targetCounts: number) => number;
  readonly gate: (slot: number) => number;
  readonly walk_gates: (slot: number, hasTarget: number, targetCounts: number) => number;
}

/** What an axis is wanted to do while the pedal is held. */
export type AxisWish = { readonly kind: "MOVE"; readonly targetCounts: number } | { readonly kind: "HOME" };

/** The kernel's answer to a wish once the pedal is held, if nothing else changes until then. */
export interface Foresight {
  readonly verdict: CodeName<"verdict">;
  /** In the tick in which it was judged; what would keep what was accepted from its drive. */
  readonly gate: CodeName<"gate">;
  /** In which it was judged: MOTION unless the press of the pedal would not lead there. */
  readonly mode: CodeName<"mode">;
}

/** `unjudged`: the gates before it tell nothing of it. */
export type GateStand = "open" | "closed" | "unjudged";

export class PageKernel {
  private readonly calls: Exports;

  constructor(instance: WebAssembly.Instance) {
    this.calls = instance.exports as Exports;
  }

  /** Takes over the configuration of the robot's kernel; false when a kernel would not start with it. */
  configure(bytes: Uint8Array): boolean {
    return (
      this.write(this.calls.configuration(), this.calls.configuration_bytes(), bytes) &&
      this.calls.configuration_is_valid() === 1
    );
  }

  /** Takes over the state; false when it is damaged, or of another configuration. */
  see(bytes: Uint8Array): boolean {
    return (
      this.write(this.calls.state(), this.calls.state_bytes(), bytes) && this.calls.state_is_sound() === 1
    );
  }

  foresee(slot: number, wish: AxisWish): Foresight {
    const target = wish.kind === "MOVE" ? wish.targetCounts : 0;
    const answer = this.calls.foresee(entry("request", wish.kind).number, slot, target);
    return {
      verdict: nameOf("verdict", answer & 0xff),
      gate: nameOf("gate", (answer >>> 8) & 0xff),
      mode: nameOf("mode", (answer >>> 16) & 0xff),
    };
  }

  /** The verdict on a request now. */
  judge(request: CodeName<"request">, slot: number, targetCounts = 0): CodeName<"verdict"> {
    return nameOf("verdict", this.calls.judge(entry("request", request).number, slot, targetCounts));
  }

  /** The gate that blocks the axis now; OPEN when it may be driven. */
  gate(slot: number): CodeName<"gate"> {
    return nameOf("gate", this.calls.gate(slot));
  }

  /** How each gate stands, by its number. `targetCounts`: of the move that waits; null when none does. */
  walkGates(slot: number, targetCounts: number | null): readonly GateStand[] {
    const answer = this.calls.walk_gates(slot, targetCounts === null ? 0 : 1, targetCounts ?? 0);
    return Array.from({ length: 16 }, (_, gate) => {
      if (((answer >>> (16 + gate)) & 1) === 0) return "unjudged";
      return ((answer >>> gate) & 1) === 1 ? "closed" : "open";
    });
  }

  private write(at: number, length: number, bytes: Uint8Array): boolean {
    if (bytes.length !== length) return false;
    new Uint8Array(this.calls.memory.buffer, at, length).set(bytes);
    return true;
  }
}

function nameOf<F extends "verdict" | "gate" | "mode">(family: F, number: number): CodeName<F> {
  return entry(family, number).name as CodeName<F>;
}

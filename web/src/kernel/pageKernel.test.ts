import { describe, expect, it } from "vitest";
import { catalog } from "../generated/catalog";
import { bytesOf, instantiate, KernelBench, modeIn, nativeVectors, verdictIn } from "./kernelBench";
import { type AxisWish, PageKernel } from "./pageKernel";

const VECTORS = 16_000;
const AXIS_SLOTS = [0, 1, 2, 3, 4, 5, 6, 7];
const { config } = nativeVectors(0);

function pageKernel(): PageKernel {
  const kernel = new PageKernel(instantiate());
  expect(kernel.configure(bytesOf(config))).toBe(true);
  return kernel;
}

/** The kernel in the page, shown what the bench's kernel knows now. */
function looking(bench: KernelBench): PageKernel {
  const kernel = pageKernel();
  expect(kernel.see(bench.stateBytes())).toBe(true);
  return kernel;
}

describe("the kernel in WebAssembly", () => {
  it(`decides ${VECTORS} ticks, half of them from any sound state, as the native kernel does, word for word`, () => {
    const bench = new KernelBench(config);
    const page = pageKernel();
    const seen = { mode: new Set<string>(), gate: new Set<string>(), verdict: new Set<string>() };
    const wrong: string[] = [];
    let number = 0;
    for (const vector of nativeVectors(VECTORS).vectors) {
      bench.state.set(vector.state);
      bench.inputs.set(vector.inputs);
      bench.requests.set(vector.requests);
      bench.step(vector.count);
      if (!same(bench.state, vector.stateAfter)) wrong.push(`vector ${number} state`);
      if (!same(bench.outputs, vector.outputs)) wrong.push(`vector ${number} outputs`);
      seen.mode.add(modeIn(vector.stateAfter));
      page.see(bytesOf(vector.stateAfter));
      for (const slot of AXIS_SLOTS) {
        const expected = catalog.gate[vector.gatesAfter[slot] ?? -1]?.name ?? "none";
        seen.gate.add(expected);
        const firstClosed = page.walkGates(slot, null).indexOf("closed");
        const walked = catalog.gate[Math.max(firstClosed, 0)]?.name;
        if (page.gate(slot) !== expected) wrong.push(`vector ${number} gate of slot ${slot}`);
        if (walked !== expected) wrong.push(`vector ${number} walk of slot ${slot}`);
      }
      for (let request = 0; request < vector.count; request++)
        seen.verdict.add(verdictIn(vector.outputs, request));
      number += 1;
    }
    expect(wrong).toEqual([]);
    expect(number).toBe(VECTORS);
    expect(seen.mode).toEqual(new Set(catalog.mode.map(({ name }) => name)));
    // Before the gates of pedal and E-stop MOTION ends.
    const brought = catalog.gate.filter(({ name }) => !["PEDAL", "ESTOP"].includes(name));
    expect(seen.gate).toEqual(new Set(brought.map(({ name }) => name)));
    // The app of this world moves no axis that it did not enable, and homes none often; that of the next tests does.
    const answered = catalog.verdict.filter(({ name }) => !["DISABLED", "BUDGET"].includes(name));
    expect(seen.verdict).toEqual(new Set(answered.map(({ name }) => name)));
  }, 60_000);

  it("takes no configuration that a kernel would refuse", () => {
    const damaged = bytesOf(config);
    damaged[100] = (damaged[100] ?? 0) ^ 1;
    const kernel = new PageKernel(instantiate());
    expect(kernel.configure(damaged)).toBe(false);
    expect(kernel.configure(bytesOf(config).subarray(4))).toBe(false);
    expect(kernel.configure(bytesOf(config))).toBe(true);
  });

  it("takes no state that was damaged on its way, whichever byte it is", () => {
    const bench = new KernelBench(config);
    bench.ready(1, true);
    const kernel = pageKernel();
    const state = bench.stateBytes();
    for (let byte = 0; byte < state.length; byte++) {
      const damaged = state.slice();
      damaged[byte] = (damaged[byte] ?? 0) ^ 0x10;
      expect(kernel.see(damaged), `byte ${byte}`).toBe(false);
    }
    expect(kernel.see(state)).toBe(true);
  });

  it("takes no state of another configuration", () => {
    const other = config.slice();
    const bench = new KernelBench(other);
    const kernel = new PageKernel(instantiate());
    expect(kernel.see(bench.stateBytes())).toBe(false);
  });
});

describe("foresee", () => {
  const move = (targetCounts: number): AxisWish => ({ kind: "MOVE", targetCounts });
  const targets = [
    -1001,
    -991,
    -990,
    -100,
    -91,
    -90,
    0,
    90,
    91,
    100,
    990,
    991,
    1001,
    2 ** 31 - 1,
    -(2 ** 31),
  ];

  it.each([
    ["homed", true],
    ["not homed", false],
  ])("says before the pedal is pressed what the kernel says to a move of an axis that is %s", (_, homed) => {
    const said = targets.map((target) => {
      const bench = new KernelBench(config);
      bench.ready(1, homed);
      const foreseen = looking(bench).foresee(1, move(target));
      bench.press();
      const verdict = bench.move(1, target);
      expect(foreseen, `target ${target}`).toEqual({ verdict, gate: bench.gate(1), mode: "MOTION" });
      return verdict;
    });
    expect(new Set(said)).toEqual(new Set(["ACCEPTED", "RANGE"]));
  });

  it("counts the travel of a press that goes on", () => {
    const bench = new KernelBench(config);
    bench.ready(1, false);
    bench.press();
    for (let step = 0; step < 40; step++) {
      bench.raw[1] = (bench.raw[1] ?? 0) + 1;
      bench.move(1, 80);
    }
    const kernel = looking(bench);
    expect(kernel.foresee(1, move(89)).verdict).toBe("ACCEPTED");
    expect(kernel.foresee(1, move(90)).verdict).toBe("RANGE");
    expect([bench.move(1, 89), bench.move(1, 90)]).toEqual(["ACCEPTED", "RANGE"]);
  });

  it("foresees that a move towards a triggered switch is refused, and one away from it is not", () => {
    const bench = new KernelBench(config);
    bench.atSwitch.add(2);
    bench.ready(2, true);
    const kernel = looking(bench);
    expect(kernel.foresee(2, move(500))).toMatchObject({ verdict: "RANGE", mode: "MOTION" });
    expect(kernel.foresee(2, move(-500))).toEqual({ verdict: "ACCEPTED", gate: "OPEN", mode: "MOTION" });
    bench.press();
    expect([bench.move(2, 500), bench.move(2, -500)]).toEqual(["RANGE", "ACCEPTED"]);
  });

  it("foresees the single reading of the switch that holds an accepted move back", () => {
    const bench = new KernelBench(config);
    bench.ready(2, true);
    bench.press();
    bench.move(2, 500);
    bench.atSwitch.add(2);
    const before = looking(bench).foresee(2, move(500));
    expect(before).toEqual({ verdict: "ACCEPTED", gate: "OPEN", mode: "MOTION" });
    expect([bench.move(2, 500), bench.gate(2)]).toEqual(["ACCEPTED", "HARD_LIMIT"]);
    const after = looking(bench).foresee(2, move(500));
    expect(after).toEqual({ verdict: "ACCEPTED", gate: "HARD_LIMIT", mode: "MOTION" });
  });

  it("wants the axis enabled, and supposes a release of a pedal that is held already", () => {
    const bench = new KernelBench(config);
    bench.ready(1, true);
    bench.press();
    bench.tick({ kind: "STOP" });
    expect([bench.mode, bench.pressed]).toEqual(["READY", true]);
    expect(looking(bench).foresee(1, move(10))).toMatchObject({ verdict: "ACCEPTED", mode: "MOTION" });
    expect(looking(bench).foresee(3, move(10))).toMatchObject({ verdict: "DISABLED", mode: "MOTION" });
  });

  it("sees no way out of LOCKED", () => {
    const bench = new KernelBench(config);
    bench.ticks(5);
    expect([bench.mode, bench.cause]).toEqual(["LOCKED", "BOOT"]);
    expect(looking(bench).foresee(1, move(10))).toMatchObject({ verdict: "MODE", mode: "LOCKED" });
  });

  it("sees that the loss of a required card keeps MOTION from beginning", () => {
    const bench = new KernelBench(config);
    bench.ready(1, true);
    bench.silent.add(8);
    bench.ticks(10);
    expect(looking(bench).foresee(1, move(10))).toMatchObject({ verdict: "MODE", mode: "READY" });
    bench.press();
    expect([bench.mode, bench.move(1, 10)]).toEqual(["READY", "MODE"]);
  });

  it("knows no axis where there is none", () => {
    const bench = new KernelBench(config);
    bench.ticks(5);
    for (const slot of [8, 9, 10, 4294967295])
      expect(looking(bench).foresee(slot, move(0)).verdict).toBe("AXIS");
  });
});

describe("foresee homing", () => {
  const home: AxisWish = { kind: "HOME" };

  it.each([1, 2, 3])("says before the pedal is pressed what the kernel says to HOME of axis %i", (slot) => {
    const bench = new KernelBench(config);
    bench.ready(2, false);
    const foreseen = looking(bench).foresee(slot, home);
    bench.press();
    const [verdict] = bench.tick({ kind: "HOME", slot });
    expect(foreseen).toEqual({ verdict, gate: bench.gate(slot), mode: "MOTION" });
  });

  it("has seen axes with and without a switch, enabled and not", () => {
    const bench = new KernelBench(config);
    bench.ready(2, false);
    bench.tick({ kind: "ENABLE", slot: 1 });
    const verdicts = [1, 2, 3].map((slot) => looking(bench).foresee(slot, home).verdict);
    expect(verdicts).toEqual(["NO_SWITCH", "ACCEPTED", "DISABLED"]);
  });

  it("sees that homing has used up its travel of this press, and is whole in the next", () => {
    const bench = new KernelBench(config);
    bench.ready(2, false);
    bench.press();
    bench.tick({ kind: "HOME", slot: 2 });
    bench.ticks(5);
    const travel = (counts: number): void => {
      bench.raw[2] = (bench.raw[2] ?? 0) + counts;
    };
    for (let tick = 0; tick < 298; tick++) {
      travel(8);
      bench.tick();
    }
    // Shortly before homing would fault: the axis is disabled, and coasts over the rest.
    bench.tick({ kind: "DISABLE", slot: 2 });
    travel(8);
    bench.ticks(20);
    bench.tick({ kind: "ENABLE", slot: 2 });
    expect(looking(bench).foresee(2, home).verdict).toBe("BUDGET");
    expect(bench.tick({ kind: "HOME", slot: 2 })).toEqual(["BUDGET"]);
    bench.press();
    expect(looking(bench).foresee(2, home).verdict).toBe("ACCEPTED");
  });

  it("sees no way out of LOCKED", () => {
    const bench = new KernelBench(config);
    bench.ticks(5);
    expect(looking(bench).foresee(2, home)).toMatchObject({ verdict: "MODE", mode: "LOCKED" });
  });
});

describe("judge", () => {
  it("gives the verdict on a request now", () => {
    const bench = new KernelBench(config);
    bench.ready(1, true);
    const kernel = looking(bench);
    expect(kernel.judge("MOVE", 1, 5)).toBe("MODE");
    expect(kernel.judge("ENABLE", 2)).toBe("ACCEPTED");
    expect(kernel.judge("CLEAR_FAULT", 1)).toBe("NO_FAULT");
    expect(kernel.judge("RESTORE", 1, 1001)).toBe("RANGE");
    expect(kernel.judge("HOME", 9)).toBe("AXIS");
  });
});

describe("walkGates", () => {
  const closed = (bench: KernelBench, slot: number, target: number | null): string[] => {
    const stands = looking(bench).walkGates(slot, target);
    return catalog.gate.filter(({ number }) => stands[number] === "closed").map(({ name }) => name);
  };
  const unjudged = (bench: KernelBench, slot: number, target: number | null): string[] => {
    const stands = looking(bench).walkGates(slot, target);
    return catalog.gate.filter(({ number }) => stands[number] === "unjudged").map(({ name }) => name);
  };

  it("names every gate that is closed, not only the first", () => {
    const bench = new KernelBench(config);
    bench.ready(1, true);
    bench.estop = true;
    bench.silent.add(1);
    bench.ticks(2);
    expect(closed(bench, 1, null)).toEqual(["MODE", "PEDAL", "ESTOP", "CARD", "ENABLE", "LEASE"]);
  });

  it("judges the gates of the wish only when a move waits", () => {
    const bench = new KernelBench(config);
    bench.atSwitch.add(2);
    bench.ready(2, true);
    expect(closed(bench, 2, null)).toEqual(["MODE", "PEDAL", "LEASE"]);
    expect(unjudged(bench, 2, null)).toContain("HARD_LIMIT");
    expect(closed(bench, 2, 500)).toEqual(["MODE", "PEDAL", "LEASE", "HARD_LIMIT"]);
    expect(closed(bench, 2, -500)).toEqual(["MODE", "PEDAL", "LEASE"]);
    expect(unjudged(bench, 2, -500)).toEqual([]);
    expect(closed(bench, 2, 1)).toEqual(["MODE", "PEDAL", "LEASE", "SETPOINT"]);
  });

  it("does not guess how a switch stands whose card is silent", () => {
    const bench = new KernelBench(config);
    bench.ready(2, true);
    bench.silent.add(2);
    bench.ticks(1);
    expect(closed(bench, 2, 500)).toEqual(["MODE", "PEDAL", "CARD", "LEASE"]);
    expect(unjudged(bench, 2, 500)).toContain("HARD_LIMIT");
  });

  it("has every gate open while the axis is driven", () => {
    const bench = new KernelBench(config);
    bench.ready(1, true);
    bench.press();
    bench.move(1, 500);
    expect(bench.gate(1)).toBe("OPEN");
    expect(closed(bench, 1, null)).toEqual([]);
    expect(unjudged(bench, 1, null)).toEqual([]);
  });
});

function same(a: Uint32Array, b: Uint32Array): boolean {
  return a.length === b.length && a.every((word, index) => word === b[index]);
}

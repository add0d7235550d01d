import { describe, expect, it } from "vitest";
import type { Motor, Proposal, Robot } from "../api/client";
import { homingPart, homingSteps, isOpen, nextWishes, openHoming, openPath } from "./proposals";

const robot = {
  auto_approve: false,
  home_steps: [
    { name: "out", title: "Probe out", kind: "home", axes: ["insertion"] },
    { name: "turn", title: "Turn", kind: "home", axes: ["yaw", "pitch"] },
    { name: "rest", title: "Rest", kind: "move", axes: ["head"] },
  ],
} as unknown as Robot;
const all = {
  id: 3,
  kind: "home",
  state: "executing",
  step: "turn",
  axes: ["insertion", "yaw", "pitch", "head"],
} as Proposal;
const motor = (name: string): Motor => ({ name }) as Motor;

describe("isOpen", () => {
  it.each<[Proposal["state"], boolean]>([
    ["drafted", true],
    ["checked", true],
    ["approved", true],
    ["executing", true],
    ["paused", true],
    ["done", false],
    ["refused", false],
    ["aborted", false],
    ["expired", false],
  ])("%s: %s", (state, open) => {
    expect(isOpen({ ...all, state })).toBe(open);
  });
});

describe("openPath", () => {
  it("finds the open motion of several axes, and no other", () => {
    const path = { ...all, id: 7, kind: "path", state: "approved" } as Proposal;
    expect(openPath([all, { ...path, id: 8, state: "done" }, path])).toBe(path);
    expect(openPath([all])).toBeUndefined();
  });
});

describe("openHoming", () => {
  it("finds the open homing among moves and ended homings", () => {
    const others = [
      { ...all, id: 1, state: "done" },
      { ...all, id: 2, kind: "move" },
    ] as Proposal[];
    expect(openHoming([...others, all])).toBe(all);
    expect(openHoming(others)).toBeUndefined();
  });
});

describe("homingPart", () => {
  it("tells the axes of the step that runs from those that wait", () => {
    expect(["yaw", "pitch", "head", "feet"].map((name) => homingPart(all, robot, motor(name)))).toEqual([
      "homing",
      "homing",
      "waiting",
      null,
    ]);
  });

  it("knows an axis that homes by itself, without a step", () => {
    const alone = { ...all, step: null, axes: ["yaw"] };
    expect(homingPart(alone, robot, motor("yaw"))).toBe("homing");
    expect(homingPart(undefined, robot, motor("yaw"))).toBeNull();
  });
});

describe("homingSteps", () => {
  it("puts each step before, at or after the one that runs", () => {
    expect(homingSteps(all, robot).map(({ title, place }) => `${title} ${place}`)).toEqual([
      "Probe out before",
      "Turn now",
      "Rest after",
    ]);
  });

  it("leaves out steps that the homing does not take, and all for an axis alone", () => {
    const one = { ...all, axes: ["yaw", "pitch"] };
    expect(homingSteps(one, robot).map(({ name }) => name)).toEqual(["turn"]);
    expect(homingSteps({ ...all, step: null, axes: ["yaw"] }, robot)).toEqual([]);
  });
});

describe("nextWishes", () => {
  const motors = ["insertion", "yaw", "pitch", "head"].map((name, slot) => ({ name, slot }) as Motor);
  const told = (proposal: Partial<Proposal>) =>
    nextWishes({ ...all, slot: null, target_counts: null, ...proposal } as Proposal, motors, robot).map(
      ({ motor: { name }, wish }) => [name, wish],
    );

  it("is the move of one axis", () => {
    expect(told({ kind: "move", slot: 1, target_counts: -30 })).toEqual([
      ["yaw", { kind: "MOVE", targetCounts: -30 }],
    ]);
  });

  it("is where the axes of a path come to rest, in the order of the motors", () => {
    const ends = [
      { slot: 3, target_counts: 4 },
      { slot: 0, target_counts: 0 },
    ];
    expect(told({ kind: "path", ends })).toEqual([
      ["insertion", { kind: "MOVE", targetCounts: 0 }],
      ["head", { kind: "MOVE", targetCounts: 4 }],
    ]);
    expect(told({ kind: "path" })).toEqual([]);
  });

  it("is the homing that a step begins with, not that of the steps after it", () => {
    expect(told({ step: "turn" })).toEqual([
      ["yaw", { kind: "HOME" }],
      ["pitch", { kind: "HOME" }],
    ]);
    expect(told({ step: null, axes: ["pitch"] })).toEqual([["pitch", { kind: "HOME" }]]);
  });

  it("is nothing of a step that moves axes, nor of what decides as it goes", () => {
    expect(told({ step: "rest" })).toEqual([]);
    expect(told({ kind: "sweep" })).toEqual([]);
    expect(told({ kind: "biopsy" })).toEqual([]);
  });
});

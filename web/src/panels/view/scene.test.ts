import { describe, expect, it } from "vitest";
import type { AlignmentView, ProposalPlan, Targeting } from "../../api/client";
import { presets, standOf } from "./cameras";
import { along, ballAround, cellsOf, distance, sceneOf, wayOf, wordsOf, wordsOfCells } from "./scene";

/** At (10, 20, 30), its z along x of the scanner. */
const pose = [0, 0, 1, 10, 0, 1, 0, 20, -1, 0, 0, 30, 0, 0, 0, 1];
const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

const targeting = {
  registration: identity,
  registration_state: "valid",
  entry_point: null,
  target_point: [1, 2, 3],
  treatment_to_tip_offset: 5,
  cannula_to_treatment_offset: 8,
} as unknown as Targeting;

const nothing: AlignmentView = {
  frame: "scanner",
  alignment: null,
  alignment_problem: { code: "NO_TARGET", text: "Entry and target are not both set." },
  current: null,
  current_problem: { code: "NOT_HOMED", text: "Home the yaw." },
  current_body: null,
  current_body_problem: { code: "NOT_HOMED", text: "Home the yaw." },
  current_deviation: null,
};

describe("along", () => {
  it("goes along z of the pose", () => {
    expect(along(pose, 0)).toEqual([10, 20, 30]);
    expect(along(pose, 4)).toEqual([14, 20, 30]);
  });
});

describe("sceneOf", () => {
  it("shows nothing that is not known, and says why", () => {
    const scene = sceneOf(targeting, nothing);
    expect(scene.probes).toEqual([]);
    expect(scene.marks).toEqual([{ name: "target", kind: "target", at: [1, 2, 3] }]);
    expect(scene.axes.map(({ name }) => name)).toEqual(["scanner (RAS)", "zFrame"]);
    expect(scene.deviation).toBeNull();
    expect(scene.missing).toEqual([
      "NOT_HOMED: Home the yaw.",
      "NO_TARGET: Entry and target are not both set.",
    ]);
  });

  it("is in the robot's own frame while no registration is valid", () => {
    const expired = { ...targeting, registration_state: "expired" as const, registration: pose };
    const scene = sceneOf(expired, { ...nothing, frame: "robot" });
    expect(scene.marks).toEqual([]);
    expect(scene.axes).toEqual([{ name: "zFrame", pose: identity, lengthMm: 40 }]);
  });

  it("has the current probe from its cannula to its tip", () => {
    const scene = sceneOf(targeting, { ...nothing, current: pose, current_problem: null });
    expect(scene.probes).toEqual([
      { name: "current", kind: "current", cannula: [2, 20, 30], treatment: [10, 20, 30], tip: [15, 20, 30] },
    ]);
    expect(wordsOf(scene)).toBe("current treatment point 10.0, 20.0, 30.0; target 1.0, 2.0, 3.0");
  });

  it("has the desired and the reachable probe beside it, and what parts them", () => {
    const alignment = { desired: identity, reachable: pose } as unknown as AlignmentView["alignment"];
    const scene = sceneOf(targeting, {
      ...nothing,
      alignment,
      alignment_problem: null,
      current: pose,
      current_problem: null,
      current_body_problem: null,
    });
    expect(scene.probes.map(({ kind }) => kind)).toEqual(["desired", "reachable", "current"]);
    expect(scene.deviation).toEqual([
      [10, 20, 30],
      [0, 0, 0],
    ]);
    expect(scene.missing).toEqual([]);
  });

  it("has the 95 % ellipsoid of the reachable pose, in words as well", () => {
    const treatment = {
      centre_mm: [1, 2, 3],
      half_axes_mm: [1.3, 0.9, 0.5],
      directions: [0, 1, 0, 1, 0, 0, 0, 0, -1],
      covariance_mm2: [],
    };
    const alignment = { desired: identity, reachable: pose, error_budget: { treatment } };
    const view = { ...nothing, alignment: alignment as unknown as AlignmentView["alignment"] };
    const scene = sceneOf(targeting, view);
    expect(scene.ellipsoid).toEqual({
      centre: [1, 2, 3],
      halfAxesMm: [1.3, 0.9, 0.5],
      directions: treatment.directions,
    });
    expect(wordsOf(scene)).toContain("95 % ellipsoid with half axes of 1.30, 0.90, 0.50 mm");
    expect(sceneOf(targeting, nothing).ellipsoid).toBeNull();
  });
});

describe("the ghost of a proposal", () => {
  const body = [{ name: "link" as const, from: [0, 0, 0], to: [0, 60, 0] }];
  const plan = {
    id: 12,
    ghost: {
      frame: "scanner",
      treatment: pose,
      tip: [15, 20, 30],
      tip_path: [
        [15, 20, 0],
        [15, 20, 20],
        [15, 20, 30],
      ],
      body,
    },
    ghost_problem: null,
  } as unknown as ProposalPlan;

  it("is the robot and the tip at its end, and the way there", () => {
    const scene = sceneOf(targeting, nothing, { robot: true, plan });
    expect(scene.bodies.map(({ kind }) => kind)).toEqual(["ghost"]);
    expect(scene.ghost && wayOf(scene.ghost)).toBe(30);
    expect(wordsOf(scene)).toContain("ghost of proposal 12: tip to 15.0, 20.0, 30.0 by a way of 30.0 mm");
    expect(distance([0, 60, 0], ballAround(scene).centre)).toBeLessThan(ballAround(scene).radiusMm);
  });

  it("stands beside the robot, which can be left out", () => {
    const known = { ...nothing, current: pose, current_problem: null, current_body: body };
    const kinds = (robot: boolean): string[] =>
      sceneOf(targeting, known, { robot, plan }).bodies.map(({ kind }) => kind);
    expect(kinds(true)).toEqual(["current", "ghost"]);
    expect(kinds(false)).toEqual(["ghost"]);
  });

  it("says why there is none", () => {
    const unplanned = { id: 3, ghost: null, ghost_problem: { code: "NO_PLAN", text: "Homing." } };
    const scene = sceneOf(targeting, nothing, { robot: true, plan: unplanned as unknown as ProposalPlan });
    expect(scene.ghost).toBeNull();
    expect(scene.missing).toContain("Ghost of proposal 3: NO_PLAN: Homing.");
  });
});

describe("the workspace", () => {
  it("moves with the registration, and says how far it goes", () => {
    const reach = { cell_mm: 10, centres: [[0, 0, 0] as number[], [0, 0, 20]], problem: null };
    const placed = { ...targeting, registration: pose };
    const cells = cellsOf(reach, placed, nothing);
    expect(cells?.centres).toEqual([
      [10, 20, 30],
      [30, 20, 30],
    ]);
    expect(cells && wordsOfCells(cells)).toBe("workspace: x 5 to 35, y 15 to 25, z 25 to 35");
    expect(cellsOf(reach, placed, { ...nothing, frame: "robot" })?.centres).toEqual(reach.centres);
    expect(cellsOf({ ...reach, centres: [] }, placed, nothing)).toBeNull();
  });
});

describe("the cameras", () => {
  const scene = sceneOf(targeting, { ...nothing, current: pose, current_problem: null });
  const ball = ballAround(scene);

  it("has a ball around everything", () => {
    for (const { cannula, tip } of scene.probes) {
      expect(distance(cannula, ball.centre)).toBeLessThan(ball.radiusMm);
      expect(distance(tip, ball.centre)).toBeLessThan(ball.radiusMm);
    }
  });

  it.each([0.5, 1, 2])("stand outside of it, and see all of it at an aspect of %d", (aspect) => {
    for (const preset of presets) {
      const far = distance(standOf(preset, ball, aspect), ball.centre);
      const half = Math.atan(Math.tan((35 * Math.PI) / 360) * Math.min(1, aspect));
      expect(ball.radiusMm / far).toBeLessThanOrEqual(Math.sin(half) + 1e-9);
    }
  });

  it("look along an axis of the scanner, or obliquely", () => {
    const coronal = presets.find(({ name }) => name === "coronal");
    expect(coronal?.from).toEqual([0, 1, 0]);
    for (const { from, up } of presets) {
      const cosine = from[0] * up[0] + from[1] * up[1] + from[2] * up[2];
      expect(Math.abs(cosine)).toBeLessThan(0.9);
    }
  });
});

import { describe, expect, it } from "vitest";
import type { AlignmentView, Targeting } from "../../api/client";
import { presets, standOf } from "./cameras";
import { along, ballAround, distance, sceneOf, wordsOf } from "./scene";

/** At (10, 20, 30), its z along x of the scanner. */
const pose = [0, 0, 1, 10, 0, 1, 0, 20, -1, 0, 0, 30, 0, 0, 0, 1];
const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

const targeting = {
  registration: identity,
  entry_point: null,
  target_point: [1, 2, 3],
  treatment_to_tip_offset: 5,
  cannula_to_treatment_offset: 8,
} as unknown as Targeting;

const nothing: AlignmentView = {
  alignment: null,
  alignment_problem: { code: "NO_TARGET", text: "Entry and target are not both set." },
  current: null,
  current_problem: { code: "NOT_HOMED", text: "Home the yaw." },
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
    });
    expect(scene.probes.map(({ kind }) => kind)).toEqual(["desired", "reachable", "current"]);
    expect(scene.deviation).toEqual([
      [10, 20, 30],
      [0, 0, 0],
    ]);
    expect(scene.missing).toEqual([]);
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

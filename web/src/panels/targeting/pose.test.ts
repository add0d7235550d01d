import { describe, expect, it } from "vitest";
import { deviationOf, poseProblems, turnBetween, upperRows, wholePose } from "./pose";

const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
const quarterTurn = [0, -1, 0, 10.5, 1, 0, 0, -20, 0, 0, 1, 30, 0, 0, 0, 1];
const identityWith = (changes: Record<number, number>): number[] =>
  identity.map((value, at) => changes[at] ?? value);

describe("poseProblems", () => {
  it("finds nothing against a rotation and a translation, rounded to three decimals", () => {
    expect(poseProblems(quarterTurn)).toEqual([]);
    expect(poseProblems(identityWith({ 0: 0.9998, 1: -0.0201, 4: 0.0201, 5: 0.9998 }))).toEqual([]);
  });

  it.each([
    [identityWith({ 5: 1.02 }), ["Column y: its length is 1.0200; expected 1, its square within 0.001."]],
    [
      identityWith({ 1: 0.02 }),
      ["Columns x and y: they are not perpendicular, their product is 0.0200; expected 0 within 0.001."],
    ],
    [
      identityWith({ 10: -1 }),
      ["The rotation mirrors: its determinant is -1.0000; expected +1. Check the signs of a column."],
    ],
    [identityWith({ 7: 10_001 }), ["Row A, origin: 10001 mm is too far away; expected -10000 to 10000 mm."]],
  ])("says what, where and what was expected", (pose, words) => {
    expect(poseProblems(pose)).toEqual(words);
  });

  it("finds something against what is no number", () => {
    expect(poseProblems(identityWith({ 3: Number.NaN }))).not.toEqual([]);
    expect(poseProblems(identityWith({ 6: Number.NaN }))).not.toEqual([]);
  });
});

describe("deviationOf", () => {
  it("is reached minus desired, and the angle between the two ways ahead", () => {
    const tilted = [1, 0, 0, 3, 0, 0, 1, -4, 0, -1, 0, 0, 0, 0, 0, 1];
    const { offset_mm, distance_mm, angle_deg } = deviationOf(tilted, identity);
    expect(offset_mm).toEqual([3, -4, 0]);
    expect(distance_mm).toBe(5);
    expect(angle_deg).toBeCloseTo(90, 12);
  });

  it("takes no turn about the probe for an error, and tells small angles", () => {
    expect(deviationOf(quarterTurn, identity).angle_deg).toBe(0);
    const small = 1e-7;
    const tilted = identityWith({ 6: -small, 9: small });
    expect(deviationOf(tilted, identity).angle_deg).toBeCloseTo((small * 180) / Math.PI, 12);
  });
});

describe("a pose", () => {
  it("is turned against another one about any axis", () => {
    expect(turnBetween(quarterTurn, identity)).toBeCloseTo(90, 10);
    expect(turnBetween(identity, identity)).toBe(0);
  });
  it("has a last row that is always the same", () => {
    expect(wholePose(upperRows(quarterTurn))).toEqual(quarterTurn);
  });
});

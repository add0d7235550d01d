import { describe, expect, it } from "vitest";
import type { Targeting } from "../../api/client";
import { draftOf, received, withText, withValues } from "./draft";
import {
  IGNORES_AT,
  registrationChange,
  registrationProblems,
  registrationValues,
  withPose,
} from "./registration";

const quarterTurn = [0, -1, 0, 10.5, 1, 0, 0, -20, 0, 0, 1, 30, 0, 0, 0, 1];
const targeting = { registration: quarterTurn, ignore_registration_rotation: false } as Targeting;
const draft = draftOf(registrationValues(targeting));

describe("what is sent of a registration", () => {
  it("is nothing when nothing changed", () => {
    expect(registrationChange(draft, true)).toBeNull();
    expect(registrationChange(withText(draft, 3, "10.50"), true)).toBeNull();
  });

  it("is the whole matrix when one number changed, and how it is used", () => {
    expect(registrationChange(withText(draft, 3, "11"), true)).toEqual({
      registration: quarterTurn.map((value, at) => (at === 3 ? 11 : value)),
      ignore_registration_rotation: false,
    });
  });

  it("is what has expired, as it is", () => {
    expect(registrationChange(draft, false)).toEqual({
      registration: quarterTurn,
      ignore_registration_rotation: false,
    });
  });

  it("is nothing while none is set and none is written", () => {
    const unset = { registration: null, ignore_registration_rotation: false } as Targeting;
    const empty = draftOf(registrationValues(unset));
    expect(registrationChange(empty, false)).toBeNull();
    expect(registrationProblems(withText(empty, 0, "1"))[0]).toContain("it is empty");
    expect(registrationChange(withValues(empty, withPose(empty, quarterTurn)), false)).toEqual({
      registration: quarterTurn,
      ignore_registration_rotation: false,
    });
  });

  it("says how it is used", () => {
    expect(registrationChange(withText(draft, IGNORES_AT, "1"), true)).toEqual({
      registration: quarterTurn,
      ignore_registration_rotation: true,
    });
  });

  it("is nothing while it is no rigid pose", () => {
    expect(registrationChange(withText(draft, 4, "1.1"), true)).toBeNull();
  });

  it("is a whole that is edited: another element that arrives does not mix with it", () => {
    const edited = withText(draft, 3, "11");
    const moved = { ...targeting, registration: quarterTurn.map((value, at) => (at === 11 ? 33 : value)) };
    expect(received(edited, registrationValues(moved)).text).toEqual(edited.text);
  });
});

describe("registrationProblems", () => {
  it("names row and column of what is no number, and what was expected", () => {
    const wrong = withText(withText(draft, 6, "x"), 11, "");
    expect(registrationProblems(wrong)).toEqual([
      "Row A, z: “x” is no number; expected one such as 0.7071.",
      "Row S, origin: it is empty; expected one such as -12.5.",
    ]);
  });

  it("finds what is not rigid once all are numbers", () => {
    expect(registrationProblems(withText(draft, 4, "1.1"))).toEqual([
      "Column x: its length is 1.1000; expected 1, its square within 0.001.",
    ]);
  });

  it("judges nothing that was not edited", () => {
    const bad = {
      registration: quarterTurn.map(() => 0),
      ignore_registration_rotation: false,
    } as unknown as Targeting;
    expect(registrationProblems(draftOf(registrationValues(bad)))).toEqual([]);
  });
});

describe("a pose that was read", () => {
  it("takes the place of the numbers and leaves how they are used", () => {
    const ignoring = withText(draft, IGNORES_AT, "1");
    const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
    const loaded = withValues(ignoring, withPose(ignoring, identity));
    expect(registrationChange(loaded, true)).toEqual({
      registration: identity,
      ignore_registration_rotation: true,
    });
  });
});

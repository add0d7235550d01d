import { describe, expect, it } from "vitest";
import type { Targeting } from "../../api/client";
import {
  type Aim,
  type AimName,
  aimChange,
  aimOf,
  aimProblems,
  changedGroups,
  pointsOf,
  receivedAim,
  withPoints,
} from "./aim";
import { hasNews, withText } from "./draft";

const targeting: Targeting = {
  case: 1,
  registration: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1],
  registration_state: "valid",
  registration_problem: null,
  registration_doubt: null,
  override_reason: null,
  ignore_registration_rotation: false,
  residual_mm: null,
  fiducials: null,
  fiducial_points: [],
  entry_point: [8, 250, 70],
  target_point: null,
  target_covariance_mm2: null,
  planned_targets: [],
  treatment_to_tip_offset: 10,
  robot_to_entry_offset: 5,
  cannula_to_treatment_offset: 5,
  canula_to_treatment_offset: 5,
  treatment_to_robot_at_home: 41,
  reported_position: null,
};
const aim = aimOf(targeting);
const typed = (into: Aim, name: AimName, ...text: string[]): Aim => ({
  ...into,
  [name]: text.reduce((draft, each, at) => withText(draft, at, each), into[name]),
});

describe("what is sent of entry, target and probe", () => {
  it("is nothing when nothing changed", () => {
    expect(aimChange(aim)).toBeNull();
    expect(aimChange(typed(aim, "entry_point", "8.0", "250", "70"))).toBeNull();
  });

  it("is what changed and nothing else", () => {
    const changed = typed(typed(aim, "target_point", "5", "200", "60,5"), "robot_to_entry_offset", "6");
    expect(changedGroups(changed)).toEqual(["target_point", "robot_to_entry_offset"]);
    expect(aimChange(changed)).toEqual({ target_point: [5, 200, 60.5], robot_to_entry_offset: 6 });
  });

  it("is nothing while a part of it is no number", () => {
    expect(aimChange(typed(aim, "target_point", "5", "200"))).toBeNull();
  });
});

describe("points that are planned", () => {
  it("are those of the fields, once both are points", () => {
    expect(pointsOf(aim)).toBeNull();
    expect(pointsOf(typed(aim, "target_point", "5", "200", "far"))).toBeNull();
    expect(pointsOf(typed(aim, "target_point", "5", "200", "60,5"))).toEqual({
      entry_point: [8, 250, 70],
      target_point: [5, 200, 60.5],
    });
  });

  it("fill the fields, to be sent where they are others", () => {
    const filled = withPoints(aim, { entry_point: [8, 250, 70], target_point: [1, 2, 3] });
    expect(aimChange(filled)).toEqual({ target_point: [1, 2, 3] });
  });
});

describe("what arrives", () => {
  it("changes what nobody edits beside what somebody does", () => {
    const edited = typed(aim, "entry_point", "9");
    const next = receivedAim(edited, { ...targeting, entry_point: [7, 7, 7], target_point: [1, 2, 3] });
    expect(next.target_point.text).toEqual(["1", "2", "3"]);
    expect(next.entry_point.text).toEqual(["9", "250", "70"]);
    expect(hasNews(next.entry_point)).toBe(true);
    expect(hasNews(next.target_point)).toBe(false);
  });

  it("is the same thing while it is the same", () => {
    expect(receivedAim(aim, { ...targeting })).toBe(aim);
  });
});

describe("aimProblems", () => {
  it("says what, where and what was expected, of what was edited alone", () => {
    expect(aimProblems(aim)).toEqual([]);
    expect(aimProblems(typed(aim, "target_point", "5", "far"))).toEqual([
      "Target, A: “far” is no number; expected -10000 to 10000 mm.",
      "Target, S: it is empty; expected -10000 to 10000 mm.",
    ]);
    expect(aimProblems(typed(aim, "treatment_to_robot_at_home", "1001"))).toEqual([
      "D: “1001” is too far; expected -1000 to 1000 mm.",
    ]);
  });
});

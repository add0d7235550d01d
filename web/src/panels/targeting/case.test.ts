import { describe, expect, it } from "vitest";
import type { Case, Targeting } from "../../api/client";
import { caseInHand, caseValues, caseWarnings, reasonOfCase } from "./case";

const closed = { number: 1, state: "closed", robot: "neuro", configuration_changed: false } as Case;
const open = { ...closed, number: 2, state: "open" as const };
const suspended = { ...open, state: "suspended" as const };

describe("the case in hand", () => {
  it("is the one that is not closed", () => {
    expect(caseInHand([])).toBeUndefined();
    expect(caseInHand([closed])).toBeUndefined();
    expect(caseInHand([open, closed])).toBe(open);
    expect(caseInHand([suspended, closed])).toBe(suspended);
  });

  it.each<[string | null, readonly Case[], string | null]>([
    ["Open a case first.", [closed], "neuro"],
    [null, [open, closed], "neuro"],
    ["Resume the case first.", [suspended], "neuro"],
    ["Resume the case first.", [suspended], null],
    ["Close the case of the other robot first.", [suspended], "prostate"],
  ])("%s", (reason, cases, robot) => {
    expect(reasonOfCase(cases, robot)).toBe(reason);
  });

  it("warns of another robot and of another configuration", () => {
    expect(caseWarnings(suspended, "neuro")).toEqual([]);
    expect(caseWarnings(suspended, "prostate")[0]).toContain("robot neuro; this robot is prostate");
    expect(caseWarnings({ ...suspended, configuration_changed: true }, "neuro")[0]).toContain(
      "configuration of the robot has changed",
    );
  });
});

describe("caseValues", () => {
  const targeting = {
    registration: [0, -1, 0, 10.5, 1, 0, 0, -20, 0, 0, 1, 30, 0, 0, 0, 1],
    ignore_registration_rotation: false,
    entry_point: [8, 250, 70],
    target_point: null,
    treatment_to_tip_offset: 10,
    robot_to_entry_offset: 5,
    cannula_to_treatment_offset: 5,
    treatment_to_robot_at_home: 41,
  } as Targeting;

  it("say what would be in force", () => {
    expect(caseValues(targeting).map(({ title, words }) => `${title}: ${words}`)).toEqual([
      "Registration: origin at 10.50, -20.00, 30.00, turned by 90.00°",
      "Entry: 8.00, 250.00, 70.00",
      "Target: not set",
      "A, tip to treatment: 10.00",
      "B, entry to robot: 5.00",
      "C, treatment to cannula: 5.00",
      "D, treatment to robot at home: 41.00",
    ]);
  });

  it("say when the rotation is ignored, and that there is no registration", () => {
    expect(caseValues({ ...targeting, ignore_registration_rotation: true })[0]?.words).toContain(
      "rotation ignored",
    );
    expect(caseValues({ ...targeting, registration: null })[0]?.words).toBe("not set");
  });
});

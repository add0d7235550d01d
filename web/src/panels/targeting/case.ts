/** Which case is in hand, and what it puts in force, in words. */
import type { Case, Targeting } from "../../api/client";
import { offsets, offsetTitles, points, pointTitles } from "./aim";
import { valueWords } from "./history";
import { list } from "./numbers";
import { originOf, turnBetween } from "./pose";

const STRAIGHT = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] as const;

/** The one that is not closed; there is at most one. */
export function caseInHand(cases: readonly Case[]): Case | undefined {
  return cases.find(({ state }) => state !== "closed");
}

/** Why registration, entry, target and probe cannot be set; null while a case is open. `robot`: null until its name is known. */
export function reasonOfCase(cases: readonly Case[], robot: string | null): string | null {
  const inHand = caseInHand(cases);
  if (inHand === undefined) return "Open a case first.";
  if (inHand.state === "open") return null;
  return isOfOtherRobot(inHand, robot)
    ? "Close the case of the other robot first."
    : "Resume the case first.";
}

export function isOfOtherRobot(shown: Case, robot: string | null): boolean {
  return robot !== null && shown.robot !== robot;
}

/** What to check before a suspended case is resumed. */
export function caseWarnings(shown: Case, robot: string | null): string[] {
  return [
    ...(isOfOtherRobot(shown, robot)
      ? [`The case was opened with the robot ${shown.robot}; this robot is ${robot}. Close the case.`]
      : []),
    ...(shown.configuration_changed
      ? [
          "The configuration of the robot has changed since the case was opened or last resumed. Check that the values below still hold.",
        ]
      : []),
  ];
}

export interface CaseValue {
  /** Name in the interface. */
  readonly field: string;
  readonly title: string;
  readonly words: string;
  /** What SetBy shows for a value that nobody set in this case. */
  readonly unset: string;
}

/** What the case puts in force. */
export function caseValues(targeting: Targeting): CaseValue[] {
  return [
    {
      field: "registration",
      title: "Registration",
      words: registrationWords(targeting),
      unset: "Not set yet.",
    },
    ...points.map((field) => ({
      field,
      title: pointTitles[field],
      words: valueWords(targeting[field]),
      unset: "Not set yet.",
    })),
    ...offsets.map((field) => ({
      field,
      title: `${offsetTitles[field].letter}, ${offsetTitles[field].way}`,
      words: valueWords(targeting[field]),
      unset: "As in the robot's file.",
    })),
  ];
}

function registrationWords({ registration, ignore_registration_rotation }: Targeting): string {
  if (registration === null) return "not set";
  const turn = ignore_registration_rotation
    ? "rotation ignored"
    : `turned by ${turnBetween(registration, STRAIGHT).toFixed(2)}°`;
  return `origin at ${list(originOf(registration), 2)}, ${turn}`;
}

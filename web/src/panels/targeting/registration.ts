/** The registration as it is edited: one group, since a matrix is right or wrong as a whole. */
import type { RegistrationChange, Targeting } from "../../api/client";
import { type Draft, isChanged, isEdited, numbersOf, type Values, valuesOf } from "./draft";
import { numberIn } from "./numbers";
import { columnNames, poseProblems, rowNames, upperRows, wholePose } from "./pose";

/** Behind the twelve numbers of the upper rows: whether the rotation is ignored, 1 or 0. */
export const IGNORES_AT = 12;

const NOT_SET: Values = Array.from({ length: IGNORES_AT }, () => null);

export function registrationValues(targeting: Targeting): Values {
  const { registration } = targeting;
  return [
    ...(registration === null ? NOT_SET : upperRows(registration)),
    targeting.ignore_registration_rotation ? 1 : 0,
  ];
}

export function ignoresRotation(draft: Draft): boolean {
  return draft.text[IGNORES_AT] === "1";
}

/** The draft with the numbers of a pose that was read, and everything else as it was. */
export function withPose(draft: Draft, pose: readonly number[]): Values {
  return [...upperRows(pose), ignoresRotation(draft) ? 1 : 0];
}

/** Why what was edited cannot be sent: what, where, what was expected. */
export function registrationProblems(draft: Draft): string[] {
  if (!isEdited(draft)) return [];
  const numbers = numbersOf(draft);
  if (numbers !== null) return poseProblems(wholePose(upperRows(numbers)));
  return valuesOf(draft).flatMap((value, at) =>
    value === null ? [elementProblem(draft.text[at] ?? "", at)] : [],
  );
}

function elementProblem(text: string, at: number): string {
  const what = text.trim() === "" ? "it is empty" : `“${text.trim()}” is no number`;
  return `Row ${rowNames[Math.floor(at / 4)]}, ${columnNames[at % 4]}: ${what}; expected one such as ${
    at % 4 === 3 ? "-12.5" : "0.7071"
  }.`;
}

/** What becomes of a registration that is not in force, or what to do about it. */
export const registrationAdvice: Readonly<Record<Targeting["registration_state"], string>> = {
  not_set: "",
  valid: "",
  suspended: "It is valid again once the case is resumed.",
  expired: "Set it again only if it still holds.",
};

/** Whether a text of the matrix means no number. */
export function isUnreadable(text: string): boolean {
  return numberIn(text) === null;
}

/** What to send; null when it is no rigid pose, or when nothing changed. What has expired may be set again as it is. */
export function registrationChange(draft: Draft, isValid: boolean): RegistrationChange | null {
  const numbers = numbersOf(draft);
  if (numbers === null || (isValid && !isChanged(draft)) || registrationProblems(draft).length > 0)
    return null;
  const ignores = numbers[IGNORES_AT] === 1;
  return {
    registration: wholePose(upperRows(numbers)),
    ignore_registration_rotation: ignores,
  };
}

/**
 * A group of values that an operator edits while the same values may arrive from elsewhere. A group is one thing: a point,
 * a matrix, an offset. What was edited is never overwritten by what arrives; what was not edited follows it.
 */
import { editable, numberIn } from "./numbers";

/** Null where nothing is set. */
export type Values = readonly (number | null)[];

export interface Draft {
  /** What the editing began from. */
  readonly base: Values;
  /** What the app told last. */
  readonly arrived: Values;
  readonly text: readonly string[];
}

export function draftOf(arrived: Values): Draft {
  return { base: arrived, arrived, text: arrived.map(editable) };
}

/** The group when the app tells these values. */
export function received(draft: Draft, arrived: Values): Draft {
  // What is typed stays as it is typed, even "1." on its way to "1.5".
  if (same(arrived, draft.arrived)) return draft;
  if (!isEdited(draft) || same(valuesOf(draft), arrived)) return draftOf(arrived);
  return { ...draft, arrived };
}

export function withText(draft: Draft, index: number, text: string): Draft {
  return { ...draft, text: draft.text.map((each, at) => (at === index ? text : each)) };
}

/** The group with values that were read somewhere, such as a file, in the place of what was typed. */
export function withValues(draft: Draft, values: Values): Draft {
  return { ...draft, text: values.map(editable) };
}

/** Gives up what was edited for what arrived. */
export function taken(draft: Draft): Draft {
  return draftOf(draft.arrived);
}

/** Stays with what was edited, knowing what arrived. */
export function kept(draft: Draft): Draft {
  return { ...draft, base: draft.arrived };
}

/** Whether the operator wrote anything but what was there. */
export function isEdited({ base, text }: Draft): boolean {
  return text.some((each, at) => !means(each, base[at] ?? null));
}

/** Whether something else arrived while the operator was editing, and nobody has looked at it yet. */
export function hasNews(draft: Draft): boolean {
  return isEdited(draft) && !same(draft.arrived, draft.base);
}

/** What the texts mean; null where they mean no number. What was not edited keeps the digits that are not shown. */
export function valuesOf({ base, text }: Draft): Values {
  return text.map((each, at) => {
    const was = base[at] ?? null;
    return means(each, was) ? was : numberIn(each);
  });
}

/** Every value, as numbers; null while one of them is none. */
export function numbersOf(draft: Draft): readonly number[] | null {
  const values = valuesOf(draft);
  return values.every((value) => value !== null) ? values : null;
}

/** Whether there is something to send: another thing than what the app has. */
export function isChanged(draft: Draft): boolean {
  return isEdited(draft) && !same(valuesOf(draft), draft.arrived);
}

export function same(one: Values, other: Values): boolean {
  return one.length === other.length && one.every((value, at) => value === other[at]);
}

function means(text: string, value: number | null): boolean {
  if (text.trim() === editable(value)) return true;
  return value !== null && numberIn(text) === value;
}

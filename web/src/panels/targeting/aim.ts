/** Entry, target and probe offsets as they are edited: each is a group of its own, and only those that changed are sent. */
import type { TargetChange, Targeting } from "../../api/client";
import {
  type Draft,
  draftOf,
  isChanged,
  isEdited,
  numbersOf,
  received,
  type Values,
  withValues,
} from "./draft";
import { numberIn } from "./numbers";
import { FARTHEST_MM, rowNames } from "./pose";

export const points = ["entry_point", "target_point"] as const;
export const offsets = [
  "treatment_to_tip_offset",
  "robot_to_entry_offset",
  "cannula_to_treatment_offset",
  "treatment_to_robot_at_home",
] as const;

export type PointName = (typeof points)[number];
export type OffsetName = (typeof offsets)[number];
export type AimName = PointName | OffsetName;

const names: readonly AimName[] = [...points, ...offsets];
const LARGEST_OFFSET_MM = 1000;

export const pointTitles: Readonly<Record<PointName, string>> = {
  entry_point: "Entry",
  target_point: "Target",
};

/** As the thesis letters them. */
export const offsetTitles: Readonly<Record<OffsetName, { readonly letter: string; readonly way: string }>> = {
  treatment_to_tip_offset: { letter: "A", way: "tip to treatment" },
  robot_to_entry_offset: { letter: "B", way: "entry to robot" },
  cannula_to_treatment_offset: { letter: "C", way: "treatment to cannula" },
  treatment_to_robot_at_home: { letter: "D", way: "treatment to robot at home" },
};

export function titleOf(name: AimName): string {
  return isPoint(name) ? pointTitles[name] : offsetTitles[name].letter;
}

export type Aim = Readonly<Record<AimName, Draft>>;

export function aimOf(targeting: Targeting): Aim {
  return mapped((name) => draftOf(valuesIn(targeting, name)));
}

export function receivedAim(aim: Aim, targeting: Targeting): Aim {
  const next = mapped((name) => received(aim[name], valuesIn(targeting, name)));
  return names.every((name) => next[name] === aim[name]) ? aim : next;
}

/** Entry and target as they stand in the fields; null while one of them is no point. */
export function pointsOf(aim: Aim): Readonly<Record<PointName, number[]>> | null {
  const [entry, target] = points.map((name) =>
    problemsOf(name, aim[name]).length > 0 ? null : numbersOf(aim[name]),
  );
  return entry && target ? { entry_point: [...entry], target_point: [...target] } : null;
}

/** With another entry and target in the fields, to be sent. */
export function withPoints(
  aim: Aim,
  { entry_point, target_point }: Readonly<Record<PointName, readonly number[]>>,
): Aim {
  return {
    ...aim,
    entry_point: withValues(aim.entry_point, entry_point),
    target_point: withValues(aim.target_point, target_point),
  };
}

/** The groups that have something to send. */
export function changedGroups(aim: Aim): readonly AimName[] {
  return names.filter((name) => isChanged(aim[name]));
}

/** What to send: what changed, and nothing else. Null while nothing did, or while something is no number. */
export function aimChange(aim: Aim): TargetChange | null {
  const change: TargetChange = {};
  for (const name of changedGroups(aim)) {
    const numbers = numbersOf(aim[name]);
    if (numbers === null) return null;
    if (isPoint(name)) change[name] = [...numbers];
    else change[name] = numbers[0] ?? 0;
  }
  return Object.keys(change).length === 0 ? null : change;
}

/** Why what was edited cannot be sent: what, where, what was expected. */
export function aimProblems(aim: Aim): string[] {
  return names.filter((name) => isEdited(aim[name])).flatMap((name) => problemsOf(name, aim[name]));
}

function problemsOf(name: AimName, { text }: Draft): string[] {
  const most = isPoint(name) ? FARTHEST_MM : LARGEST_OFFSET_MM;
  return text.flatMap((each, at) => {
    const value = numberIn(each);
    if (value !== null && Math.abs(value) <= most) return [];
    const where = isPoint(name) ? `${titleOf(name)}, ${rowNames[at]}` : titleOf(name);
    const what =
      each.trim() === ""
        ? "it is empty"
        : `“${each.trim()}” ${value === null ? "is no number" : "is too far"}`;
    return [`${where}: ${what}; expected ${-most} to ${most} mm.`];
  });
}

function isPoint(name: AimName): name is PointName {
  return (points as readonly AimName[]).includes(name);
}

function valuesIn(targeting: Targeting, name: AimName): Values {
  const value = targeting[name];
  if (value === null) return [null, null, null];
  return typeof value === "number" ? [value] : value;
}

function mapped(draft: (name: AimName) => Draft): Aim {
  return Object.fromEntries(names.map((name) => [name, draft(name)])) as Record<AimName, Draft>;
}

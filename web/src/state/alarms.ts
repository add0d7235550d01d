/**
 * Which conditions are alarms, and of what priority: IEC 60601-1-8, by how bad the harm is and how soon it comes. High: act
 * at once. Medium: act soon. What asks for nobody is no alarm: a lock after start, a refusal, a degraded clock.
 */
import type { Alarm } from "../api/client";
import { type CodeName, catalog, type Family } from "../generated/catalog";
import type { Freshness } from "./freshness";

export type AlarmPriority = Alarm["priority"];

/** Of a lock by its first cause, for as long as it is latched. */
const OF_CAUSE: Partial<Record<CodeName<"cause">, AlarmPriority>> = {
  ESTOP: "high",
  INTEGRITY: "high",
  RUNAWAY: "high",
  BUS: "medium",
  PEDAL: "medium",
  OVERRUN: "medium",
};

/** Of the mode; null when it is none. `cause` counts while the kernel is LOCKED. */
export function alarmOfMode(mode: string, cause: string): AlarmPriority | null {
  if (mode === "INIT") return "medium";
  return mode === "LOCKED" ? (OF_CAUSE[cause as CodeName<"cause">] ?? null) : null;
}

/** Of data that are too old to act by: whoever watches believes what is not so. */
export function alarmOfFreshness({ level }: Freshness): AlarmPriority | null {
  return level === "covered" ? "medium" : null;
}

/** In which family of the catalog the code of an alarm is; null when it is the app's own. */
export function familyOf(code: string): Family | null {
  const families = ["cause", "fault"] as const;
  return families.find((family) => catalog[family].some(({ name }) => name === code)) ?? null;
}

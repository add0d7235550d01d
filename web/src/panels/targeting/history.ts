/** What the history of the targeting says, in words. */
import type { TargetingHistory, TargetingOrigin } from "../../api/client";
import { type AimName, offsets, points, titleOf } from "./aim";
import { fixed, list } from "./numbers";
import { deviationOf, originOf, turnBetween } from "./pose";

type Change = TargetingHistory["changes"][number];

const POINT_DECIMALS = 2;

/** One line for each field that changed: what it is now, and what it was. */
export function changeWords({ old, new: set }: Pick<Change, "old" | "new">): string[] {
  return [
    ...registrationWords(old, set),
    ...[...points, ...offsets].flatMap((name) => aimWords(name, old, set)),
    ...(set.target_covariance_mm2 === undefined
      ? []
      : [`Covariance of the target: ${Array.isArray(set.target_covariance_mm2) ? "set" : "none"}`]),
    ...(Array.isArray(set.planned_targets) ? [`Planned targets: ${set.planned_targets.length}`] : []),
  ];
}

/** Fields of Targeting; the interface tells no types here. */
type Fields = Readonly<Partial<Record<AimName | RegistrationName, unknown>>>;
type RegistrationName =
  | "registration"
  | "registration_problem"
  | "ignore_registration_rotation"
  | "residual_mm"
  | "fiducials"
  | "fiducial_points"
  | "target_covariance_mm2"
  | "planned_targets";

function aimWords(name: AimName, old: Fields, set: Fields): string[] {
  const is = valueWords(set[name]);
  return set[name] === undefined ? [] : [`${titleOf(name)} ${is}, was ${valueWords(old[name])}`];
}

function registrationWords(old: Fields, set: Fields): string[] {
  const words: string[] = [];
  const [before, after] = [numbers(old.registration), numbers(set.registration)];
  if (after.length === 16) {
    const origin = `Registration with its origin at ${list(originOf(after), POINT_DECIMALS)}`;
    words.push(before.length === 16 ? `${origin}${against(before, after)}` : origin);
  }
  if (typeof set.registration_problem === "string") words.push(set.registration_problem);
  const ignores = set.ignore_registration_rotation;
  if (typeof ignores === "boolean")
    words.push(`Rotation of the registration ${ignores ? "ignored" : "used"}`);
  const fit = fitWords(set);
  if (fit !== "") words.push(fit);
  if (Array.isArray(set.fiducial_points))
    words.push(`Points of its fiducials: ${set.fiducial_points.length}`);
  return words;
}

/** How well a registration fits, as its sender said; empty where that is not known. */
export function fitWords({ residual_mm: residual, fiducials: count }: Fields): string {
  const parts = [
    ...(typeof residual === "number" ? [`residual ${fixed(residual, POINT_DECIMALS)} mm`] : []),
    ...(typeof count === "number" ? [`${count} fiducials`] : []),
  ];
  return parts.length === 0 ? "" : `Fit of the registration: ${parts.join(", ")}`;
}

function against(before: readonly number[], after: readonly number[]): string {
  const moved = fixed(deviationOf(after, before).distance_mm, POINT_DECIMALS);
  return `, moved by ${moved} mm, turned by ${fixed(turnBetween(after, before), 2)}°`;
}

export function valueWords(value: unknown): string {
  const found = typeof value === "number" ? [value] : numbers(value);
  return found.length === 0 ? "not set" : list(found, POINT_DECIMALS);
}

function numbers(value: unknown): number[] {
  return Array.isArray(value) ? value.filter((each) => typeof each === "number") : [];
}

const sources: Readonly<Record<TargetingOrigin["source"], string>> = {
  console: "console",
  openigtlink: "OpenIGTLink",
};

/** By which way it came, and from which address. */
export function sourceWords({ source, client }: Pick<TargetingOrigin, "source" | "client">): string {
  return `${sources[source]}, ${client.replace(/^openigtlink /, "")}`;
}

const STEPS = [
  { below: 60, unit: "s", per: 1 },
  { below: 3600, unit: "min", per: 60 },
  { below: 86_400, unit: "h", per: 3600 },
] as const;

/** How long ago a time was, both by the app's clock. */
export function ageWords(time: string, now: string): string {
  const seconds = Math.max(0, (Date.parse(now) - Date.parse(time)) / 1000);
  if (Number.isNaN(seconds)) return "at an unknown time";
  const step = STEPS.find(({ below }) => seconds < below);
  return step === undefined
    ? `${Math.floor(seconds / 86_400)} d ago`
    : `${Math.floor(seconds / step.per)} ${step.unit} ago`;
}

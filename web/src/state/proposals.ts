/** What can be told of a proposal without its panel. */
import type { Motor, Proposal, Robot } from "../api/client";
import type { AxisWish } from "../kernel/pageKernel";

const openStates: ReadonlySet<Proposal["state"]> = new Set([
  "drafted",
  "checked",
  "approved",
  "executing",
  "paused",
]);

const unapproved: ReadonlySet<Proposal["state"]> = new Set(["drafted", "checked"]);

export function isOpen(proposal: Proposal): boolean {
  return openStates.has(proposal.state);
}

/** The homing that is approved and has not ended, if there is one: until then moves are refused. */
export function openHoming(proposals: readonly Proposal[]): Proposal | undefined {
  return proposals.find(
    (proposal) => proposal.kind === "home" && isOpen(proposal) && !unapproved.has(proposal.state),
  );
}

/** The open motion of several axes, if there is one. */
export function openPath(proposals: readonly Proposal[]): Proposal | undefined {
  return proposals.find((proposal) => proposal.kind === "path" && isOpen(proposal));
}

export type HomingPart = "homing" | "waiting";

/** What an axis has to do in the homing that is open; null when nothing. */
export function homingPart(
  homing: Proposal | undefined,
  robot: Robot | null,
  motor: Motor,
): HomingPart | null {
  if (homing === undefined || !homing.axes.includes(motor.name)) return null;
  const step = robot?.home_steps.find((each) => each.name === homing.step);
  return step === undefined || step.axes.includes(motor.name) ? "homing" : "waiting";
}

export interface StepLine {
  readonly name: string;
  readonly title: string;
  readonly place: "before" | "now" | "after";
}

/** The home steps that an open homing goes through; none when it homes an axis by itself. */
export function homingSteps(homing: Proposal, robot: Robot): readonly StepLine[] {
  const now = robot.home_steps.findIndex((step) => step.name === homing.step);
  if (now < 0) return [];
  const steps = robot.home_steps.map((step, index) => ({
    name: step.name,
    title: step.title,
    place: index < now ? ("before" as const) : index === now ? ("now" as const) : ("after" as const),
    taken: step.axes.every((axis) => homing.axes.includes(axis)),
  }));
  return steps.filter((step) => step.taken).map(({ name, title, place }) => ({ name, title, place }));
}

/**
 * What a proposal will ask the kernel for, axis by axis: its move, where the axes of its path come to rest, or the homing
 * that its step begins with. Nothing of a sweep or a biopsy, which decide as they go.
 */
export function nextWishes(
  proposal: Proposal,
  motors: readonly Motor[],
  robot: Robot | null,
): { readonly motor: Motor; readonly wish: AxisWish }[] {
  const wishes = wishesOf(proposal, motors, robot);
  return motors.flatMap((motor) => {
    const wish = wishes.get(motor.slot);
    return wish === undefined ? [] : [{ motor, wish }];
  });
}

function wishesOf(proposal: Proposal, motors: readonly Motor[], robot: Robot | null): Map<number, AxisWish> {
  const { kind, slot, target_counts, ends = [] } = proposal;
  if (kind === "move" && slot !== null && target_counts !== null)
    return new Map([[slot, { kind: "MOVE", targetCounts: target_counts }]]);
  if (kind === "path")
    return new Map(ends.map((end) => [end.slot, { kind: "MOVE", targetCounts: end.target_counts }]));
  const step = robot?.home_steps.find(({ name }) => name === proposal.step);
  if (kind !== "home" || (step !== undefined && step.kind !== "home")) return new Map();
  const homing = motors.filter((motor) => homingPart(proposal, robot, motor) === "homing");
  return new Map(homing.map((motor) => [motor.slot, { kind: "HOME" }]));
}

/** Who may do what here, and the words for who may not. The app decides; the console only says so beforehand. */
import type { MotionControl, Role } from "../api/client";
import type { Login } from "./store";

/**
 * `viewer`: whoever is logged in. `holder`: an engineer whose session is in control. `setpoint`: that engineer, while the robot's mode leaves
 * the setpoints of single axes to the operator.
 */
export type Need = "viewer" | "engineer" | "admin" | "holder" | "setpoint";

export const needsControl = (need: Need): boolean => need === "holder" || need === "setpoint";

const rank: Record<Role, number> = { viewer: 0, engineer: 1, admin: 2 };

/** The one mode in which operators give setpoints axis by axis; in each other one an open proposal drives them. */
const OPERATORS_MODE = "manual";

/** Why the user may not do what needs `need`; null when nothing is against it. `mode`: of the robot, null when unknown. */
export function reasonAgainst(
  login: Login,
  control: MotionControl | null,
  mode: string | null,
  need: Need,
): string | null {
  if (login.phase !== "in") return "Log in first.";
  const role = need === "admin" || need === "viewer" ? need : "engineer";
  if (rank[login.user.role] < rank[role]) {
    const who = role === "admin" ? "only administrators" : "only engineers and administrators";
    return `You are logged in as ${login.user.role}: ${who} may do this.`;
  }
  if (!needsControl(need)) return null;
  const reason = reasonWithoutControl(login.user.name, control);
  return need === "holder" ? reason : (reason ?? reasonOfMode(mode));
}

/** Why whoever needs control may do nothing while a recording plays. */
export const REASON_OF_REPLAY = "A recording plays: there is nothing to move.";

/** Why no setpoint may be given by hand: the mode that drives them. Null when it is the operator's, or not known. */
export function reasonOfMode(mode: string | null): string | null {
  if (mode === null || mode === OPERATORS_MODE) return null;
  const words = mode.replaceAll("_", " ");
  return `The mode ${words} drives the setpoints: wait until it has ended, or abort its proposal.`;
}

function reasonWithoutControl(user: string, control: MotionControl | null): string | null {
  if (control === null) return "It is not known yet who is in control.";
  if (control.mine) return null;
  if (control.holder === null) return "Nobody is in control: take control.";
  if (control.holder.user === user) return "You are in control in another session: request control here.";
  return `${control.holder.user} is in control: request control.`;
}

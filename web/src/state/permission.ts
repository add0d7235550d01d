/** Who may do what here, and the words for who may not. The app decides; the console only says so beforehand. */
import type { Authority, Role } from "../api/client";
import type { Login } from "./store";

/** `holder`: an engineer whose session holds the motion authority. */
export type Need = "engineer" | "admin" | "holder";

const rank: Record<Role, number> = { viewer: 0, engineer: 1, admin: 2 };

/** Why the user may not do what needs `need`; null when nothing is against it. */
export function reasonAgainst(login: Login, authority: Authority | null, need: Need): string | null {
  if (login.phase !== "in") return "Log in first.";
  const role = need === "admin" ? "admin" : "engineer";
  if (rank[login.user.role] < rank[role]) {
    const who = role === "admin" ? "only administrators" : "only engineers and administrators";
    return `You are logged in as ${login.user.role}: ${who} may do this.`;
  }
  return need === "holder" ? reasonWithoutAuthority(login.user.name, authority) : null;
}

function reasonWithoutAuthority(user: string, authority: Authority | null): string | null {
  if (authority === null) return "Who holds the authority is not known yet.";
  if (authority.mine) return null;
  if (authority.holder === null) return "Nobody holds the authority: request it.";
  if (authority.holder.user === user) return "You hold the authority in another session: request it here.";
  return `${authority.holder.user} holds the authority: request it.`;
}

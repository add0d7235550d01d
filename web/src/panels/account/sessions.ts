/** The sessions of one user, of which the app lists everybody's to an administrator. */
import type { ListedSession } from "../../api/client";

/** Those of `user`: the one of this page first, then the newest. */
export function ownSessions(listed: readonly ListedSession[], user: string): readonly ListedSession[] {
  return listed
    .filter((each) => each.user === user)
    .sort((a, b) => Number(b.mine) - Number(a.mine) || b.session - a.session);
}

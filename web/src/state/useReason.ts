import { type Need, reasonAgainst } from "./permission";
import { useConsole } from "./store";

/** Why the user may not do what needs `need`; null when nothing is against it. */
export function useReason(need: Need): string | null {
  return useConsole((state) => reasonAgainst(state.login, state.authority, state.mode?.mode ?? null, need));
}

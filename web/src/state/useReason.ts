import { type Need, needsControl, REASON_OF_REPLAY, reasonAgainst } from "./permission";
import { useConsole } from "./store";

/** Why the user may not do what needs `need`; null when nothing is against it. */
export function useReason(need: Need): string | null {
  return useConsole((state) => {
    if (state.glance?.replay && needsControl(need)) return REASON_OF_REPLAY;
    return reasonAgainst(state.login, state.control, state.mode?.mode ?? null, need);
  });
}

import { api } from "../../api/client";
import { useConsole } from "../../state/store";
import { usePolled } from "../../state/usePolled";
import { reasonOfCase } from "./case";

const CASES_EVERY_MS = 1000;
const TARGETING_EVERY_MS = 500;
const ALIGNMENT_EVERY_MS = 250;
const HISTORY_EVERY_MS = 1000;

/** The cases, and what the case in hand sets, asks of the robot and has changed. */
export function useTargeting() {
  const robot = useConsole((state) => state.robot?.name ?? null);
  const cases = usePolled(api.listCases, CASES_EVERY_MS);
  const targeting = usePolled(api.targeting, TARGETING_EVERY_MS);
  const view = usePolled(api.alignment, ALIGNMENT_EVERY_MS);
  const history = usePolled(api.targetingHistory, HISTORY_EVERY_MS);
  return {
    cases,
    targeting,
    view,
    history,
    notice: cases.notice ?? targeting.notice ?? view.notice ?? history.notice,
    /** Why nothing can be set now; null while a case is open, and until the cases are known. */
    off: cases.value === null ? null : reasonOfCase(cases.value, robot),
    refresh: async (): Promise<void> => {
      await Promise.all([cases.refresh(), targeting.refresh(), view.refresh(), history.refresh()]);
    },
  };
}

import { useEffect, useState } from "react";
import { api, type Proposal, type ProposalPlan } from "../../api/client";
import { type Notice, noticeOfProblem } from "../../state/notice";

export interface Planned {
  readonly plan: ProposalPlan | null;
  /** Why there is none. */
  readonly notice: Notice | null;
}

const nothing: Planned = { plan: null, notice: null };

/** The plan of a proposal; asked for anew when the proposal says something else, as it is checked anew when approved. */
export function usePlan(proposal: Proposal | undefined): Planned {
  const id = proposal?.id;
  const state = proposal?.state;
  const detail = proposal?.detail;
  const [found, setFound] = useState<Planned>(nothing);
  useEffect(() => {
    if (id === undefined || state === undefined || detail === undefined) return undefined;
    let gone = false;
    void api.proposalPlan(id).then((outcome) => {
      if (gone) return;
      setFound(
        outcome.ok
          ? { plan: outcome.value, notice: null }
          : { plan: null, notice: noticeOfProblem(outcome.problem) },
      );
    });
    return () => {
      gone = true;
    };
  }, [id, state, detail]);
  return found.plan !== null && found.plan.id !== id ? nothing : found;
}

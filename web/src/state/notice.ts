/** What a refusal says to people: the code, what it means, what to do next. */
import type { Problem, Proposal } from "../api/client";
import { catalog, entry } from "../generated/catalog";

export interface Notice {
  readonly code: string;
  readonly meaning: string;
  readonly nextStep: string;
}

/** Whether the catalog has a verdict of that name. */
export function isVerdict(code: string): boolean {
  return catalog.verdict.some((verdict) => verdict.name === code);
}

/** The app's detail says what and where; the catalog says what the code means when the app does not. */
export function noticeOfProblem(problem: Problem): Notice {
  const text = isVerdict(problem.code) ? entry("verdict", problem.code) : null;
  const nextStep = problem.next_step ?? text?.next_step ?? "";
  const expected = problem.expected === undefined ? "" : ` Expected ${problem.expected}.`;
  const detail = problem.detail.replace(nextStep, "").trim() + expected;
  return { code: problem.code, meaning: joinOnce(text?.meaning ?? "", detail), nextStep };
}

/** Null unless the proposal was refused. */
export function noticeOfProposal(proposal: Proposal): Notice | null {
  if (proposal.state !== "refused") return null;
  return noticeOfProblem({ code: proposal.verdict ?? "REFUSED", detail: proposal.detail });
}

function joinOnce(meaning: string, detail: string): string {
  if (meaning === "" || detail.includes(meaning)) return detail;
  return detail === "" || meaning.includes(detail) ? meaning : `${meaning} ${detail}`;
}

/** How far a proposal has come. */
import type { Motor, Proposal, Robot } from "../../api/client";
import { homingSteps } from "../../state/proposals";
import { formatCounts } from "../../units/units";

export interface Progress {
  /** From 0 to 1. */
  readonly share: number;
  readonly words: string;
}

const begun: ReadonlySet<Proposal["state"]> = new Set(["executing", "paused", "done"]);

interface Seen {
  readonly motor: Motor | undefined;
  readonly robot: Robot | null;
  /** Of the axis of a move: where it was when the move was planned, and where it is. */
  readonly fromCounts: number | undefined;
  readonly nowCounts: number | undefined;
}

/** Null before it begins, where its progress has no measure, and once it has ended without being done. */
export function progressOf(proposal: Proposal, seen: Seen): Progress | null {
  if (!begun.has(proposal.state)) return null;
  if (proposal.state === "done") return { share: 1, words: "all of it" };
  if (proposal.kind === "path") return pathProgress(proposal);
  if (proposal.kind === "sweep") return sweepProgress(proposal);
  if (proposal.kind === "identify") return identifyProgress(proposal);
  if (proposal.kind === "home") return homeProgress(proposal, seen.robot);
  return proposal.kind === "move" ? moveProgress(proposal, seen) : null;
}

function pathProgress({ leg = 0, legs = 1 }: Proposal): Progress {
  return { share: leg / Math.max(1, legs), words: `part ${leg + 1} of ${legs}` };
}

function sweepProgress({ frequencies = [] }: Proposal): Progress {
  const over = frequencies.filter(({ counts_per_s }) => counts_per_s !== null).length;
  const all = frequencies.length;
  return { share: over / Math.max(1, all), words: `${over} of ${all} frequencies measured` };
}

/** At most so many drives are tried; the slowest motors stand at the last ones. */
const MOST_DRIVES = 20;

function identifyProgress({ measured }: Proposal): Progress {
  const over = measured?.speeds.length ?? 0;
  return { share: over / MOST_DRIVES, words: `${over} of at most ${MOST_DRIVES} drives measured` };
}

function homeProgress(proposal: Proposal, robot: Robot | null): Progress | null {
  const steps = robot === null ? [] : homingSteps(proposal, robot);
  const now = steps.findIndex(({ place }) => place === "now");
  const step = steps[now];
  if (step === undefined) return null;
  return { share: now / steps.length, words: `step ${now + 1} of ${steps.length}: ${step.title}` };
}

function moveProgress({ target_counts }: Proposal, { motor, fromCounts, nowCounts }: Seen): Progress | null {
  if (target_counts == null || fromCounts === undefined || nowCounts === undefined) return null;
  const way = target_counts - fromCounts;
  const share = way === 0 ? 1 : (nowCounts - fromCounts) / way;
  const left = Math.abs(target_counts - nowCounts);
  return {
    share: Math.min(1, Math.max(0, share)),
    words: `${motor === undefined ? `${left} counts` : formatCounts(motor, left)} left`,
  };
}

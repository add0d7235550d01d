/** From login to the first move, and how far the console's user has come. */
import type { Proposal } from "../../api/client";

export interface Situation {
  readonly mine: boolean;
  readonly mode: string;
  /** States of the axes. */
  readonly axes: readonly string[];
  readonly proposals: readonly Pick<Proposal, "state">[];
}

export interface Step {
  readonly title: string;
  readonly words: string;
  readonly isDone: (now: Situation) => boolean;
}

const off: ReadonlySet<string> = new Set(["DISABLED", "FAULTED"]);
const wanted: ReadonlySet<string> = new Set(["checked", "approved", "executing", "paused", "done"]);
const hasMoved = ({ proposals }: Situation): boolean => proposals.some(({ state }) => state === "done");

export const steps: readonly Step[] = [
  {
    title: "Take control",
    words: "at the top: one user at a time may move the robot.",
    isDone: ({ mine }) => mine,
  },
  {
    title: "Unlock",
    words: "beside the mode. After each start and each E-stop somebody has to.",
    isDone: ({ mode }) => mode === "READY" || mode === "MOTION",
  },
  {
    title: "Enable an axis",
    words: "in Motors. It holds where it stands.",
    isDone: ({ axes }) => axes.some((state) => !off.has(state)),
  },
  {
    title: "Propose a move",
    words: "drag the circle of that axis and let it go, or type a target. Nothing moves yet.",
    isDone: ({ proposals }) => proposals.some(({ state }) => wanted.has(state)),
  },
  {
    title: "Press the pedal and hold it",
    words: "The axis moves while you hold it. With simulated hardware the pedal is in Bench.",
    isDone: (now) => now.mode === "MOTION" || hasMoved(now),
  },
  {
    title: "Release the pedal",
    words: "when the move is done. STOP, or Esc anywhere, ends every motion at once.",
    isDone: (now) => now.mode !== "MOTION" && hasMoved(now),
  },
];

/** The step that is to be done now; how many there are when all are done. */
export function nextStep(now: Situation): number {
  const open = steps.findIndex(({ isDone }) => !isDone(now));
  return open === -1 ? steps.length : open;
}

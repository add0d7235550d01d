/** Everything the console knows. The stream and the answers of the app write it; panels only read it. */
import { create } from "zustand";
import type { Motor, Proposal, Status } from "../api/client";
import type { Phase } from "../stream/connection";
import type { Frame } from "../stream/decode";
import { type Freshness, judgeFreshness } from "./freshness";
import { type Notice, noticeOfProposal } from "./notice";

export type StopReport =
  | { readonly phase: "idle" | "sending" }
  | { readonly phase: "answered"; readonly verdict: string | null }
  | { readonly phase: "unanswered" };

export interface ConsoleState {
  readonly phase: Phase;
  readonly frame: Frame | null;
  readonly arrivedAtMs: number;
  readonly frameError: string | null;
  readonly freshness: Freshness;
  readonly status: Status | null;
  readonly motors: readonly Motor[];
  /** Newest first. */
  readonly proposals: readonly Proposal[];
  /** Refusals by slot, until dismissed or followed by an accepted request. */
  readonly notices: Readonly<Record<number, Notice>>;
  readonly unlockNotice: Notice | null;
  /** The bench command that was refused last; goes when the same command is accepted. */
  readonly benchRefusal: { readonly command: string; readonly notice: Notice } | null;
  readonly stop: StopReport;
  /** Grows with every STOP; previews that began before it are dropped. */
  readonly stops: number;
}

export const MOST_PROPOSALS = 200;

export const initialState: ConsoleState = {
  phase: "connecting",
  frame: null,
  arrivedAtMs: 0,
  frameError: null,
  freshness: { level: "covered", ageMs: null, reason: "no-app" },
  status: null,
  motors: [],
  proposals: [],
  notices: {},
  unlockNotice: null,
  benchRefusal: null,
  stop: { phase: "idle" },
  stops: 0,
};

export const useConsole = create<ConsoleState>(() => initialState);

/** Takes in a decoded message that arrived at `nowMs`. */
export function withFrame(state: ConsoleState, frame: Frame, nowMs: number): Partial<ConsoleState> {
  const evidence = { phase: state.phase, frame, arrivedAtMs: nowMs, frameError: null };
  const unlocked = frame.mode !== "LOCKED";
  return {
    frame,
    arrivedAtMs: nowMs,
    frameError: null,
    freshness: judgeFreshness(evidence, nowMs),
    ...(unlocked && state.unlockNotice !== null ? { unlockNotice: null } : {}),
  };
}

/** Notes that a message could not be understood; what is shown is then covered. */
export function withFrameError(
  state: ConsoleState,
  frameError: string,
  nowMs: number,
): Partial<ConsoleState> {
  return { frameError, freshness: judgeFreshness({ ...state, frameError }, nowMs) };
}

/** Lets the data grow older. */
export function withTime(state: ConsoleState, nowMs: number): Partial<ConsoleState> {
  return { freshness: judgeFreshness(state, nowMs) };
}

/** Takes in a new version of a proposal, and shows its refusal at the axis. */
export function withProposal(state: ConsoleState, proposal: Proposal): Partial<ConsoleState> {
  const notice = noticeOfProposal(proposal);
  return {
    proposals: mergeProposals([proposal], state.proposals),
    ...(notice === null ? {} : { notices: { ...state.notices, [proposal.slot]: notice } }),
  };
}

/** Both lists by falling id; where both hold one, that of `newer` counts. */
export function mergeProposals(newer: readonly Proposal[], older: readonly Proposal[]): Proposal[] {
  const byId = new Map([...older, ...newer].map((proposal) => [proposal.id, proposal]));
  return [...byId.values()].sort((a, b) => b.id - a.id).slice(0, MOST_PROPOSALS);
}

/** Sets or, with null, removes the notice of an axis. */
export function withNotice(state: ConsoleState, slot: number, notice: Notice | null): Partial<ConsoleState> {
  const { [slot]: _, ...others } = state.notices;
  return { notices: notice === null ? others : { ...others, [slot]: notice } };
}

/** Takes in the answer to a bench command; an accepted one clears no other command's refusal. */
export function withBenchAnswer(
  state: ConsoleState,
  command: string,
  notice: Notice | null,
): Partial<ConsoleState> {
  if (notice !== null) return { benchRefusal: { command, notice } };
  return state.benchRefusal?.command === command ? { benchRefusal: null } : {};
}

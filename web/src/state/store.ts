/** Everything the console knows. The stream and the answers of the app write it; panels only read it. */
import { create } from "zustand";
import type {
  Alarm,
  Holds,
  LogLevel,
  LogLine,
  ModeAnswer,
  MotionControl,
  Motor,
  Proposal,
  Robot,
  Status,
  User,
} from "../api/client";
import type { ConfiguredKernel } from "../kernel/asking";
import type { Phase } from "../stream/connection";
import type { Frame, Glance } from "../stream/decode";
import { type Freshness, judgeFreshness, polled, streamed } from "./freshness";
import { glanceOf } from "./glance";
import { type Notice, noticeOfProposal } from "./notice";

export type StopReport =
  | { readonly phase: "idle" | "sending" }
  | { readonly phase: "answered"; readonly verdict: string | null }
  | { readonly phase: "unanswered" };

export type Login =
  /** The app was not asked yet, or has not answered. */
  | { readonly phase: "unknown" }
  /** `notice`: why the session ended; null when nobody is to blame. */
  | { readonly phase: "out"; readonly notice: Notice | null }
  | { readonly phase: "in"; readonly user: User; readonly session: number };

/** Where a refusal is shown: at the axis of a slot, or where it was asked for. */
export type Place = number | "robot" | "mode";

export interface ConsoleState {
  readonly login: Login;
  readonly phase: Phase;
  /** What the header shows: of the newest frame, or of the public status while nobody is logged in. */
  readonly glance: Glance | null;
  readonly frame: Frame | null;
  readonly arrivedAtMs: number;
  readonly frameError: string | null;
  readonly freshness: Freshness;
  /** The clock by which ages are shown. */
  readonly nowMs: number;
  readonly status: Status | null;
  readonly statusAtMs: number | null;
  readonly robot: Robot | null;
  readonly motors: readonly Motor[];
  /** The kernel in the page; null until it is loaded, and where it cannot be. */
  readonly pageKernel: ConfiguredKernel | null;
  readonly mode: ModeAnswer | null;
  readonly control: MotionControl | null;
  /** What asks somebody to act, the worst first. */
  readonly alarms: readonly Alarm[];
  /** What holds motion still from outside, as it was at `holdsAtMs`; null until the app has said it. */
  readonly holds: Holds | null;
  readonly holdsAtMs: number;
  /** Why control did not change hands as asked. */
  readonly controlNotice: Notice | null;
  /** Newest first. */
  readonly proposals: readonly Proposal[];
  /** Oldest first. */
  readonly log: readonly LogLine[];
  readonly logLevel: LogLevel | null;
  /** Refusals by place, until dismissed or followed by an accepted request. */
  readonly notices: Readonly<Partial<Record<Place, Notice>>>;
  readonly unlockNotice: Notice | null;
  /** The bench command that was refused last; goes when the same command is accepted. */
  readonly benchRefusal: { readonly command: string; readonly notice: Notice } | null;
  readonly stop: StopReport;
  /** Grows with every STOP; previews that began before it are dropped. */
  readonly stops: number;
  /** Grows with every Set Home, Zero all, Load and Undo that this page sent: what can be undone is another thing then. */
  readonly declarations: number;
  /** Whether the user arranges the panels of the robot's page. */
  readonly arranging: boolean;
  /** Whether the walk-through of the first move is shown. */
  readonly firstSteps: boolean;
}

export const MOST_PROPOSALS = 200;

export const initialState: ConsoleState = {
  login: { phase: "unknown" },
  phase: "connecting",
  glance: null,
  frame: null,
  arrivedAtMs: 0,
  frameError: null,
  freshness: { level: "covered", ageMs: null, reason: "no-app" },
  nowMs: 0,
  status: null,
  statusAtMs: null,
  robot: null,
  motors: [],
  pageKernel: null,
  mode: null,
  control: null,
  alarms: [],
  holds: null,
  holdsAtMs: 0,
  controlNotice: null,
  proposals: [],
  log: [],
  logLevel: null,
  notices: {},
  unlockNotice: null,
  benchRefusal: null,
  stop: { phase: "idle" },
  stops: 0,
  declarations: 0,
  arranging: false,
  firstSteps: false,
};

export const useConsole = create<ConsoleState>(() => initialState);

/** Opens the console for a user. */
export function withLogin(user: User, session: number): Partial<ConsoleState> {
  return { login: { phase: "in", user, session }, phase: "connecting" };
}

/** Forgets everything that a user saw, and keeps what everybody may see. */
export function withLogout(state: ConsoleState, notice: Notice | null): ConsoleState {
  const { glance, arrivedAtMs, freshness, nowMs, status, statusAtMs, stop, stops } = state;
  return {
    ...initialState,
    ...{ glance, arrivedAtMs, freshness, nowMs, status, statusAtMs, stop, stops },
    login: { phase: "out", notice },
  };
}

/** Takes in a decoded message that arrived at `nowMs`. */
export function withFrame(state: ConsoleState, frame: Frame, nowMs: number): Partial<ConsoleState> {
  const evidence = { phase: state.phase, glance: frame, arrivedAtMs: nowMs, frameError: null };
  const unlocked = frame.mode !== "LOCKED";
  return {
    glance: frame,
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

/** Takes in the public status, which is all that there is without login. */
export function withStatus(state: ConsoleState, status: Status, nowMs: number): Partial<ConsoleState> {
  const known = { status, statusAtMs: nowMs };
  if (state.login.phase === "in") return known;
  const glance = glanceOf(status);
  const evidence = { phase: "open", glance, arrivedAtMs: nowMs, frameError: null } as const;
  return { ...known, ...evidence, freshness: judgeFreshness(evidence, nowMs, polled) };
}

/** Lets the data grow older. */
export function withTime(state: ConsoleState, nowMs: number): Partial<ConsoleState> {
  const patience = state.login.phase === "in" ? streamed : polled;
  return { nowMs, freshness: judgeFreshness(state, nowMs, patience) };
}

/** Takes in a new version of a proposal, and shows its refusal where it belongs. */
export function withProposal(state: ConsoleState, proposal: Proposal): Partial<ConsoleState> {
  const notice = noticeOfProposal(proposal);
  return {
    proposals: mergeProposals([proposal], state.proposals),
    ...(notice === null ? {} : withNotice(state, proposal.slot ?? "robot", notice)),
  };
}

/** Both lists by falling id; where both hold one, that of `newer` counts. */
export function mergeProposals(newer: readonly Proposal[], older: readonly Proposal[]): Proposal[] {
  const byId = new Map([...older, ...newer].map((proposal) => [proposal.id, proposal]));
  return [...byId.values()].sort((a, b) => b.id - a.id).slice(0, MOST_PROPOSALS);
}

/** Sets or, with null, removes the notice of a place. */
export function withNotice(state: ConsoleState, place: Place, notice: Notice | null): Partial<ConsoleState> {
  const { [place]: _, ...others } = state.notices;
  return { notices: notice === null ? others : { ...others, [place]: notice } };
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

/** Feeds the store: session, stream, what the app knows that the stream does not carry, and the passing of time. */
import { api, onLoggedOut, type Session } from "../api/client";
import { kernelWith } from "../kernel/asking";
import { openStream, type Phase, type Stream } from "../stream/connection";
import { decodeFrame, FrameError } from "../stream/decode";
import { announceAlarms } from "./announce";
import { untilWorseMs } from "./freshness";
import { MOST_LINES, mergeLines } from "./log";
import { type StreamMessage, streamMessage } from "./messages";
import type { Notice } from "./notice";
import {
  mergeProposals,
  useConsole,
  withFrame,
  withFrameError,
  withLogin,
  withLogout,
  withProposal,
  withStatus,
  withTime,
} from "./store";

const TIME_STEP_MS = 100;
const STATUS_EVERY_MS = 1000;
const RETRY_PAUSE_MS = 1000;

export const sessionEnded: Notice = {
  code: "LOGIN",
  meaning: "Your session ended: it was 12 hours old, or your password, role or right to log in was changed.",
  nextStep: "Log in again.",
};

/** Starts feeding the store, for as long as the page is there. */
export function startFeed(): void {
  setInterval(passTime, TIME_STEP_MS);
  announceAlarms();
  onLoggedOut(() => leave(sessionEnded));
  void findSession();
  void keepStatus();
}

let worsening: ReturnType<typeof setTimeout> | undefined;

function passTime(): void {
  useConsole.setState((state) => withTime(state, performance.now()));
}

/** Judges the data again just when they will be too old to be shown as they are, unless newer ones come before. */
function awaitWorsening(): void {
  clearTimeout(worsening);
  const waitMs = untilWorseMs(useConsole.getState().freshness);
  if (waitMs === null) return;
  worsening = setTimeout(() => {
    passTime();
    awaitWorsening();
  }, waitMs + 1);
}

let reload: ReturnType<typeof setTimeout> | undefined;
let describedConfigCrc: string | null = null;
let stream: Stream | null = null;

/** Asks who is logged in here until the app answers. */
async function findSession(): Promise<void> {
  const session = await api.session();
  if (!session.ok) setTimeout(() => void findSession(), RETRY_PAUSE_MS);
  else if (!enter(session.value)) leave(null);
}

/** Opens the console for the session's user; false when it has none. */
export function enter({ user, session }: Session): boolean {
  if (user === null || session == null) return false;
  stream?.close();
  describedConfigCrc = null;
  useConsole.setState(withLogin(user, session));
  const scheme = location.protocol === "https:" ? "wss" : "ws";
  stream = openStream(`${scheme}://${location.host}/api/stream`, {
    onBinary,
    onText,
    onPhase,
    onSessionEnded: () => leave(sessionEnded),
  });
  return true;
}

/** Asks for a STOP over the stream, which a browser holds back behind no other request. */
export function stopByStream(): void {
  stream?.stop();
}

/** Back to the login page, with the reason when there is one. */
export function leave(notice: Notice | null): void {
  stream?.close();
  clearTimeout(reload);
  if (useConsole.getState().login.phase === "out") return;
  useConsole.setState((state) => withLogout(state, notice));
}

/** The public status once a second: all of the header without login, and the cards with it. */
async function keepStatus(): Promise<void> {
  const status = await api.status();
  if (status.ok) useConsole.setState((state) => withStatus(state, status.value, performance.now()));
  else if (useConsole.getState().login.phase !== "in") useConsole.setState({ phase: "lost" });
  setTimeout(() => void keepStatus(), STATUS_EVERY_MS);
}

function onPhase(phase: Phase): void {
  useConsole.setState({ phase });
  if (phase === "open") void loadDescription();
  if (phase === "lost") void checkSession();
}

/** A browser does not tell why a stream was not opened; a session that ended is one reason. */
async function checkSession(): Promise<void> {
  const session = await api.session();
  if (session.ok && session.value.user === null) leave(sessionEnded);
}

function onBinary(message: ArrayBuffer): void {
  const nowMs = performance.now();
  try {
    const frame = decodeFrame(message);
    useConsole.setState((state) => withFrame(state, frame, nowMs));
    awaitWorsening();
    if (frame.connected && frame.configCrc !== (describedConfigCrc ?? frame.configCrc))
      void loadDescription();
  } catch (error) {
    if (!(error instanceof FrameError)) throw error;
    useConsole.setState((state) => withFrameError(state, error.message, nowMs));
  }
}

function onText(text: string): void {
  const message = streamMessage(text);
  if (message !== null) takeIn(message);
}

function takeIn(message: StreamMessage): void {
  switch (message.type) {
    case "proposal":
      useConsole.setState((state) => withProposal(state, message));
      break;
    case "control":
      useConsole.setState({ control: message, controlNotice: null });
      break;
    case "mode":
      useConsole.setState({ mode: message });
      break;
    case "alarms":
      useConsole.setState({ alarms: message.alarms });
      break;
    case "holds":
      useConsole.setState({ holds: message, holdsAtMs: performance.now() });
      break;
    case "log":
      useConsole.setState((state) => ({ log: mergeLines(state.log, [message]) }));
      break;
    case "session":
      leave(sessionEnded);
      break;
  }
}

/** What the stream tells only when it changes; again a little later while the app cannot tell. */
async function loadDescription(): Promise<void> {
  clearTimeout(reload);
  describedConfigCrc = null;
  const before = useConsole.getState();
  const [robots, motors, configuration, mode, control, alarms, holds, logs, proposals] = await Promise.all([
    api.robots(),
    api.motors(),
    api.kernelConfiguration(),
    api.mode(),
    api.control(),
    api.alarms(),
    api.holds(),
    api.logs(MOST_LINES),
    api.proposals(),
  ]);
  if (useConsole.getState().login.phase !== "in") return;
  const robot = robots.ok ? robots.value[0] : undefined;
  if (robot !== undefined) useConsole.setState({ robot });
  if (motors.ok) useConsole.setState({ motors: motors.value });
  const pageKernel = configuration.ok ? await kernelWith(configuration.value) : null;
  if (useConsole.getState().login.phase !== "in") return;
  useConsole.setState({ pageKernel });
  // What the stream told meanwhile is newer than the answer.
  const { mode: newestMode, control: newestControl } = useConsole.getState();
  if (mode.ok && newestMode === before.mode) useConsole.setState({ mode: mode.value });
  if (control.ok && newestControl === before.control) useConsole.setState({ control: control.value });
  if (alarms.ok && useConsole.getState().alarms === before.alarms)
    useConsole.setState({ alarms: alarms.value.alarms });
  if (holds.ok && useConsole.getState().holds === before.holds)
    useConsole.setState({ holds: holds.value, holdsAtMs: performance.now() });
  if (logs.ok) {
    useConsole.setState((state) => ({
      log: mergeLines(newSince(before.log, state.log), logs.value.lines),
      logLevel: logs.value.level,
    }));
  }
  if (proposals.ok) {
    useConsole.setState((state) => ({
      proposals: mergeProposals(newSince(before.proposals, state.proposals), proposals.value),
    }));
  }
  const complete =
    robots.ok &&
    motors.ok &&
    configuration.ok &&
    mode.ok &&
    control.ok &&
    holds.ok &&
    logs.ok &&
    proposals.ok;
  if (complete) describedConfigCrc = useConsole.getState().frame?.configCrc ?? null;
  else reload = setTimeout(() => void loadDescription(), RETRY_PAUSE_MS);
}

function newSince<Item>(before: readonly Item[], now: readonly Item[]): Item[] {
  return now.filter((item) => !before.includes(item));
}

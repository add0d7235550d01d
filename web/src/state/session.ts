/** Feeds the store: the stream, what the app knows that the stream does not carry, and the passing of time. */
import { api, type Proposal } from "../api/client";
import { openStream, type Phase } from "../stream/connection";
import { decodeFrame, FrameError } from "../stream/decode";
import { mergeProposals, useConsole, withFrame, withFrameError, withProposal, withTime } from "./store";

const TIME_STEP_MS = 100;
const RELOAD_PAUSE_MS = 1000;

/** Starts feeding the store. Returns the function that ends it. */
export function startSession(): () => void {
  const scheme = location.protocol === "https:" ? "wss" : "ws";
  const closeStream = openStream(`${scheme}://${location.host}/api/stream`, { onBinary, onText, onPhase });
  const clock = setInterval(
    () => useConsole.setState((state) => withTime(state, performance.now())),
    TIME_STEP_MS,
  );
  return () => {
    clearInterval(clock);
    clearTimeout(reload);
    closeStream();
  };
}

let reload: ReturnType<typeof setTimeout> | undefined;
let describedConfigCrc: string | null = null;

function onPhase(phase: Phase): void {
  useConsole.setState({ phase });
  if (phase === "open") void loadDescription();
}

function onBinary(message: ArrayBuffer): void {
  const nowMs = performance.now();
  try {
    const frame = decodeFrame(message);
    useConsole.setState((state) => withFrame(state, frame, nowMs));
    if (frame.connected && frame.configCrc !== (describedConfigCrc ?? frame.configCrc))
      void loadDescription();
  } catch (error) {
    if (!(error instanceof FrameError)) throw error;
    useConsole.setState((state) => withFrameError(state, error.message, nowMs));
  }
}

function onText(text: string): void {
  const message: unknown = JSON.parse(text);
  if (isProposalMessage(message)) useConsole.setState((state) => withProposal(state, message));
}

function isProposalMessage(message: unknown): message is Proposal & { type: "proposal" } {
  return typeof message === "object" && message !== null && "type" in message && message.type === "proposal";
}

/** Robot, axes and proposals; again a little later while the app cannot tell. */
async function loadDescription(): Promise<void> {
  clearTimeout(reload);
  describedConfigCrc = null;
  const before = useConsole.getState().proposals;
  const [status, motors, proposals] = await Promise.all([api.status(), api.motors(), api.proposals()]);
  if (status.ok) useConsole.setState({ status: status.value });
  if (motors.ok) useConsole.setState({ motors: motors.value });
  if (proposals.ok) {
    useConsole.setState((state) => {
      const streamedMeanwhile = state.proposals.filter((proposal) => !before.includes(proposal));
      return { proposals: mergeProposals(streamedMeanwhile, proposals.value) };
    });
  }
  if (status.ok && motors.ok && proposals.ok)
    describedConfigCrc = useConsole.getState().frame?.configCrc ?? null;
  else reload = setTimeout(() => void loadDescription(), RELOAD_PAUSE_MS);
}

/** What a click does: one call to the app, its answer into the store. */
import { type AxisAction, api, type ProposalDraft } from "../api/client";
import { type Notice, noticeOfProblem } from "./notice";
import { useConsole, withBenchAnswer, withNotice } from "./store";

/** Sends STOP at once, whatever else is going on, and drops every preview. */
export async function stop(): Promise<void> {
  useConsole.setState((state) => ({ stops: state.stops + 1, stop: { phase: "sending" } }));
  const number = useConsole.getState().stops;
  const outcome = await api.stop();
  if (useConsole.getState().stops !== number) return;
  useConsole.setState({
    stop: outcome.ok ? { phase: "answered", verdict: outcome.value.verdict } : { phase: "unanswered" },
  });
}

/** Asks for LOCKED to READY; a refusal is shown in the header. */
export async function unlock(): Promise<void> {
  const outcome = await api.reset();
  useConsole.setState({ unlockNotice: outcome.ok ? null : noticeOfProblem(outcome.problem) });
}

/** Sends one request for an axis; a refusal is shown at the axis. */
export async function act(slot: number, action: AxisAction): Promise<void> {
  const outcome = await api.act(slot, action);
  const notice = outcome.ok ? null : noticeOfProblem(outcome.problem);
  useConsole.setState((state) => withNotice(state, slot, notice));
}

/** Proposes a move; a refusal is shown at the axis, the proposal itself comes by the stream. */
export async function propose(draft: ProposalDraft): Promise<void> {
  const outcome = await api.propose(draft);
  const notice = outcome.ok ? null : noticeOfProblem(outcome.problem);
  useConsole.setState((state) => withNotice(state, draft.slot, notice));
}

/** Ends an open proposal; a refusal is shown at its axis. */
export async function abort(id: number, slot: number): Promise<void> {
  const outcome = await api.abort(id);
  const notice = outcome.ok ? null : noticeOfProblem(outcome.problem);
  useConsole.setState((state) => withNotice(state, slot, notice));
}

/**
 * Passes a command of models/plant/README.md to the simulated hardware; a refusal is shown at the bench.
 * Returns whether it was accepted.
 */
export async function bench(command: string, fields: Record<string, unknown>): Promise<boolean> {
  const outcome = await api.benchCommand(command, fields);
  const notice = outcome.ok ? null : noticeOfProblem(outcome.problem);
  useConsole.setState((state) => withBenchAnswer(state, command, notice));
  return outcome.ok;
}

/** Shows at the bench that the pedal came up by itself, or no longer shows it. */
export function showPedalLapse(shown: boolean): void {
  useConsole.setState((state) => withBenchAnswer(state, "pedal hold", shown ? pedalLapse : null));
}

const pedalLapse: Notice = {
  code: "LATE",
  meaning: "The pedal came up because its hold was not renewed in time.",
  nextStep: "Press it again.",
};

export function dismissNotice(slot: number): void {
  useConsole.setState((state) => withNotice(state, slot, null));
}

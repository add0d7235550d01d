/** What a click does: one call to the app, its answer into the store. */
import { type AxisAction, api, type ProposalDraft } from "../api/client";
import { noticeOfProblem } from "./notice";
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

/** Passes a command of models/plant/README.md to the simulated hardware; a refusal is shown at the bench. */
export async function bench(command: string, fields: Record<string, unknown>): Promise<void> {
  const outcome = await api.benchCommand(command, fields);
  const notice = outcome.ok ? null : noticeOfProblem(outcome.problem);
  useConsole.setState((state) => withBenchAnswer(state, command, notice));
}

const pedalFields = {
  press: { pressed: true },
  renew: { pressed: true, renew: true },
  release: { pressed: false },
} as const;

/** Moves the simulated pedal. The refusal of a renewal stays in sight until the next press. */
export async function movePedal(footwork: keyof typeof pedalFields): Promise<boolean> {
  const outcome = await api.benchCommand("pedal", pedalFields[footwork]);
  const notice = outcome.ok ? null : noticeOfProblem(outcome.problem);
  if (footwork === "press" || notice !== null) {
    useConsole.setState((state) => withBenchAnswer(state, "pedal", notice));
  }
  return outcome.ok;
}

export function dismissNotice(slot: number): void {
  useConsole.setState((state) => withNotice(state, slot, null));
}

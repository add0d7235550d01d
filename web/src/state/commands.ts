/** What a click does: one call to the app, its answer into the store. */
import {
  type AxisAction,
  api,
  type JogDirection,
  type MotionControl,
  type Motor,
  type Outcome,
  type ProposalDraft,
} from "../api/client";
import { leave, stopByStream } from "./feed";
import type { HoldStep, SendStep } from "./hold";
import { noticeOfProblem } from "./notice";
import { type Place, useConsole, withBenchAnswer, withNotice } from "./store";

/** Sends STOP at once, whatever else is going on, and drops every preview. */
export async function stop(): Promise<void> {
  useConsole.setState((state) => ({ stops: state.stops + 1, stop: { phase: "sending" } }));
  const number = useConsole.getState().stops;
  stopByStream();
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

/** Ends the session. When the app does not answer, the session goes on and the header says so. */
export async function logout(): Promise<void> {
  const outcome = await api.logout();
  if (outcome.ok) leave(null);
  else useConsole.setState({ controlNotice: noticeOfProblem(outcome.problem) });
}

/** Requests, releases, hands over or takes control; a refusal is shown in the header. */
export async function changeControl(ask: () => Promise<Outcome<MotionControl>>): Promise<void> {
  const outcome = await ask();
  if (outcome.ok) useConsole.setState({ control: outcome.value, controlNotice: null });
  else useConsole.setState({ controlNotice: noticeOfProblem(outcome.problem) });
}

/** Sends one request for an axis; a refusal is shown at the axis. */
export async function act(slot: number, action: AxisAction): Promise<void> {
  tell(slot, await api.act(slot, action));
}

/** Declares that an axis stands at home, whatever its switch says if it has one; a refusal is shown at the axis. */
export async function setHome({ slot, has_switch }: Motor): Promise<void> {
  const ask = () => (has_switch ? api.setHomeAgainstSwitch(slot) : api.act(slot, "set-home"));
  tell(slot, await declare(ask));
}

/** Sends what gives axes another position without a motion. Whatever shows what can be undone asks anew. */
export async function declare<Value>(ask: () => Promise<Outcome<Value>>): Promise<Outcome<Value>> {
  const outcome = await ask();
  useConsole.setState(({ declarations }) => ({ declarations: declarations + 1 }));
  return outcome;
}

/** Proposes a move or homing; a refusal is shown where it belongs, the proposal itself comes by the stream. */
export async function propose(draft: ProposalDraft): Promise<void> {
  tell(draft.slot ?? "robot", await api.propose(draft));
}

/** Ends an open proposal; a refusal is shown where it belongs. */
export async function abort(id: number, slot: number | null): Promise<void> {
  tell(slot ?? "robot", await api.abort(id));
}

/** One jog of an axis: begins, renews and ends it; a refusal is shown at the axis. */
export function jogger(slot: number, direction: JogDirection): SendStep {
  let id: number | null = null;
  return async (step) => {
    if (step === "press") {
      const begun = await api.beginJog({ slot, direction });
      id = begun.ok ? begun.value.id : null;
      tell(slot, begun);
      return begun.ok;
    }
    if (id === null) return false;
    if (step === "renew") return (await api.renewJog(id)).ok;
    const ended = id;
    id = null;
    // A jog that came to its end, or that the app has ended, needs no end.
    return (await api.abort(ended)).ok;
  };
}

/** For so long power may take to come up, and axes to settle. */
const READY_WITHIN_MS = 10_000;
const LOOK_AGAIN_MS = 50;

/** Waits until something holds. False when it did not in time, or when somebody pressed STOP meanwhile. */
function settling(): (holds: () => boolean | Promise<boolean>) => Promise<boolean> {
  const { stops } = useConsole.getState();
  const untilMs = performance.now() + READY_WITHIN_MS;
  return async (holds) => {
    for (;;) {
      if (useConsole.getState().stops !== stops) return false;
      if (await holds()) return true;
      if (performance.now() > untilMs) return false;
      await new Promise((resolve) => setTimeout(resolve, LOOK_AGAIN_MS));
    }
  };
}

/** Sends a request to each axis in turn, again while it is BUSY. Ends at the first refusal, which is shown where the robot's are. */
async function actOnEach(slots: readonly number[], action: AxisAction): Promise<boolean> {
  const settled = settling();
  for (const slot of slots) {
    let outcome = await api.act(slot, action);
    const accepted = await settled(async () => {
      if (!outcome.ok && outcome.problem.code === "BUSY") outcome = await api.act(slot, action);
      return outcome.ok || outcome.problem.code !== "BUSY";
    });
    tell("robot", outcome);
    if (!accepted || !outcome.ok) return false;
  }
  return true;
}

/** The slots of the axes in that state. */
function slotsIn(state: string): readonly number[] {
  const { motors, frame } = useConsole.getState();
  return motors.map(({ slot }) => slot).filter((slot) => frame?.axes[slot]?.state === state);
}

/** Clears every fault, unlocks where need be, waits for power, and enables each axis that is disabled. STOP ends it. */
export async function makeReady(): Promise<void> {
  const settled = settling();
  if (useConsole.getState().glance?.mode === "LOCKED") {
    const outcome = await api.reset();
    tell("robot", outcome);
    if (!outcome.ok) return;
  }
  if (!(await settled(() => useConsole.getState().glance?.power === "on"))) return;
  if (!(await actOnEach(slotsIn("FAULTED"), "clear-fault"))) return;
  await settled(() => slotsIn("FAULTED").length === 0);
  await actOnEach(slotsIn("DISABLED"), "enable");
}

/** Answers for an alarm; a refusal is shown where the robot's are. */
export async function acknowledgeAlarm(id: number): Promise<void> {
  const outcome = await api.acknowledgeAlarm(id);
  if (outcome.ok) useConsole.setState({ alarms: outcome.value.alarms });
  tell("robot", outcome);
}

/** Declares that the axes of these slots stand at home, then proposes to home the robot where `homes` says so. STOP ends it. */
export async function setHomeAndHome(slots: readonly number[], homes: boolean): Promise<void> {
  if ((await actOnEach(slots, "set-home")) && homes) await propose({ kind: "home" });
}

/** Approves a proposal that waits for it; a refusal is shown where the robot's are. */
export async function approve(id: number): Promise<void> {
  tell("robot", await api.approve(id));
}

/** Lets a proposal that is aligned go on to its insertion; a refusal is shown where the robot's are. */
export async function confirmInsertion(id: number): Promise<void> {
  tell("robot", await api.confirm(id));
}

/** Ends a proposal that waits for approval, which nobody wants; a refusal is shown where the robot's are. */
export async function reject(id: number): Promise<void> {
  tell("robot", await api.reject(id));
}

/** Changes the robot's mode; a refusal is shown at the selector. */
export async function setMode(mode: string): Promise<void> {
  const outcome = await api.setMode(mode);
  if (outcome.ok) useConsole.setState({ mode: outcome.value });
  tell("mode", outcome);
}

function tell(place: Place, outcome: Outcome<unknown>): void {
  const notice = outcome.ok ? null : noticeOfProblem(outcome.problem);
  useConsole.setState((state) => withNotice(state, place, notice));
}

/** Passes a command of models/plant/README.md to the simulated hardware; a refusal is shown at the bench. */
export async function bench(command: string, fields: Record<string, unknown>): Promise<void> {
  const outcome = await api.benchCommand(command, fields);
  const notice = outcome.ok ? null : noticeOfProblem(outcome.problem);
  useConsole.setState((state) => withBenchAnswer(state, command, notice));
}

const pedalFields: Record<HoldStep, Record<string, unknown>> = {
  press: { pressed: true },
  renew: { pressed: true, renew: true },
  release: { pressed: false },
};

/** Moves the simulated pedal. The refusal of a renewal stays in sight until the next press. */
export async function movePedal(footwork: HoldStep): Promise<boolean> {
  const outcome = await api.benchCommand("pedal", pedalFields[footwork]);
  const notice = outcome.ok ? null : noticeOfProblem(outcome.problem);
  if (footwork === "press" || notice !== null) {
    useConsole.setState((state) => withBenchAnswer(state, "pedal", notice));
  }
  return outcome.ok;
}

export function dismissNotice(place: Place): void {
  useConsole.setState((state) => withNotice(state, place, null));
}

import { useState } from "react";
import { api, type Outcome } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { NoticeText } from "../../design/NoticeText";
import { changeControl, makeReady, propose, setHomeAndHome } from "../../state/commands";
import { type Notice, noticeOfProblem } from "../../state/notice";
import { useConsole } from "../../state/store";
import { ConfirmClosing, TextForm } from "../targeting/CasePanel";
import { caseInHand } from "../targeting/case";
import {
  reasonAgainstTick,
  type Situation,
  type Step,
  type StepName,
  type TickName,
  toHome,
} from "./workflow";

const looks: Readonly<Record<Step["state"], { readonly shape: string; readonly tone: string }>> = {
  done: { shape: "✓", tone: "calm" },
  now: { shape: "▶", tone: "wish" },
  waits: { shape: "○", tone: "" },
};

/** Of steps that a panel beside them does. */
const panelNames: Readonly<Partial<Record<StepName, string>>> = {
  register: "registration",
  target: "entry and target",
  review: "alignment",
  align: "alignment",
  treat: "ablation",
};

interface StepLineProps {
  readonly step: Step;
  readonly situation: Situation;
  readonly onGoTo: () => void;
  readonly onTick: (name: TickName, ticked: boolean) => void;
  readonly onChanged: () => Promise<void>;
}

/** One step: its state, what it waits for, and its main button. */
export function StepLine({ step, situation, onGoTo, onTick, onChanged }: StepLineProps) {
  const { name, title, state, words } = step;
  const { shape, tone } = looks[state];
  return (
    <li
      className="step"
      aria-label={title}
      aria-current={state === "now" ? "step" : undefined}
      data-state={state}
    >
      <span className="step-head">
        <strong>{title}</strong>
        <span className={`chip ${tone}`}>
          <i aria-hidden="true">{shape}</i>
          {state}
        </span>
      </span>
      <p>{words}</p>
      {(name === "confirm" || name === "treat") && (
        <Tick name={name} title={title} situation={situation} onTick={onTick} />
      )}
      <MainButton step={step} situation={situation} onGoTo={onGoTo} onChanged={onChanged} />
    </li>
  );
}

interface TickProps extends Pick<StepLineProps, "situation" | "onTick"> {
  readonly name: TickName;
  readonly title: string;
}

/** Kept in the page alone: a person's word, which no record has. */
function Tick({ name, title, situation, onTick }: TickProps) {
  const ticked = situation.ticks[name] !== null;
  const reason = ticked ? null : reasonAgainstTick(situation, name);
  return (
    <label className="tick" title={reason ?? "Kept on this page only, until something moves or is set"}>
      <input
        type="checkbox"
        checked={ticked}
        disabled={reason !== null}
        onChange={({ target }) => onTick(name, target.checked)}
      />
      {name === "confirm" ? "An image shows the probe where it is to be" : `${title}: done`}
    </label>
  );
}

type MainButtonProps = Omit<StepLineProps, "onTick">;

function MainButton({ step, situation, onGoTo, onChanged }: MainButtonProps) {
  const tone = step.state === "now" ? "primary" : "";
  switch (step.act) {
    case null:
      return null;
    case "open":
      return <OpenCase onChanged={onChanged} />;
    case "case":
      return (
        <a className="button" href="#/targeting">
          Go to the case
        </a>
      );
    case "motors":
      return (
        <a className="button" href="#/robot">
          Go to Motors
        </a>
      );
    case "panel":
    case "proposal":
      return (
        <button type="button" className={`button ${tone}`} onClick={onGoTo}>
          Go to {step.act === "proposal" ? "proposal" : panelNames[step.name]}
        </button>
      );
    case "ready":
      return (
        <CommandButton need="holder" className={tone} onCommand={makeReady}>
          {situation.mode === "LOCKED" ? "Unlock and enable all axes" : "Enable all axes"}
        </CommandButton>
      );
    case "home":
      return <Home tone={tone} situation={situation} />;
    case "insert":
      return (
        <CommandButton
          need="holder"
          className={tone}
          off={
            situation.view.alignment?.within_tolerance === false
              ? "The target is out of reach: accept that in Alignment, with Insert ticked."
              : null
          }
          onCommand={() => propose({ kind: "pose", pose: "desired", insert: true })}
        >
          Propose insertion
        </CommandButton>
      );
    case "biopsy":
      return (
        <CommandButton need="holder" className={tone} onCommand={() => propose({ kind: "biopsy" })}>
          Propose biopsy of the target
        </CommandButton>
      );
    case "retract":
      return (
        <CommandButton need="holder" className={tone} onCommand={() => propose({ kind: "retraction" })}>
          Retract probe
        </CommandButton>
      );
    case "close":
      return <CloseCase tone={tone} situation={situation} onChanged={onChanged} />;
  }
}

interface HomeProps {
  readonly tone: string;
  readonly situation: Situation;
}

function Home({ tone, situation }: HomeProps) {
  const { byPerson, bySwitch } = toHome(situation);
  const homes = bySwitch.length > 0;
  const words =
    byPerson.length === 0 ? "Propose homing" : homes ? "Set home, and propose homing" : "Set home";
  const slots = byPerson.map(({ slot }) => slot);
  return (
    <CommandButton need="holder" className={tone} onCommand={() => setHomeAndHome(slots, homes)}>
      {words}
    </CommandButton>
  );
}

/** Sends a command about the case, and says why it was refused. */
function useSend(onChanged: () => Promise<void>) {
  const [refusal, setRefusal] = useState<Notice | null>(null);
  const send = async (command: () => Promise<Outcome<unknown>>): Promise<boolean> => {
    const outcome = await command();
    setRefusal(outcome.ok ? null : noticeOfProblem(outcome.problem));
    await onChanged();
    return outcome.ok;
  };
  const words = refusal !== null && (
    <p className="panel-notice" role="alert">
      <NoticeText lead="Refused:" notice={refusal} />
    </p>
  );
  return { send, words };
}

/** Takes control with it where nobody is in control: no case is opened without. */
function OpenCase({ onChanged }: { readonly onChanged: () => Promise<void> }) {
  const isFree = useConsole(({ control }) => control !== null && control.holder === null);
  const { send, words } = useSend(onChanged);
  const open = async (label: string): Promise<boolean> => {
    if (isFree) await changeControl(api.requestControl);
    return useConsole.getState().control?.mine === true && send(() => api.openCase(label));
  };
  return (
    <>
      <TextForm
        need={isFree ? "engineer" : "holder"}
        title="Label"
        most={80}
        placeholder="phantom 12"
        hint="No patient data: a label that you know it by."
        action={isFree ? "Take control and open case" : "Open case"}
        onSend={open}
      />
      {words}
    </>
  );
}

interface CloseCaseProps extends HomeProps {
  readonly onChanged: () => Promise<void>;
}

function CloseCase({ tone, situation, onChanged }: CloseCaseProps) {
  const [closing, setClosing] = useState(false);
  const { send, words } = useSend(onChanged);
  const number = caseInHand(situation.cases)?.number;
  if (number === undefined) return null;
  return (
    <>
      <CommandButton need="engineer" className={tone} onCommand={() => setClosing(true)}>
        Close case
      </CommandButton>
      {closing && <ConfirmClosing number={number} send={send} onEnd={() => setClosing(false)} />}
      {words}
    </>
  );
}

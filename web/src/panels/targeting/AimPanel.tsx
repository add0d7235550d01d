import { type FormEvent, useEffect, useId, useState } from "react";
import { api, type Targeting, type TargetingHistory } from "../../api/client";
import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import { ReasonLine } from "../../design/ReasonLine";
import { type Notice, noticeOfProblem } from "../../state/notice";
import type { Asked } from "../../state/usePolled";
import { useReason } from "../../state/useReason";
import {
  type Aim,
  type AimName,
  aimChange,
  aimOf,
  aimProblems,
  changedGroups,
  offsets,
  offsetTitles,
  points,
  pointsOf,
  pointTitles,
  receivedAim,
  titleOf,
  withPoints,
} from "./aim";
import { type Draft, hasNews, isEdited, kept, taken, withText } from "./draft";
import { list, numberIn } from "./numbers";
import { PlannedTargets } from "./PlannedTargets";
import { ProbeDrawing } from "./ProbeDrawing";
import { FRAME, FrameLabel, News, Problems, SendBar, SetBy } from "./parts";
import { rowNames } from "./pose";

interface AimPanelProps {
  readonly targeting: Targeting;
  readonly history: TargetingHistory | null;
  readonly asked: Asked;
  /** Why no case takes what would be set; null when one does. */
  readonly off: string | null;
  readonly onSet: () => Promise<void>;
}

const names: readonly AimName[] = [...points, ...offsets];

/** Entry, target and the probe; what changed is sent, and nothing else. */
export function AimPanel({ targeting, history, asked, off, onSet }: AimPanelProps) {
  const [aim, setAim] = useState(() => aimOf(targeting));
  const [refusal, setRefusal] = useState<Notice | null>(null);
  const [sending, setSending] = useState(false);
  const reason = useReason("holder") ?? off;
  const problemsId = useId();
  useEffect(() => setAim((known) => receivedAim(known, targeting)), [targeting]);

  const edited = names.filter((name) => isEdited(aim[name]));
  const news = names.filter((name) => hasNews(aim[name]));
  const problems = aimProblems(aim);
  const change = problems.length > 0 ? null : aimChange(aim);
  const all = (step: (draft: Draft) => Draft) => (known: Aim) =>
    Object.fromEntries(names.map((name) => [name, step(known[name])])) as Aim;
  const onText = (name: AimName, at: number, text: string): void =>
    setAim((known) => ({ ...known, [name]: withText(known[name], at, text) }));
  const onSubmit = async (event: FormEvent): Promise<void> => {
    event.preventDefault();
    if (change === null || sending) return;
    setSending(true);
    const outcome = await api.setTarget(change);
    setSending(false);
    setRefusal(outcome.ok ? null : noticeOfProblem(outcome.problem));
    if (!outcome.ok) return;
    setAim((known) => receivedAim(known, outcome.value));
    await onSet();
  };

  const plan = async (planned: Targeting["planned_targets"]): Promise<boolean> => {
    const outcome = await api.setPlannedTargets(planned);
    setRefusal(outcome.ok ? null : noticeOfProblem(outcome.problem));
    await onSet();
    return outcome.ok;
  };

  const field = { readOnly: reason !== null, problemsId, onText };
  return (
    <Panel title="Entry, target and probe" className="aim" asked={asked} tools={<FrameLabel />}>
      <ReasonLine need="holder" off={off} />
      <form
        className="targeting-form"
        aria-label="Entry, target and probe"
        noValidate
        onSubmit={(event) => void onSubmit(event)}
      >
        {points.map((name) => (
          <fieldset key={name} className="point">
            <legend>{pointTitles[name]}</legend>
            {rowNames.map((row, at) => (
              <Field
                key={row}
                name={name}
                at={at}
                label={row}
                full={`${pointTitles[name]} ${row}, ${FRAME}`}
                draft={aim[name]}
                {...field}
              />
            ))}
            <SetBy history={history} field={name} isSet={targeting[name] !== null} unset="Not set yet." />
          </fieldset>
        ))}
        <ProbeDrawing textOf={(name) => aim[name].text[0] ?? ""} />
        <fieldset className="offsets">
          <legend className="visually-hidden">Probe offsets along the probe, mm</legend>
          {offsets.map((name) => {
            const { letter, way } = offsetTitles[name];
            return (
              <Field
                key={name}
                name={name}
                at={0}
                label={letter}
                full={`${letter}, ${way}, mm`}
                draft={aim[name]}
                {...field}
              />
            );
          })}
        </fieldset>
        {news.length > 0 && (
          <News
            arrived={news.map((name) => arrivedWords(name, aim[name])).join("; ")}
            onTake={() => setAim((known) => onlyNews(known, taken))}
            onKeep={() => setAim((known) => onlyNews(known, kept))}
          />
        )}
        <Problems id={problemsId} problems={problems} />
        {refusal !== null && (
          <p className="panel-notice" role="alert">
            <NoticeText lead="Not set:" notice={refusal} />
          </p>
        )}
        <SendBar
          action="Set target"
          off={
            reason ??
            (news.length > 0 ? "Take what arrived, or keep yours, first." : null) ??
            (edited.length === 0 ? "Nothing was edited." : null) ??
            (change === null ? "See above what is wrong." : null)
          }
          edited={edited.length > 0}
          words={
            edited.length > 0 ? `To be sent: ${changedGroups(aim).map(titleOf).join(", ")}.` : "As received."
          }
          onUndo={() => {
            setAim(all(taken));
            setRefusal(null);
          }}
        />
      </form>
      {off === null && (
        <PlannedTargets
          planned={targeting.planned_targets}
          points={pointsOf(aim)}
          onTake={(planned) => setAim((known) => withPoints(known, planned))}
          onChange={plan}
        />
      )}
    </Panel>
  );
}

/** The groups for which something else arrived, answered; the others as they are. */
function onlyNews(aim: Aim, answer: (draft: Draft) => Draft): Aim {
  return Object.fromEntries(
    names.map((name) => [name, hasNews(aim[name]) ? answer(aim[name]) : aim[name]]),
  ) as Aim;
}

function arrivedWords(name: AimName, { arrived }: Draft): string {
  return `${titleOf(name)} ${list(
    arrived.map((value) => value ?? 0),
    2,
  )}`;
}

interface FieldProps {
  readonly name: AimName;
  readonly at: number;
  readonly label: string;
  /** With its frame and unit, for whoever does not see the panel. */
  readonly full: string;
  readonly draft: Draft;
  readonly readOnly: boolean;
  readonly problemsId: string;
  readonly onText: (name: AimName, at: number, text: string) => void;
}

function Field({ name, at, label, full, draft, readOnly, problemsId, onText }: FieldProps) {
  const text = draft.text[at] ?? "";
  return (
    <label className="number-field">
      <span aria-hidden="true">{label}</span>
      <input
        className="text"
        value={text}
        readOnly={readOnly}
        inputMode="decimal"
        autoComplete="off"
        aria-label={full}
        aria-invalid={isEdited(draft) && numberIn(text) === null}
        aria-describedby={problemsId}
        onChange={({ target }) => onText(name, at, target.value)}
      />
    </label>
  );
}

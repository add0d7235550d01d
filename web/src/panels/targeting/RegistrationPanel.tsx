import {
  type ChangeEvent,
  type ClipboardEvent,
  type FormEvent,
  useEffect,
  useId,
  useRef,
  useState,
} from "react";
import { api, type Targeting, type TargetingHistory } from "../../api/client";
import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import { ReasonLine } from "../../design/ReasonLine";
import { type Notice, noticeOfProblem } from "../../state/notice";
import type { Asked } from "../../state/usePolled";
import { useReason } from "../../state/useReason";
import { type Draft, draftOf, hasNews, isEdited, kept, received, taken, withText, withValues } from "./draft";
import { fitWords } from "./history";
import { list } from "./numbers";
import { FRAME, FrameLabel, News, Problems, SendBar, SetBy } from "./parts";
import { columnNames, originOf, rowNames } from "./pose";
import { MOST_CHARACTERS, readPose } from "./poseFile";
import {
  IGNORES_AT,
  ignoresRotation,
  isUnreadable,
  registrationAdvice,
  registrationChange,
  registrationProblems,
  registrationValues,
  withPose,
} from "./registration";

interface RegistrationPanelProps {
  readonly targeting: Targeting;
  readonly history: TargetingHistory | null;
  readonly asked: Asked;
  /** Why no case takes what would be set; null when one does. */
  readonly off: string | null;
  readonly onSet: () => Promise<void>;
}

/** The pose of the robot in the scanner: as it was received, edited by hand, or read from a file. */
export function RegistrationPanel({ targeting, history, asked, off, onSet }: RegistrationPanelProps) {
  const [draft, setDraft] = useState(() => draftOf(registrationValues(targeting)));
  const [read, setRead] = useState<Read>(nothingRead);
  const [refusal, setRefusal] = useState<Notice | null>(null);
  const [sending, setSending] = useState(false);
  const [override, setOverride] = useState("");
  const reason = useReason("holder") ?? off;
  const problemsId = useId();
  useEffect(() => setDraft((known) => received(known, registrationValues(targeting))), [targeting]);

  const edited = isEdited(draft);
  const problems = registrationProblems(draft);
  const isValid = targeting.registration_state === "valid";
  const change = registrationChange(draft, isValid);
  const isDoubted = refusal?.code === "IMPLAUSIBLE";
  // What was said of one matrix, and a reason for it, hold for no other.
  const edit = (next: (draft: Draft) => Draft): void => {
    setDraft(next);
    setRefusal(null);
    setOverride("");
  };
  const readFrom = (name: string, text: string): void => {
    const found = readPose(text);
    setRead(found.ok ? { from: name, problem: null } : { from: null, problem: `${name}: ${found.problem}` });
    if (found.ok) edit((known) => withValues(known, withPose(known, found.pose)));
  };
  const giveUp = (next: (draft: Draft) => Draft): void => {
    edit(next);
    setRead(nothingRead);
  };
  const onSubmit = async (event: FormEvent): Promise<void> => {
    event.preventDefault();
    if (change === null || sending) return;
    setSending(true);
    const outcome = await api.setRegistration(
      isDoubted && override !== "" ? { ...change, override_reason: override } : change,
    );
    setSending(false);
    setRefusal(outcome.ok ? null : noticeOfProblem(outcome.problem));
    if (!outcome.ok) return;
    setOverride("");
    setDraft(draftOf(registrationValues(outcome.value)));
    setRead(nothingRead);
    await onSet();
  };

  return (
    <Panel
      title="Registration"
      className="registration"
      asked={asked}
      tools={
        <>
          <FrameLabel />
          <LoadPose off={reason} onFile={(file) => void readFile(file, readFrom)} />
        </>
      }
    >
      <ReasonLine need="holder" off={off} />
      <form
        className="targeting-form"
        aria-label="Registration"
        noValidate
        onSubmit={(event) => void onSubmit(event)}
      >
        <SetBy
          history={history}
          field="registration"
          isSet={targeting.registration !== null}
          unset="Not set yet."
        />
        {targeting.registration_problem !== null && (
          <p className="registration-problem" role="status">
            <i aria-hidden="true">▲</i> {targeting.registration_problem} Nothing is shown in the scanner, or
            moved to. {registrationAdvice[targeting.registration_state]}
          </p>
        )}
        {fitWords(targeting) !== "" && <p className="set-by">{fitWords(targeting)}</p>}
        {targeting.registration_doubt !== null && (
          <p className="registration-problem" role="status">
            <i aria-hidden="true">▲</i> {targeting.registration_doubt} It was set all the same:{" "}
            {targeting.override_reason}
          </p>
        )}
        <Matrix
          draft={draft}
          readOnly={reason !== null}
          problemsId={problemsId}
          onPose={(text) => readFrom("The clipboard", text)}
          onText={(at, text) => edit((known) => withText(known, at, text))}
        />
        <label className="tick">
          <input
            type="checkbox"
            disabled={reason !== null}
            checked={ignoresRotation(draft)}
            onChange={({ target }) =>
              edit((known) => withText(known, IGNORES_AT, target.checked ? "1" : "0"))
            }
          />
          Use its origin alone, as if the robot stood straight in the scanner
        </label>
        <span>
          <Expiry hasMore={isValid || hasPoints(targeting)} onExpired={onSet} />
        </span>
        {hasNews(draft) && (
          <News
            arrived={`a registration with its origin at ${arrivedOrigin(draft)}`}
            onTake={() => giveUp(taken)}
            onKeep={() => setDraft(kept)}
          />
        )}
        <Problems id={problemsId} problems={read.problem === null ? problems : [read.problem, ...problems]} />
        {refusal !== null && (
          <p className="panel-notice" role="alert">
            <NoticeText lead="Not set:" notice={refusal} />
          </p>
        )}
        {isDoubted && (
          <label className="override-reason">
            Reason to set it all the same
            <input
              className="text"
              value={override}
              maxLength={200}
              autoComplete="off"
              onChange={({ target }) => setOverride(target.value)}
            />
          </label>
        )}
        <SendBar
          action={isDoubted && override !== "" ? "Set it all the same" : "Set registration"}
          off={
            reason ??
            (hasNews(draft) ? "Take what arrived, or keep yours, first." : null) ??
            (change !== null ? null : edited ? "It is no rigid pose: see above." : "Nothing was edited.")
          }
          edited={edited}
          words={
            edited
              ? editedWords(read.from)
              : targeting.registration === null
                ? "Write, paste or load it."
                : "As received."
          }
          onUndo={() => giveUp(taken)}
        />
      </form>
    </Panel>
  );
}

interface Read {
  /** Where the numbers came from that stand in the form; null when they were typed. */
  readonly from: string | null;
  readonly problem: string | null;
}

const nothingRead: Read = { from: null, problem: null };

function editedWords(from: string | null): string {
  return from === null ? "Edited, not sent." : `From ${from}, not sent.`;
}

function arrivedOrigin(draft: Draft): string {
  return list(originOf(draft.arrived.map((value) => value ?? 0)), 2);
}

async function readFile(file: File, onText: (name: string, text: string) => void): Promise<void> {
  // Of a film that was chosen by mistake no more is read than what shows that it is none.
  onText(file.name, await file.slice(0, MOST_CHARACTERS + 1).text());
}

function hasPoints({ entry_point, target_point, planned_targets }: Targeting): boolean {
  return entry_point !== null || target_point !== null || planned_targets.length > 0;
}

/** One button for the moment in which the table, or the patient, has moved. */
function Expiry({
  hasMore,
  onExpired,
}: {
  /** Something is in force that holds no longer then. */
  readonly hasMore: boolean;
  readonly onExpired: () => Promise<void>;
}) {
  const [refusal, setRefusal] = useState<Notice | null>(null);
  const reason = useReason("engineer");
  const onMoved = async (): Promise<void> => {
    const outcome = await api.expireRegistration();
    setRefusal(outcome.ok ? null : noticeOfProblem(outcome.problem));
    await onExpired();
  };
  return (
    <>
      {refusal !== null && <NoticeText lead="The reason is not kept:" notice={refusal} />}
      <button
        type="button"
        className="button"
        disabled={reason !== null || !hasMore}
        title={
          reason ??
          (hasMore
            ? "The registration expires, entry and target are gone, and every motion that rests on them ends"
            : "Neither a registration is valid nor a point set")
        }
        onClick={() => void onMoved()}
      >
        The table moved
      </button>
    </>
  );
}

function LoadPose({ off, onFile }: { readonly off: string | null; readonly onFile: (file: File) => void }) {
  const input = useRef<HTMLInputElement>(null);
  const onChange = (event: ChangeEvent<HTMLInputElement>): void => {
    const file = event.target.files?.[0];
    if (file !== undefined) onFile(file);
    // So that the same file can be chosen again.
    event.target.value = "";
  };
  return (
    <>
      <button
        type="button"
        className="button"
        disabled={off !== null}
        title={off ?? "16 numbers as text or JSON; they are shown before they are set"}
        onClick={() => input.current?.click()}
      >
        Load<span className="visually-hidden"> registration</span>
      </button>
      <input ref={input} type="file" hidden aria-label="File of a registration" onChange={onChange} />
    </>
  );
}

interface MatrixProps {
  readonly draft: Draft;
  readonly readOnly: boolean;
  readonly problemsId: string;
  readonly onText: (at: number, text: string) => void;
  /** A whole matrix was pasted. */
  readonly onPose: (text: string) => void;
}

function Matrix({ draft, readOnly, problemsId, onText, onPose }: MatrixProps) {
  const onPaste = (event: ClipboardEvent): void => {
    const text = event.clipboardData.getData("text");
    if (readOnly || text.trim().split(/[\s,;]+/).length < 12) return;
    event.preventDefault();
    onPose(text);
  };
  return (
    <table className="matrix editable" onPaste={onPaste}>
      <caption className="visually-hidden">Registration, {FRAME}</caption>
      <thead>
        <tr>
          <td />
          {columnNames.map((column) => (
            <th key={column} scope="col">
              {column}
              {column === "origin" && ", mm"}
            </th>
          ))}
        </tr>
      </thead>
      <tbody>
        {rowNames.map((row, at) => (
          <tr key={row}>
            <th scope="row">{row}</th>
            {columnNames.map((column, place) => {
              const index = 4 * at + place;
              const text = draft.text[index] ?? "";
              return (
                <td key={column}>
                  <input
                    className="text"
                    value={text}
                    readOnly={readOnly}
                    inputMode="decimal"
                    autoComplete="off"
                    aria-label={`Registration ${row} ${column}, ${FRAME}`}
                    aria-invalid={isUnreadable(text)}
                    aria-describedby={problemsId}
                    onChange={({ target }) => onText(index, target.value)}
                  />
                </td>
              );
            })}
          </tr>
        ))}
        <tr className="last-row">
          <td />
          <td>0</td>
          <td>0</td>
          <td>0</td>
          <td>1</td>
        </tr>
      </tbody>
    </table>
  );
}

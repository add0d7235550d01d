import { type FormEvent, useId, useState } from "react";
import { api, type Case, type Outcome } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { Confirm } from "../../design/Confirm";
import { download } from "../../design/download";
import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import { ReasonLine } from "../../design/ReasonLine";
import { type Notice, noticeOfProblem } from "../../state/notice";
import type { Need } from "../../state/permission";
import { useConsole } from "../../state/store";
import type { Asked } from "../../state/usePolled";
import { useReason } from "../../state/useReason";
import { localDate } from "../../units/time";
import { caseInHand, caseValues, caseWarnings, isOfOtherRobot } from "./case";
import { FRAME, SetBy } from "./parts";
import { registrationAdvice } from "./registration";

interface CasePanelProps {
  readonly cases: readonly Case[];
  /** By the app's clock; null until it is known. */
  readonly now: string | null;
  readonly asked: Asked;
  readonly onChanged: () => Promise<void>;
}

/** Sends a command, and gives whether it was accepted. */
type Send = (command: () => Promise<Outcome<unknown>>) => Promise<boolean>;

/** The case in hand, to which registration, entry and target belong, and the cases before it. */
export function CasePanel({ cases, now, asked, onChanged }: CasePanelProps) {
  const [refusal, setRefusal] = useState<Notice | null>(null);
  const send: Send = async (command) => {
    const outcome = await command();
    setRefusal(outcome.ok ? null : noticeOfProblem(outcome.problem));
    await onChanged();
    return outcome.ok;
  };
  const inHand = caseInHand(cases);
  return (
    <Panel title="Case" className="case" asked={asked}>
      <ReasonLine need={inHand === undefined ? "holder" : "engineer"} />
      {refusal !== null && (
        <p className="panel-notice" role="alert">
          <NoticeText lead="Refused:" notice={refusal} />
        </p>
      )}
      {inHand === undefined ? (
        <>
          <p className="case-words">No case is open. Registration, entry and target belong to one.</p>
          <TextForm
            need="holder"
            title="Label"
            most={80}
            placeholder="phantom 12"
            hint="No patient data: a label that you know it by."
            action="Open case"
            onSend={(label) => send(() => api.openCase(label))}
          />
        </>
      ) : (
        <InHand key={inHand.number} shown={inHand} now={now} send={send} />
      )}
      <Earlier cases={cases.filter(({ state }) => state === "closed")} send={send} />
    </Panel>
  );
}

interface InHandProps {
  readonly shown: Case;
  readonly now: string | null;
  readonly send: Send;
}

function InHand({ shown, now, send }: InHandProps) {
  const [closing, setClosing] = useState(false);
  const robot = useConsole((state) => state.robot?.name ?? null);
  const { number, state, opened, problem } = shown;
  const isOpen = state === "open";
  return (
    <>
      <div className="case-words">
        <p>
          <strong>
            Case {number}: {shown.label}
          </strong>{" "}
          <span className={`chip ${isOpen ? "calm" : "medium"}`}>
            <i aria-hidden="true">{isOpen ? "●" : "‖"}</i>
            {state}
          </span>{" "}
          <span className="muted">
            robot {shown.robot}, opened {localDate(opened.time)} by {opened.user}
          </span>
        </p>
        {!isOpen &&
          [`${problem} Nothing of it is in force.`, ...caseWarnings(shown, robot)].map((words) => (
            <p key={words} className="registration-problem">
              <i aria-hidden="true">▲</i> {words}
            </p>
          ))}
      </div>
      {!isOpen && <WouldBeInForce shown={shown} now={now} />}
      <p className="case-words propose-answers">
        {isOpen ? (
          <CommandButton
            need="engineer"
            onCommand={() => send(() => api.suspendCase(number)).then(() => undefined)}
          >
            Suspend
          </CommandButton>
        ) : (
          <CommandButton
            need="holder"
            className="primary"
            off={isOfOtherRobot(shown, robot) ? "It belongs to another robot." : null}
            onCommand={() => send(() => api.resumeCase(number)).then(() => undefined)}
          >
            Resume: I have looked at it
          </CommandButton>
        )}
        <CommandButton need="engineer" onCommand={() => setClosing(true)}>
          Close case
        </CommandButton>
      </p>
      {closing && <ConfirmClosing number={number} send={send} onEnd={() => setClosing(false)} />}
      {shown.notes.length > 0 && (
        <ul className="case-words" aria-label="Notes">
          {shown.notes.map(({ time, user, text }) => (
            <li key={`${time} ${text}`}>
              <span className="muted">{localDate(time)}</span> <strong>{user}</strong>: {text}
            </li>
          ))}
        </ul>
      )}
      <TextForm
        need="engineer"
        title="Note"
        most={1000}
        hint="No patient data."
        action="Add note"
        onSend={(text) => send(() => api.addCaseNote(number, text))}
      />
    </>
  );
}

interface ConfirmClosingProps {
  readonly number: number;
  readonly send: Send;
  readonly onEnd: () => void;
}

export function ConfirmClosing({ number, send, onEnd }: ConfirmClosingProps) {
  return (
    <Confirm
      title={`Close case ${number}?`}
      action={`Close case ${number}`}
      onConfirm={async () => {
        onEnd();
        await send(() => api.closeCase(number));
      }}
      onCancel={onEnd}
    >
      <p>
        Every motion that was proposed in it ends. Its registration, entry and target are not used again, and
        it cannot be opened again.
      </p>
    </Confirm>
  );
}

/** What somebody who resumes the case has to look at. */
function WouldBeInForce({ shown, now }: Pick<InHandProps, "shown" | "now">) {
  const { targeting, last_set } = shown;
  if (targeting === null) return null;
  const history = now === null ? null : { now, last_set };
  return (
    <table className="table">
      <caption>Would be in force; {FRAME}</caption>
      <tbody>
        {caseValues(targeting).map(({ field, title, words, unset }) => (
          <tr key={field}>
            <th scope="row">{title}</th>
            <td>
              {words}
              {field === "registration" && (
                <p className="set-by">{registrationAdvice[targeting.registration_state]}</p>
              )}
            </td>
            <td>
              <SetBy history={history} field={field} isSet={false} unset={unset} />
            </td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

function Earlier({ cases, send }: { readonly cases: readonly Case[]; readonly send: Send }) {
  const [deleting, setDeleting] = useState<Case | null>(null);
  if (cases.length === 0) return null;
  const exported = async (number: number): Promise<Outcome<unknown>> => {
    const outcome = await api.getCase(number);
    if (outcome.ok)
      download(`case-${number}.json`, "application/json", `${JSON.stringify(outcome.value, null, 2)}\n`);
    return outcome;
  };
  return (
    <details>
      <summary>Earlier cases</summary>
      <table className="table">
        <thead>
          <tr>
            <th scope="col">No.</th>
            <th scope="col">Label</th>
            <th scope="col">Opened</th>
            <th scope="col">Closed</th>
            <th scope="col">Export, delete</th>
          </tr>
        </thead>
        <tbody>
          {cases.map((each) => (
            <tr key={each.number} aria-label={`Case ${each.number}`}>
              <td>{each.number}</td>
              <th scope="row">{each.label}</th>
              <td>{localDate(each.opened.time)}</td>
              <td>{localDate(each.changed.time)}</td>
              <td>
                <CommandButton
                  need="engineer"
                  className="small"
                  label={`Export case ${each.number}`}
                  onCommand={() => send(() => exported(each.number)).then(() => undefined)}
                >
                  Export
                </CommandButton>{" "}
                <CommandButton
                  need="admin"
                  className="small"
                  label={`Delete case ${each.number}`}
                  onCommand={() => setDeleting(each)}
                >
                  Delete
                </CommandButton>
              </td>
            </tr>
          ))}
        </tbody>
      </table>
      {deleting !== null && (
        <Confirm
          title={`Delete case ${deleting.number}: ${deleting.label}?`}
          action="Delete it for good"
          onConfirm={async () => {
            setDeleting(null);
            await send(() => api.deleteCase(deleting.number));
          }}
          onCancel={() => setDeleting(null)}
        >
          <p>
            Its label, values and notes are deleted. The audit keeps what was done in it, by its number.
            Export it first if somebody may need it.
          </p>
        </Confirm>
      )}
    </details>
  );
}

interface TextFormProps {
  readonly need: Need;
  readonly title: string;
  readonly most: number;
  readonly placeholder?: string;
  readonly hint: string;
  readonly action: string;
  readonly onSend: (text: string) => Promise<boolean>;
}

/** One line of text and the button that sends it. */
export function TextForm({ need, title, most, placeholder, hint, action, onSend }: TextFormProps) {
  const [text, setText] = useState("");
  const [sending, setSending] = useState(false);
  const hintId = useId();
  const reason = useReason(need);
  const off = reason ?? (text.trim() === "" ? `${title}: it is empty.` : null);
  const onSubmit = async (event: FormEvent): Promise<void> => {
    event.preventDefault();
    if (off !== null || sending) return;
    setSending(true);
    if (await onSend(text.trim())) setText("");
    setSending(false);
  };
  return (
    <form className="case-form" aria-label={action} onSubmit={(event) => void onSubmit(event)}>
      <label>
        {title}
        <input
          className="text"
          value={text}
          readOnly={reason !== null}
          maxLength={most}
          placeholder={placeholder}
          autoComplete="off"
          aria-describedby={hintId}
          onChange={({ target }) => setText(target.value)}
        />
      </label>
      <button type="submit" className="button" disabled={off !== null} title={off ?? undefined}>
        {action}
      </button>
      <small id={hintId} className="muted">
        {hint}
      </small>
    </form>
  );
}

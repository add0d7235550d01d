import { useId, useState } from "react";
import { api, type RunRetention } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { Confirm } from "../../design/Confirm";
import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import { type Notice, noticeOfProblem } from "../../state/notice";
import { useConsole } from "../../state/store";
import { bounds, wholeNumber } from "./runs";

interface RetentionProps {
  readonly retention: RunRetention;
  readonly onSet: () => Promise<void>;
}

/** How many runs stay; an administrator sets it. Fewer than before are asked for twice, as runs go for ever. */
export function Retention({ retention, onSet }: RetentionProps) {
  const { count, days, always } = retention;
  const admin = useConsole((state) => state.login.phase === "in" && state.login.user.role === "admin");
  return (
    <Panel title="Retention">
      <p className="runs-words">
        The newest {count} runs of the last {days} days stay, the newest {always} whatever their age. One that
        goes on is never removed.
      </p>
      {admin ? (
        <RetentionForm key={`${count} ${days}`} retention={retention} onSet={onSet} />
      ) : (
        <p className="reason-line">Administrators set it.</p>
      )}
    </Panel>
  );
}

function RetentionForm({ retention, onSet }: RetentionProps) {
  const [texts, setTexts] = useState({ count: `${retention.count}`, days: `${retention.days}` });
  const [asking, setAsking] = useState(false);
  const [notice, setNotice] = useState<Notice | null>(null);
  const problemsId = useId();
  const count = wholeNumber("Runs", texts.count, bounds.count);
  const days = wholeNumber("Days", texts.days, bounds.days);
  const problems = [count, days].filter((each) => typeof each === "string");
  const same = count === retention.count && days === retention.days;
  const send = async (): Promise<void> => {
    setAsking(false);
    if (typeof count === "string" || typeof days === "string") return;
    const answer = await api.setRunRetention(count, days);
    setNotice(answer.ok ? null : noticeOfProblem(answer.problem));
    if (answer.ok) await onSet();
  };
  const field = (name: "count" | "days", title: string) => (
    <label>
      {title}{" "}
      <input
        className="text"
        inputMode="numeric"
        autoComplete="off"
        aria-describedby={problemsId}
        value={texts[name]}
        onChange={({ target }) => {
          setTexts({ ...texts, [name]: target.value });
          setAsking(false);
        }}
      />
    </label>
  );
  return (
    <div className="retention-form">
      {field("count", "Runs")}
      {field("days", "Days")}
      <CommandButton
        need="admin"
        off={problems[0] ?? (same ? "Nothing differs." : null)}
        onCommand={() => {
          const fewer = Number(count) < retention.count || Number(days) < retention.days;
          return fewer ? setAsking(true) : send();
        }}
      >
        Set retention
      </CommandButton>
      <p id={problemsId} className={problems.length > 0 ? "warn" : "muted"} role="status">
        {problems.length > 0
          ? problems.join(" ")
          : `${bounds.count[0]} to ${bounds.count[1]} runs, ${bounds.days[0]} to ${bounds.days[1]} days.`}
      </p>
      {asking && (
        <Confirm
          title={`Keep ${count} runs of ${days} days?`}
          action="Remove the others"
          onConfirm={send}
          onCancel={() => setAsking(false)}
        >
          <p>Those beyond are removed at once and for ever, with their samples and notes.</p>
        </Confirm>
      )}
      {notice !== null && (
        <p className="panel-notice" role="alert">
          <NoticeText lead="Refused:" notice={notice} />
        </p>
      )}
    </div>
  );
}

import { type FormEvent, useState } from "react";
import { api } from "../../api/client";
import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import { UserNameField } from "../../design/UserNameField";
import { type Notice, noticeOfProblem } from "../../state/notice";
import { useConsole } from "../../state/store";
import { Sessions } from "./Sessions";
import "./account.css";

type Change =
  | { readonly phase: "idle" | "waiting" | "done" }
  | { readonly phase: "refused"; readonly notice: Notice };

/** The user's own password and sessions. */
export function AccountPage() {
  const login = useConsole((state) => state.login);
  const [current, setCurrent] = useState("");
  const [wanted, setWanted] = useState("");
  const [again, setAgain] = useState("");
  const [change, setChange] = useState<Change>({ phase: "idle" });
  if (login.phase !== "in") return null;
  const differs = again !== "" && again !== wanted;

  const onSubmit = async (event: FormEvent): Promise<void> => {
    event.preventDefault();
    setChange({ phase: "waiting" });
    const outcome = await api.changePassword(current, wanted);
    if (!outcome.ok) return setChange({ phase: "refused", notice: noticeOfProblem(outcome.problem) });
    for (const empty of [setCurrent, setWanted, setAgain]) empty("");
    setChange({ phase: "done" });
  };

  return (
    <Panel title="Account" className="page-panel">
      <p className="page-words">
        {login.user.name}, {login.user.role}. A changed password ends every other session of yours.
      </p>
      <form className="account" aria-label="Change the password" onSubmit={(event) => void onSubmit(event)}>
        <UserNameField name={login.user.name} />
        <PasswordField
          label="Current password"
          kind="current-password"
          value={current}
          onChange={setCurrent}
        />
        <PasswordField label="New password" kind="new-password" value={wanted} onChange={setWanted} />
        <PasswordField label="New password again" kind="new-password" value={again} onChange={setAgain} />
        <p role="alert">
          {differs && "The new passwords differ."}
          {change.phase === "refused" && <NoticeText lead="Not changed:" notice={change.notice} />}
        </p>
        <button
          type="submit"
          className="button primary"
          disabled={change.phase === "waiting" || current === "" || wanted === "" || again !== wanted}
        >
          Change password
        </button>
        <p role="status">{change.phase === "done" && "The password is changed."}</p>
      </form>
      <Sessions user={login.user.name} />
    </Panel>
  );
}

interface PasswordFieldProps {
  readonly label: string;
  readonly kind: "current-password" | "new-password";
  readonly value: string;
  readonly onChange: (value: string) => void;
}

function PasswordField({ label, kind, value, onChange }: PasswordFieldProps) {
  return (
    <label>
      {label}
      <input
        className="text"
        type="password"
        autoComplete={kind}
        value={value}
        onChange={(event) => onChange(event.target.value)}
      />
    </label>
  );
}

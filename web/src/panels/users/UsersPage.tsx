import { type FormEvent, useState } from "react";
import { api, type Outcome, type Role, type User, type UserChange } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import { UserNameField } from "../../design/UserNameField";
import { type Notice, noticeOfProblem } from "../../state/notice";
import { usePolled } from "../../state/usePolled";
import { localDate } from "../../units/time";
import { AddUser } from "./AddUser";
import { roles } from "./roles";
import "./users.css";

const ASK_EVERY_MS = 2000;

/** Who may log in, and as what. Users are never removed, since the audit names them. */
export function UsersPage() {
  const { value, asked, notice, refresh } = usePolled(api.users, ASK_EVERY_MS);
  const [refusal, setRefusal] = useState<Notice | null>(null);
  const settle = async (outcome: Outcome<User>): Promise<boolean> => {
    setRefusal(outcome.ok ? null : noticeOfProblem(outcome.problem));
    await refresh();
    return outcome.ok;
  };
  const change = (user: string, wanted: UserChange): Promise<boolean> =>
    api.changeUser(user, wanted).then(settle);
  const shown = refusal ?? notice;
  return (
    <Panel title="Users" className="page-panel" asked={asked}>
      {shown !== null && (
        <p className="panel-notice" role="alert">
          <NoticeText lead={refusal === null ? "No answer:" : "Refused:"} notice={shown} />
        </p>
      )}
      <table className="table users">
        <thead>
          <tr>
            <th scope="col">Name</th>
            <th scope="col">Role</th>
            <th scope="col">May log in</th>
            <th scope="col">Created</th>
            <th scope="col">Last login</th>
            <th scope="col">New password</th>
          </tr>
        </thead>
        <tbody>
          {value?.map((user) => (
            <UserLine key={user.name} user={user} onChange={(wanted) => change(user.name, wanted)} />
          ))}
        </tbody>
      </table>
      <p className="page-words">Whoever is changed is logged out everywhere.</p>
      <AddUser onAdd={(user) => api.addUser(user).then(settle)} />
    </Panel>
  );
}

interface UserLineProps {
  readonly user: User;
  readonly onChange: (wanted: UserChange) => Promise<boolean>;
}

function UserLine({ user, onChange }: UserLineProps) {
  const [role, setRole] = useState<Role | null>(null);
  const [password, setPassword] = useState("");
  const wanted = role ?? user.role;
  const changeRole = async (): Promise<void> => {
    await onChange({ role: wanted });
    setRole(null);
  };
  const changePassword = async (event: FormEvent): Promise<void> => {
    event.preventDefault();
    if (await onChange({ password })) setPassword("");
  };
  return (
    <tr aria-label={`User ${user.name}`} data-enabled={user.enabled}>
      <th scope="row">{user.name}</th>
      <td>
        <select
          aria-label={`Role of ${user.name}`}
          value={wanted}
          onChange={(event) => setRole(event.target.value as Role)}
        >
          {roles.map((each) => (
            <option key={each}>{each}</option>
          ))}
        </select>{" "}
        {wanted !== user.role && (
          <CommandButton need="admin" label={`Set the role of ${user.name}`} onCommand={changeRole}>
            Set
          </CommandButton>
        )}
      </td>
      <td>
        {user.enabled ? "● yes" : "✕ no"}{" "}
        <CommandButton
          need="admin"
          className="quiet"
          label={`${user.enabled ? "Disable" : "Enable"} ${user.name}`}
          onCommand={() => onChange({ enabled: !user.enabled }).then(() => undefined)}
        >
          {user.enabled ? "Disable" : "Enable"}
        </CommandButton>
      </td>
      <td>{localDate(user.created)}</td>
      <td>{user.last_login === null ? "never" : localDate(user.last_login)}</td>
      <td>
        <form onSubmit={(event) => void changePassword(event)}>
          <UserNameField name={user.name} />
          <input
            className="text"
            type="password"
            autoComplete="new-password"
            aria-label={`New password of ${user.name}`}
            placeholder="10 characters or more"
            value={password}
            onChange={(event) => setPassword(event.target.value)}
          />{" "}
          <button
            type="submit"
            className="button"
            aria-label={`Set the password of ${user.name}`}
            disabled={password === ""}
          >
            Set
          </button>
        </form>
      </td>
    </tr>
  );
}

import { type FormEvent, useState } from "react";
import type { NewUser, Role } from "../../api/client";
import { roles } from "./roles";

const empty: NewUser = { name: "", role: "viewer", password: "" };

/** `onAdd` gives whether the user was added. */
export function AddUser({ onAdd }: { readonly onAdd: (user: NewUser) => Promise<boolean> }) {
  const [user, setUser] = useState<NewUser>(empty);
  const [waiting, setWaiting] = useState(false);
  const onSubmit = async (event: FormEvent): Promise<void> => {
    event.preventDefault();
    setWaiting(true);
    if (await onAdd(user)) setUser(empty);
    setWaiting(false);
  };
  return (
    <form className="add-user" aria-label="Add a user" onSubmit={(event) => void onSubmit(event)}>
      <label>
        Name
        <input
          className="text"
          autoComplete="off"
          autoCapitalize="none"
          spellCheck={false}
          value={user.name}
          onChange={(event) => setUser({ ...user, name: event.target.value })}
        />
      </label>
      <label>
        Role
        <select
          value={user.role}
          onChange={(event) => setUser({ ...user, role: event.target.value as Role })}
        >
          {roles.map((role) => (
            <option key={role}>{role}</option>
          ))}
        </select>
      </label>
      <label>
        Password
        <input
          className="text"
          type="password"
          autoComplete="new-password"
          placeholder="10 characters or more"
          value={user.password}
          onChange={(event) => setUser({ ...user, password: event.target.value })}
        />
      </label>
      <button
        type="submit"
        className="button primary"
        disabled={waiting || user.name === "" || user.password === ""}
      >
        Add user
      </button>
    </form>
  );
}

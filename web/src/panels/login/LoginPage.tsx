import { type FormEvent, useEffect, useRef, useState } from "react";
import { api, type Problem } from "../../api/client";
import { NoticeText } from "../../design/NoticeText";
import { enter } from "../../state/feed";
import { noticeOfProblem } from "../../state/notice";
import { useConsole } from "../../state/store";
import { useWaitS } from "./useWaitS";
import "./login.css";

/** Name and password; nothing else of the robot but the header and STOP. */
export function LoginPage() {
  const login = useConsole((state) => state.login);
  return (
    <main className="login-page">
      <section className="panel login-panel" aria-label="Log in">
        <h2>Log in</h2>
        {login.phase === "unknown" ? (
          <p role="status">Waiting for the app …</p>
        ) : (
          <>
            {login.phase === "out" && login.notice !== null && (
              <p className="panel-notice" role="alert">
                {login.notice.meaning} <span className="next-step">{login.notice.nextStep}</span>
              </p>
            )}
            <LoginForm />
          </>
        )}
        <p className="login-words">
          STOP works without login. The pedal and the E-stop stop motion without any of this.
        </p>
      </section>
    </main>
  );
}

function LoginForm() {
  const [name, setName] = useState("");
  const [password, setPassword] = useState("");
  const [waiting, setWaiting] = useState(false);
  const [problem, setProblem] = useState<Problem | null>(null);
  const waitS = useWaitS(problem);
  const nameField = useRef<HTMLInputElement>(null);
  useEffect(() => nameField.current?.focus(), []);

  const onSubmit = async (event: FormEvent): Promise<void> => {
    event.preventDefault();
    setWaiting(true);
    const outcome = await api.login(name.trim(), password);
    setWaiting(false);
    setPassword("");
    if (outcome.ok) enter(outcome.value);
    else setProblem(outcome.problem);
  };

  return (
    <form aria-label="Log in" onSubmit={(event) => void onSubmit(event)}>
      <label>
        Name
        <input
          ref={nameField}
          className="text"
          autoComplete="username"
          autoCapitalize="none"
          spellCheck={false}
          value={name}
          onChange={(event) => setName(event.target.value)}
        />
      </label>
      <label>
        Password
        <input
          className="text"
          type="password"
          autoComplete="current-password"
          value={password}
          onChange={(event) => setPassword(event.target.value)}
        />
      </label>
      {problem !== null && (
        <p className="panel-notice" role="alert">
          <NoticeText lead="Not logged in:" notice={noticeOfProblem(problem)} />
        </p>
      )}
      <button
        type="submit"
        className="button primary"
        disabled={waiting || waitS > 0 || name.trim() === "" || password === ""}
      >
        {waiting ? "Logging in …" : "Log in"}
      </button>
      <output className="back-off" aria-label="Time to wait">
        {waitS > 0 && `Another attempt in ${waitS} s.`}
      </output>
    </form>
  );
}

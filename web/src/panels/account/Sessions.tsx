import { useState } from "react";
import { api, type ListedSession } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { NoticeText } from "../../design/NoticeText";
import { type Notice, noticeOfProblem } from "../../state/notice";
import { usePolled } from "../../state/usePolled";
import { localDate } from "../../units/time";
import { ownSessions } from "./sessions";

const ASK_EVERY_MS = 2000;

/** Where the user is logged in, and the way to end it there. */
export function Sessions({ user }: { readonly user: string }) {
  const { value, notice, refresh } = usePolled(api.sessions, ASK_EVERY_MS);
  const [refusal, setRefusal] = useState<Notice | null>(null);
  const own = ownSessions(value ?? [], user);
  const others = own.filter((each) => !each.mine);
  const end = async (sessions: readonly ListedSession[]): Promise<void> => {
    let refused: Notice | null = null;
    for (const { session } of sessions) {
      const outcome = await api.endSession(session);
      if (!outcome.ok) refused = noticeOfProblem(outcome.problem);
    }
    setRefusal(refused);
    await refresh();
  };
  const shown = refusal ?? notice;
  return (
    <section className="sessions" aria-label="Sessions">
      <h3>Sessions</h3>
      <p className="page-words">
        Where you are logged in. Ending a session logs out there, and releases control if it is in control. To
        end this one, log out.
      </p>
      {shown !== null && (
        <p className="panel-notice" role="alert">
          <NoticeText lead={refusal === null ? "No answer:" : "Not ended:"} notice={shown} />
        </p>
      )}
      <table className="table">
        <thead>
          <tr>
            <th scope="col">From</th>
            <th scope="col">Login</th>
            <th scope="col">Last used</th>
            <th scope="col">End</th>
          </tr>
        </thead>
        <tbody>
          {own.map((each) => (
            <tr key={each.session} aria-label={`Session ${each.session}`}>
              <th scope="row">{each.address ?? "unknown"}</th>
              <td>{localDate(each.since)}</td>
              <td>{localDate(each.last_use)}</td>
              <td>
                {each.mine ? (
                  "● this one"
                ) : (
                  <CommandButton
                    need="viewer"
                    label={`End session ${each.session}`}
                    onCommand={() => end([each])}
                  >
                    End
                  </CommandButton>
                )}
              </td>
            </tr>
          ))}
        </tbody>
      </table>
      <CommandButton
        need="viewer"
        off={others.length === 0 ? "There is no other session." : null}
        onCommand={() => end(others)}
      >
        End all others
      </CommandButton>
    </section>
  );
}

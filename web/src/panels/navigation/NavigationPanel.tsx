import { useState } from "react";
import { api, type NavigationConnection, type NavigationRole, type Outcome } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import { type Notice, noticeOfProblem } from "../../state/notice";
import { usePolled } from "../../state/usePolled";
import { localTime } from "../../units/time";
import { countWord, formatHeardAge, formatRate, formatRoundTrip } from "./figures";
import "./navigation.css";

const ASK_EVERY_MS = 1000;

type Ask = () => Promise<Outcome<NavigationConnection[]>>;

/** Navigation programs that are connected by OpenIGTLink: who they are, what they said last, and what they may do. */
export function NavigationPanel() {
  const { value, asked, notice, refresh } = usePolled(api.navigationConnections, ASK_EVERY_MS);
  const [refusal, setRefusal] = useState<Notice | null>(null);
  const send = async (ask: Ask): Promise<void> => {
    const outcome = await ask();
    setRefusal(outcome.ok ? null : noticeOfProblem(outcome.problem));
    await refresh();
  };
  const shown = refusal ?? notice;
  return (
    <Panel title="Navigation" className="navigation-panel" asked={asked}>
      {value?.length === 0 && (
        <p className="panel-words">No navigation program is connected by OpenIGTLink.</p>
      )}
      <ul className="navigation-list">
        {value?.map((connection) => (
          <Program key={connection.id} connection={connection} send={send} />
        ))}
      </ul>
      {shown !== null && (
        <p className="panel-notice" role="alert">
          <NoticeText lead={refusal === null ? "No answer:" : "Refused:"} notice={shown} />
        </p>
      )}
    </Panel>
  );
}

interface ProgramProps {
  readonly connection: NavigationConnection;
  readonly send: (ask: Ask) => Promise<void>;
}

function Program({ connection, send }: ProgramProps) {
  const { id, client, dialect, role, messages, refused } = connection;
  return (
    <li className="navigation-program" aria-label={`Navigation program ${client}`}>
      <div className="navigation-line">
        <strong>{client}</strong>
        <span className="navigation-role" data-role={role}>
          {role === "controller" ? "▶ controller" : "observer"}
        </span>
        <span>{dialect}</span>
        <span className={refused > 0 ? "bad" : ""}>{countWord(refused, "message")} refused</span>
        <span className="navigation-buttons">
          <RoleButton connection={connection} send={send} />
          <CommandButton
            need="engineer"
            className="quiet small"
            label={`Disconnect navigation program ${client}`}
            onCommand={() => send(() => api.endNavigation(id))}
          >
            Disconnect
          </CommandButton>
        </span>
      </div>
      <Traffic connection={connection} />
      <details>
        <summary>{countWord(messages.length, "name")} heard</summary>
        <HeardTable messages={messages} />
      </details>
    </li>
  );
}

/** To act for an engineer needs control; to be an observer again does, too, since it stops what moves. */
function RoleButton({ connection, send }: ProgramProps) {
  const { id, client, role } = connection;
  const other: NavigationRole = role === "controller" ? "observer" : "controller";
  return (
    <CommandButton
      need="holder"
      className="quiet small"
      label={`Make ${other}: navigation program ${client}`}
      onCommand={() => send(() => api.setNavigationRole(id, other))}
    >
      Make {other}
    </CommandButton>
  );
}

function Traffic({ connection }: { readonly connection: NavigationConnection }) {
  const { since, header_version, received, sent, replaced, round_trip_ms } = connection;
  return (
    <p className="navigation-traffic">
      since {localTime(since)} · header {header_version} · {received} received · {sent} sent · {replaced}{" "}
      overtaken by newer values · round trip {formatRoundTrip(round_trip_ms)}
    </p>
  );
}

function HeardTable({ messages }: { readonly messages: NavigationConnection["messages"] }) {
  return (
    <table className="table" aria-label="Last message of each name">
      <thead>
        <tr>
          <th scope="col">Name</th>
          <th scope="col">Type</th>
          <th scope="col" className="number">
            Count
          </th>
          <th scope="col" className="number">
            Age
          </th>
          <th scope="col" className="number">
            Rate
          </th>
        </tr>
      </thead>
      <tbody>
        {messages.map(({ name, type, count, age_s, rate_hz }) => (
          <tr key={`${type} ${name}`}>
            <th scope="row">{name === "" ? "(no name)" : name}</th>
            <td>{type}</td>
            <td className="number">{count}</td>
            <td className="number">{formatHeardAge(age_s)}</td>
            <td className="number">{formatRate(rate_hz)}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

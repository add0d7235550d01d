import { useState } from "react";
import { api, type Connection } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import { type Notice, noticeOfProblem } from "../../state/notice";
import { usePolled } from "../../state/usePolled";
import { localTime } from "../../units/time";
import "./communication.css";

const ASK_EVERY_MS = 1000;

/** Who is connected to the app, and where. */
export function CommunicationPanel() {
  const { value, asked, notice, refresh } = usePolled(api.communications, ASK_EVERY_MS);
  const [refusal, setRefusal] = useState<Notice | null>(null);
  const disconnect = async (id: number): Promise<void> => {
    const outcome = await api.disconnect(id);
    setRefusal(outcome.ok ? null : noticeOfProblem(outcome.problem));
    await refresh();
  };
  const shown = refusal ?? notice;
  return (
    <Panel title="Communication" className="communication-panel" asked={asked}>
      <table className="table">
        <thead>
          <tr>
            <th scope="col">Type</th>
            <th scope="col">Client</th>
            <th scope="col">User</th>
            <th scope="col" className="number">
              Port
            </th>
            <th scope="col">Since</th>
            <th scope="col">
              <span className="visually-hidden">Disconnect</span>
            </th>
          </tr>
        </thead>
        <tbody>
          {value?.map((connection) => (
            <ConnectionLine
              key={connection.id ?? connection.name}
              connection={connection}
              onDisconnect={disconnect}
            />
          ))}
        </tbody>
      </table>
      {shown !== null && (
        <p className="panel-notice" role="alert">
          <NoticeText lead={refusal === null ? "No answer:" : "Refused:"} notice={shown} />
        </p>
      )}
    </Panel>
  );
}

interface ConnectionLineProps {
  readonly connection: Connection;
  readonly onDisconnect: (id: number) => Promise<void>;
}

function ConnectionLine({ connection, onDisconnect }: ConnectionLineProps) {
  const { id, type, name, connected, client, user, port, since } = connection;
  return (
    <tr>
      <th scope="row" title={name}>
        <span className={connected ? "" : "bad"}>
          <i aria-hidden="true">{connected ? "●" : "✕"}</i> {type}
        </span>
      </th>
      <td>{connected ? (client ?? "local") : "not connected"}</td>
      <td>{user ?? "–"}</td>
      <td className="number">{port ?? "–"}</td>
      <td>{since === null ? "–" : localTime(since)}</td>
      <td className="number">
        {id !== null && (
          <CommandButton
            need="engineer"
            className="quiet small"
            label={`Disconnect ${type} ${client ?? name}`}
            onCommand={() => onDisconnect(id)}
          >
            Disconnect
          </CommandButton>
        )}
      </td>
    </tr>
  );
}

import { useEffect, useState } from "react";
import { type AuditRecord, api } from "../../api/client";
import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import { type Notice, noticeOfProblem } from "../../state/notice";
import { usePolled } from "../../state/usePolled";
import { localDate } from "../../units/time";
import { ChainCheck } from "./ChainCheck";
import { detailText, mergeRecords } from "./records";
import "./audit.css";

const PAGE = 100;
const ASK_EVERY_MS = 2000;
const askNewest = () => api.audit(PAGE);

/** What was done with the robot, by whom, newest first. */
export function AuditPage() {
  const { value, asked, notice } = usePolled(askNewest, ASK_EVERY_MS);
  const [records, setRecords] = useState<readonly AuditRecord[]>([]);
  const [refusal, setRefusal] = useState<Notice | null>(null);
  useEffect(() => {
    if (value !== null) setRecords((known) => mergeRecords(known, value));
  }, [value]);
  const oldest = records.at(-1)?.number ?? 1;
  const older = async (): Promise<void> => {
    const outcome = await api.audit(PAGE, oldest);
    setRefusal(outcome.ok ? null : noticeOfProblem(outcome.problem));
    if (outcome.ok) setRecords((known) => mergeRecords(known, outcome.value));
  };
  const shown = refusal ?? notice;
  return (
    <Panel title="Audit" className="page-panel" asked={asked}>
      <ChainCheck />
      {shown !== null && (
        <p className="panel-notice" role="alert">
          <NoticeText lead="No answer:" notice={shown} />
        </p>
      )}
      <table className="table audit">
        <thead>
          <tr>
            <th scope="col" className="number">
              No.
            </th>
            <th scope="col">Time</th>
            <th scope="col" className="number">
              Tick
            </th>
            <th scope="col">Actor</th>
            <th scope="col">Kind</th>
            <th scope="col">Detail</th>
            <th scope="col">Hash</th>
          </tr>
        </thead>
        <tbody>
          {records.map((record) => (
            <RecordLine key={record.number} record={record} />
          ))}
        </tbody>
      </table>
      {oldest > 1 && (
        <button type="button" className="button older" onClick={() => void older()}>
          Older records
        </button>
      )}
    </Panel>
  );
}

function RecordLine({ record }: { readonly record: AuditRecord }) {
  return (
    <tr>
      <td className="number">{record.number}</td>
      <td>{localDate(record.time)}</td>
      <td className="number">{record.tick ?? "–"}</td>
      <th scope="row" title={record.session === null ? undefined : `session ${record.session}`}>
        {record.actor}
      </th>
      <td>{record.kind.replace("_", " ")}</td>
      <td className="detail">{detailText(record.detail)}</td>
      <td>
        <code title={record.hash}>{record.hash.slice(0, 8)}</code>
      </td>
    </tr>
  );
}

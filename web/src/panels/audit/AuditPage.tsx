import { useCallback, useEffect, useState } from "react";
import { type AuditFilter, type AuditRecord, api } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { download } from "../../design/download";
import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import { type Notice, noticeOfProblem } from "../../state/notice";
import { useKept } from "../../state/useKept";
import { usePolled } from "../../state/usePolled";
import { localDate } from "../../units/time";
import { ChainCheck } from "./ChainCheck";
import { detailText, mergeRecords, recordsCsv } from "./records";
import "./audit.css";

const PAGE = 100;
const EXPORT_PAGE = 1000;
const ASK_EVERY_MS = 2000;
const kinds: readonly AuditRecord["kind"][] = [
  "start",
  "login",
  "login_refused",
  "logout",
  "session_ended",
  "user",
  "control",
  "proposal",
  "request",
  "verdict",
  "stop",
  "setting",
  "restore",
  "bench",
  "connection",
  "records_lost",
  "retention",
  "acknowledgement",
  "case",
  "alarm",
];

/** What was done with the robot, by whom, newest first. */
export function AuditPage() {
  const [kept, keepFilter] = useKept("audit", "{}");
  const filter: AuditFilter = JSON.parse(kept);
  const ask = useCallback(() => api.audit(PAGE, JSON.parse(kept)), [kept]);
  const { value, asked, notice } = usePolled(ask, ASK_EVERY_MS);
  const [records, setRecords] = useState<readonly AuditRecord[]>([]);
  const [more, setMore] = useState(false);
  const [refusal, setRefusal] = useState<Notice | null>(null);
  // biome-ignore lint/correctness/useExhaustiveDependencies: another filter begins anew
  useEffect(() => setRecords([]), [kept]);
  useEffect(() => {
    if (value === null) return;
    setRecords((known) => mergeRecords(known, value));
    setMore((before) => before || value.length === PAGE);
  }, [value]);
  const older = async (): Promise<void> => {
    const outcome = await api.audit(PAGE, { ...filter, before: records.at(-1)?.number ?? 1 });
    setRefusal(outcome.ok ? null : noticeOfProblem(outcome.problem));
    if (!outcome.ok) return;
    setRecords((known) => mergeRecords(known, outcome.value));
    setMore(outcome.value.length === PAGE);
  };
  const save = async (): Promise<void> => {
    let all: readonly AuditRecord[] = [];
    for (let page = EXPORT_PAGE; page === EXPORT_PAGE; ) {
      const before = all.at(-1)?.number;
      const outcome = await api.audit(EXPORT_PAGE, before === undefined ? filter : { ...filter, before });
      setRefusal(outcome.ok ? null : noticeOfProblem(outcome.problem));
      if (!outcome.ok) return;
      all = mergeRecords(all, outcome.value);
      page = outcome.value.length;
    }
    download(`audit-${new Date().toISOString().slice(0, 10)}.csv`, "text/csv", recordsCsv(all));
  };
  const shown = refusal ?? notice;
  return (
    <Panel title="Audit" className="page-panel" asked={asked}>
      <ChainCheck />
      <FilterBar filter={filter} onFilter={(wanted) => keepFilter(JSON.stringify(wanted))} onSave={save} />
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
      {records.length === 0 && asked.answeredAtMs !== null && (
        <p className="page-words">No record fits these choices.</p>
      )}
      {more && (
        <button type="button" className="button older" onClick={() => void older()}>
          Older records
        </button>
      )}
    </Panel>
  );
}

interface FilterBarProps {
  readonly filter: AuditFilter;
  readonly onFilter: (filter: AuditFilter) => void;
  readonly onSave: () => Promise<void>;
}

function FilterBar({ filter, onFilter, onSave }: FilterBarProps) {
  const change = (name: "kind" | "actor" | "text", value: string): void => {
    const { [name]: _, ...others } = filter;
    onFilter(value === "" ? others : { ...others, [name]: value });
  };
  return (
    <search className="audit-filter" aria-label="Which records">
      <label>
        Kind{" "}
        <select value={filter.kind ?? ""} onChange={({ target }) => change("kind", target.value)}>
          <option value="">all</option>
          {kinds.map((kind) => (
            <option key={kind} value={kind}>
              {kind.replace("_", " ")}
            </option>
          ))}
        </select>
      </label>
      <label>
        Actor{" "}
        <input
          className="text"
          value={filter.actor ?? ""}
          onChange={({ target }) => change("actor", target.value.trim())}
        />
      </label>
      <label>
        Detail has{" "}
        <input
          type="search"
          className="text"
          value={filter.text ?? ""}
          onChange={({ target }) => change("text", target.value)}
        />
      </label>
      <CommandButton need="admin" onCommand={onSave}>
        Save as CSV
      </CommandButton>
    </search>
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

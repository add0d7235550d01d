import type { TargetingHistory } from "../../api/client";
import { Panel } from "../../design/Panel";
import type { Asked } from "../../state/usePolled";
import { localDate } from "../../units/time";
import { ageWords, changeWords, sourceWords } from "./history";
import { FrameLabel } from "./parts";

interface HistoryPanelProps {
  readonly history: TargetingHistory | null;
  readonly asked: Asked;
}

/** What was set when, by whom and from where; newest first. */
export function HistoryPanel({ history, asked }: HistoryPanelProps) {
  return (
    <Panel title="History" className="targeting-history" asked={asked} tools={<FrameLabel />}>
      {history !== null && history.changes.length === 0 && (
        <p className="history-empty">No change was noted yet.</p>
      )}
      {history !== null && history.changes.length > 0 && (
        <table className="table">
          <thead>
            <tr>
              <th scope="col">When</th>
              <th scope="col">By</th>
              <th scope="col">From</th>
              <th scope="col">What</th>
            </tr>
          </thead>
          <tbody>
            {history.changes.map((change) => (
              <tr key={change.record}>
                <td title={`Record ${change.record} of the audit`}>
                  {localDate(change.time)} <span className="muted">{ageWords(change.time, history.now)}</span>
                </td>
                <th scope="row">{change.user}</th>
                <td>{sourceWords(change)}</td>
                <td className="what">{changeWords(change).join("; ")}</td>
              </tr>
            ))}
          </tbody>
        </table>
      )}
    </Panel>
  );
}

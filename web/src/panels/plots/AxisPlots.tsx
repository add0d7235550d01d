import { type ReactNode, useCallback, useMemo, useState } from "react";
import type { Motor } from "../../api/client";
import { download } from "../../design/download";
import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import type { Span } from "./ChartCanvas";
import { between, csvOf, historySheet, type Sheet } from "./charts";
import type { Rows } from "./rows";
import { SheetView } from "./SheetView";
import type { History } from "./useHistory";

const spansS = [10, 30, 120] as const;
const CHART_PX = 96;

interface AxisPlotsProps {
  readonly motor: Motor;
  readonly history: History;
  readonly chooser: ReactNode;
}

/** What was shown when the operator paused. */
interface Held {
  readonly sheet: Sheet;
  readonly span: Span;
}

/** Position, error, velocity, drive and force of an axis; it follows the robot until it is paused or zoomed. */
export function AxisPlots({ motor, history, chooser }: AxisPlotsProps) {
  const { rows, asked, notice } = history;
  const [lengthS, setLengthS] = useState<number>(30);
  const [held, setHeld] = useState<Held | null>(null);
  const live = useMemo(() => (rows === null ? null : historySheet(rows, motor)), [rows, motor]);
  const newestS = live?.timeS.at(-1) ?? 0;
  const span = useMemo(
    () => held?.span ?? { fromS: newestS - lengthS, toS: newestS },
    [held, newestS, lengthS],
  );
  const sheet = held?.sheet ?? live;
  const unseen = rows === null ? 0 : unseenWithin(rows, span);
  const follow = useCallback(() => setHeld(null), []);
  const zoom = (zoomed: Span): void => {
    if (sheet !== null) setHeld({ sheet: held?.sheet ?? copyOf(sheet), span: zoomed });
  };
  const save = (): void => {
    if (sheet === null) return;
    const shown = between(sheet, span.fromS, span.toS);
    download(`${motor.name}-${shown.tick[0] ?? 0}.csv`, "text/csv", csvOf(shown));
  };
  const tools = (
    <>
      {chooser}
      <label>
        Last{" "}
        <select
          value={lengthS}
          onChange={({ target }) => {
            setLengthS(Number(target.value));
            setHeld(null);
          }}
        >
          {spansS.map((seconds) => (
            <option key={seconds} value={seconds}>
              {seconds} s
            </option>
          ))}
        </select>
      </label>
      <button
        type="button"
        className="button"
        aria-pressed={held !== null}
        disabled={sheet === null}
        onClick={() => (held === null ? zoom(span) : follow())}
      >
        {held === null ? "Pause" : "Paused · follow again"}
      </button>
      <button type="button" className="button" disabled={sheet === null} onClick={save}>
        CSV
      </button>
    </>
  );
  return (
    <Panel title="Plots" className="plots-panel" asked={asked} tools={tools}>
      {notice !== null && (
        <p className="panel-notice" role="alert">
          <NoticeText lead="No newer values:" notice={notice} />
        </p>
      )}
      {sheet !== null && (
        <SheetView
          name="history"
          sheet={sheet}
          span={span}
          height={CHART_PX}
          onZoom={zoom}
          onReset={follow}
        />
      )}
      {unseen > 0 && (
        <p className="plots-unseen">
          ▲ The app did not see {unseen} of the ticks of these times; a capture has them.
        </p>
      )}
      <p className="legend">
        Each point has the least and the greatest value of the ticks of 33 ms. Time is the kernel's: tick by
        period. Drag, or + and −, zoom and pause; a double click follows again; arrows move the cursor.
      </p>
    </Panel>
  );
}

function unseenWithin(rows: Rows, span: Span): number {
  const within = (tick: number): boolean => {
    const timeS = (tick * rows.periodUs) / 1e6;
    return span.fromS <= timeS && timeS <= span.toS;
  };
  return rows.tick.reduce((total, tick, row) => total + (within(tick) ? (rows.unseen[row] ?? 0) : 0), 0);
}

/** The history goes on in the same columns: what is held must not. */
function copyOf(sheet: Sheet): Sheet {
  return between(sheet, Number.NEGATIVE_INFINITY, Number.POSITIVE_INFINITY);
}

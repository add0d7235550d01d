import { type ReactNode, useRef, useState } from "react";
import { api, type LoadedTrajectory } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import { propose } from "../../state/commands";
import { type Notice, noticeOfProblem } from "../../state/notice";
import { useConsole } from "../../state/store";
import { usePolled } from "../../state/usePolled";
import { useReason } from "../../state/useReason";
import { formatCounts, unitName } from "../../units/units";
import { isTooFast, type WrongRow, wrongRow } from "./trajectory";

const ASK_EVERY_MS = 1000;

interface Wrong {
  readonly file: string;
  readonly notice: Notice;
  readonly row: WrongRow | null;
  /** The file's text, when all that is wrong with it is that an axis would go too fast. */
  readonly tooFast: string | null;
}

/** A motion that somebody wrote down: choose its file, see what is wrong in it, propose it. */
export function TrajectoryPanel() {
  const { value, asked, notice, refresh } = usePolled(api.trajectory, ASK_EVERY_MS);
  const [wrong, setWrong] = useState<Wrong | null>(null);
  const load = async (file: string, text: string, timing: "as_written" | "slowed_to_fit"): Promise<void> => {
    const outcome = await api.loadTrajectory(text, timing);
    setWrong(
      outcome.ok
        ? null
        : {
            file,
            notice: noticeOfProblem(outcome.problem),
            row: wrongRow(text, outcome.problem),
            tooFast: isTooFast(outcome.problem) ? text : null,
          },
    );
    await refresh();
  };
  const unload = async (): Promise<void> => {
    const outcome = await api.unloadTrajectory();
    setWrong(
      outcome.ok ? null : { file: "", notice: noticeOfProblem(outcome.problem), row: null, tooFast: null },
    );
    await refresh();
  };
  return (
    <Panel title="Trajectory file" className="trajectory-panel" asked={asked}>
      <div className="trajectory-tools">
        <FileButton onFile={async (file) => load(file.name, await file.text(), "as_written")} />
        <CommandButton
          need="holder"
          off={value === null || value.rows === 0 ? "No trajectory is loaded." : null}
          onCommand={() => propose({ kind: "trajectory" })}
        >
          Propose it
        </CommandButton>
        {value !== null && value.rows > 0 && (
          <CommandButton need="holder" className="quiet" onCommand={unload}>
            Unload
          </CommandButton>
        )}
      </div>
      {wrong !== null && (
        <WrongFile wrong={wrong}>
          {wrong.tooFast !== null && (
            <CommandButton
              need="holder"
              onCommand={() => load(wrong.file, wrong.tooFast ?? "", "slowed_to_fit")}
            >
              Slow it down to fit
            </CommandButton>
          )}
        </WrongFile>
      )}
      {notice !== null && (
        <p className="panel-notice" role="alert">
          <NoticeText lead="No answer:" notice={notice} />
        </p>
      )}
      {value !== null && <Loaded trajectory={value} />}
    </Panel>
  );
}

function FileButton({ onFile }: { readonly onFile: (file: File) => Promise<void> }) {
  const input = useRef<HTMLInputElement>(null);
  const reason = useReason("holder");
  return (
    <>
      <button
        type="button"
        className="button"
        disabled={reason !== null}
        title={reason ?? "A table with commas: time [s], then positions of axes by name and unit"}
        onClick={() => input.current?.click()}
      >
        Choose file
      </button>
      <input
        ref={input}
        type="file"
        accept=".csv,text/csv"
        className="visually-hidden"
        tabIndex={-1}
        aria-label="Trajectory file"
        onChange={({ target }) => {
          const file = target.files?.[0];
          // The same file, corrected, may be chosen again.
          target.value = "";
          if (file !== undefined) void onFile(file);
        }}
      />
    </>
  );
}

function WrongFile({
  wrong: { file, notice, row },
  children,
}: {
  readonly wrong: Wrong;
  readonly children: ReactNode;
}) {
  return (
    <div className="panel-notice" role="alert">
      <NoticeText lead={file === "" ? "Refused:" : `${file} was not loaded:`} notice={notice} />
      {row !== null && (
        <div className="wrong-row">
          <table>
            <caption>
              Line {row.line}
              {row.whole ? ", all of it" : ""}
            </caption>
            <thead>
              <tr>
                {row.cells.map(({ column }, index) => (
                  // biome-ignore lint/suspicious/noArrayIndexKey: columns may be repeated, which is one of the errors
                  <th key={index} scope="col">
                    {column}
                  </th>
                ))}
              </tr>
            </thead>
            <tbody>
              <tr>
                {row.cells.map(({ text, wrong }, index) => (
                  // biome-ignore lint/suspicious/noArrayIndexKey: as above
                  <td key={index} data-wrong={wrong || row.whole}>
                    {wrong ? `▲ ${text === "" ? "missing" : text}` : text}
                  </td>
                ))}
              </tr>
            </tbody>
          </table>
        </div>
      )}
      {children}
    </div>
  );
}

function Loaded({ trajectory }: { readonly trajectory: LoadedTrajectory }) {
  const motors = useConsole((state) => state.motors);
  if (trajectory.rows === 0) return <p className="panel-words">No trajectory is loaded.</p>;
  return (
    <div className="trajectory-loaded">
      <p>
        {trajectory.rows} rows, {trajectory.duration_s.toFixed(1)} s
        {trajectory.slowed_by > 1 && `, slowed down to ${trajectory.slowed_by.toFixed(2)} times as long`},
        loaded by {trajectory.author}
      </p>
      <ul>
        {trajectory.axes.map(({ slot, name, lowest, highest, top_speed }) => {
          const motor = motors.find((each) => each.slot === slot);
          if (motor === undefined) return <li key={slot}>{name}</li>;
          const shown = (position: number): string =>
            formatCounts(motor, Math.round(position * motor.counts_per_unit));
          const speed = motor.unit === "rad" ? (top_speed * 180) / Math.PI : top_speed;
          return (
            <li key={slot}>
              <strong>{motor.title}</strong> {shown(lowest)} to {shown(highest)}, at most {speed.toFixed(1)}{" "}
              {unitName(motor)}/s
            </li>
          );
        })}
      </ul>
    </div>
  );
}

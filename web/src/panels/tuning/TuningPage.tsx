import { useEffect, useId, useState } from "react";
import { api, type Motor, type Proposal, type RobotFileChange } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { download } from "../../design/download";
import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import { ReasonLine } from "../../design/ReasonLine";
import { propose } from "../../state/commands";
import { type Notice, noticeOfProblem } from "../../state/notice";
import { isOpen } from "../../state/proposals";
import { useConsole } from "../../state/store";
import { formatCounts } from "../../units/units";
import { LivePage } from "../cover/LivePage";
import { ProposalCommands, StateChip } from "../proposals/ProposalParts";
import { progressOf } from "../proposals/progress";
import { BOTTOM, figuresOf, HEIGHT, LEFT, type Measured, speedPlot, WIDTH } from "./measured";
import "./tuning.css";

/** What the mechanics of an axis do, measured under the pedal, and what follows for the robot's file. */
export default function TuningPage() {
  const motors = useConsole((state) => state.motors);
  const newest = useConsole((state) => state.proposals.find(({ kind }) => kind === "identify"));
  const motor = motors.find(({ slot }) => slot === newest?.slot);
  return (
    <LivePage className="tuning-page">
      <div className="side">
        <AskPanel motors={motors} busy={newest !== undefined && isOpen(newest)} />
        {newest !== undefined && <RunPanel proposal={newest} motor={motor} />}
      </div>
      <div className="main-column">
        {newest?.measured != null && motor !== undefined && (
          <FiguresPanel measured={newest.measured} motor={motor} whole={newest.state === "done"} />
        )}
        {newest?.state === "done" && <FilePanel key={newest.id} id={newest.id} />}
      </div>
    </LivePage>
  );
}

interface AskProps {
  readonly motors: readonly Motor[];
  readonly busy: boolean;
}

function AskPanel({ motors, busy }: AskProps) {
  const notice = useConsole((state) => state.notices.robot);
  const [chosen, setChosen] = useState<string | null>(null);
  const [cleared, setCleared] = useState(false);
  const axisId = useId();
  const axis = chosen ?? motors[0]?.name;
  const ask = async (): Promise<void> => {
    // Said for this measurement, not for the next one.
    setCleared(false);
    if (axis !== undefined) await propose({ kind: "identify", axis, cleared: true });
  };
  const off = busy ? "One is open already." : cleared ? null : "Say first that the robot is clear.";
  return (
    <Panel title="Measure an axis" className="tuning-ask">
      <ReasonLine need="holder" />
      {notice !== undefined && (
        <p className="panel-notice" role="alert">
          <NoticeText lead="Refused:" notice={notice} />
        </p>
      )}
      <div className="tuning-form">
        <p className="tuning-line">
          <label htmlFor={axisId}>Axis</label>
          <select id={axisId} value={axis} onChange={({ target }) => setChosen(target.value)}>
            {motors.map(({ name, title }) => (
              <option key={name} value={name}>
                {title}
              </option>
            ))}
          </select>
        </p>
        <p className="muted">
          While the pedal is held, the homed axis moves to and fro in the middle of its range, some ninety
          times and at up to its <strong>largest drive</strong>. That takes one to two minutes. Release the
          pedal to pause; a move that was interrupted is measured again. Every other axis has to stand still,
          the probe out as far as it goes, and no case may be open or suspended.
        </p>
        <label className="tuning-clear">
          <input type="checkbox" checked={cleared} onChange={({ target }) => setCleared(target.checked)} />
          <span>
            No patient is at the robot, needle and probe are taken off, and nobody’s hands are near the axis.
          </span>
        </label>
        <CommandButton need="holder" className="primary" off={off} onCommand={ask}>
          Propose measurement
        </CommandButton>
      </div>
    </Panel>
  );
}

interface RunProps {
  readonly proposal: Proposal;
  readonly motor: Motor | undefined;
}

function RunPanel({ proposal, motor }: RunProps) {
  const { id, state, detail, lowest_counts: low, highest_counts: high } = proposal;
  const progress = progressOf(proposal, { motor, robot: null, fromCounts: undefined, nowCounts: undefined });
  return (
    <Panel title={`Measurement ${id}`}>
      <div className="tuning-run">
        <p className="proposal-head">
          <strong>{motor?.title ?? proposal.axis}</strong>
          <StateChip state={state} />
        </p>
        <p>{detail}</p>
        {motor !== undefined && low !== undefined && high !== undefined && (
          <p className="muted">
            Between {formatCounts(motor, low)} and {formatCounts(motor, high)}.
          </p>
        )}
        {progress !== null && (
          <p className="tuning-progress">
            <progress max="1" value={progress.share} aria-label="Progress of the measurement" />
            <span>{progress.words}</span>
          </p>
        )}
        <p className="proposal-commands">
          <ProposalCommands proposal={proposal} />
        </p>
      </div>
    </Panel>
  );
}

interface FiguresProps {
  readonly measured: Measured;
  readonly motor: Motor;
  readonly whole: boolean;
}

function FiguresPanel({ measured, motor, whole }: FiguresProps) {
  return (
    <Panel title="Speed over drive">
      <SpeedFigure measured={measured} motor={motor} />
      {whole ? (
        <table className="table tuning-figures" aria-label={`What ${motor.title} does`}>
          <tbody>
            {figuresOf(measured, motor).map(({ name, value, meaning }) => (
              <tr key={name}>
                <th scope="row">
                  {name} <small className="muted">{meaning}</small>
                </th>
                <td className="number">{value}</td>
              </tr>
            ))}
          </tbody>
        </table>
      ) : (
        <p className="tuning-words">The figures follow once every drive was measured.</p>
      )}
    </Panel>
  );
}

function SpeedFigure({ measured, motor }: Omit<FiguresProps, "whole">) {
  const plot = speedPlot(measured, motor.max_drive);
  const words = measured.speeds
    .map(
      ({ drive, up_counts_per_s: up, down_counts_per_s: down }) =>
        `${((100 * drive) / motor.max_drive).toFixed(1)} %: ${up.toFixed(0)} up, ${down.toFixed(0)} down`,
    )
    .join("; ");
  return (
    <figure className="tuning-plot">
      <figcaption>
        counts/s over drive <span className="tuning-up">+ up</span>{" "}
        <span className="tuning-down">○ down</span>{" "}
        {plot.line !== null && <span className="tuning-fit">╌ line</span>}
      </figcaption>
      <svg
        viewBox={`0 0 ${WIDTH} ${HEIGHT}`}
        role="img"
        aria-label={`Speed of ${motor.title} by drive: ${words}`}
      >
        {plot.speeds.map(({ y, words: speed }, index) => (
          // biome-ignore lint/suspicious/noArrayIndexKey: always as many.
          <g key={index}>
            <line className="tuning-grid" x1={LEFT} x2={WIDTH - 12} y1={y} y2={y} />
            <text className="tuning-number" x={LEFT - 6} y={y + 4} textAnchor="end">
              {speed}
            </text>
          </g>
        ))}
        {plot.drives.map(({ x, words: drive }) => (
          <text key={drive} className="tuning-number" x={x} y={HEIGHT - BOTTOM + 18} textAnchor="middle">
            {drive}
          </text>
        ))}
        {plot.line !== null && (
          <line
            className="tuning-fit-line"
            x1={plot.line[0].x}
            y1={plot.line[0].y}
            x2={plot.line[1].x}
            y2={plot.line[1].y}
          />
        )}
        {plot.down.map(({ x, y }, index) => (
          // biome-ignore lint/suspicious/noArrayIndexKey: marks are only ever added, and two may lie in one place.
          <circle key={index} className="tuning-down-mark" cx={x} cy={y} r="5" />
        ))}
        {plot.up.map(({ x, y }, index) => (
          // biome-ignore lint/suspicious/noArrayIndexKey: as above.
          <path key={index} className="tuning-up-mark" d={`M${x - 4} ${y}h8M${x} ${y - 4}v8`} />
        ))}
      </svg>
    </figure>
  );
}

/** Asked for once: what was measured does not change any more. */
function FilePanel({ id }: { readonly id: number }) {
  const [change, setChange] = useState<RobotFileChange | null>(null);
  const [notice, setNotice] = useState<Notice | null>(null);
  useEffect(() => {
    void api.robotFile(id).then((outcome) => {
      if (outcome.ok) setChange(outcome.value);
      else setNotice(noticeOfProblem(outcome.problem));
    });
  }, [id]);
  return (
    <Panel title="What follows for the robot’s file" className="tuning-file">
      {notice !== null && (
        <p className="panel-notice" role="alert">
          <NoticeText lead="Refused:" notice={notice} />
        </p>
      )}
      {change !== null && <FileChange change={change} />}
    </Panel>
  );
}

function FileChange({ change }: { readonly change: RobotFileChange }) {
  const { name, changes, text, diff, problem } = change;
  if (changes.length === 0) return <p className="tuning-words">The file fits the axis: no number differs.</p>;
  return (
    <>
      <table className="table" aria-label="Numbers that should differ">
        <thead>
          <tr>
            <th scope="col">Number</th>
            <th scope="col" className="number">
              Was
            </th>
            <th scope="col" className="number">
              Is
            </th>
          </tr>
        </thead>
        <tbody>
          {changes.map(({ key, was, is }) => (
            <tr key={key}>
              <th scope="row">{key}</th>
              <td className="number">{was}</td>
              <td className="number">{is}</td>
            </tr>
          ))}
        </tbody>
      </table>
      {problem !== null && (
        <p className="panel-notice" role="alert">
          The kernel would refuse such a file, so there is none: {problem}
        </p>
      )}
      {text !== null && (
        <>
          {/* biome-ignore lint/a11y/noNoninteractiveTabindex: long lines are scrolled by keys too. */}
          <section className="tuning-diff" aria-label="Difference" tabIndex={0}>
            <pre>
              {diff.split("\n").map((line, index) => (
                // biome-ignore lint/suspicious/noArrayIndexKey: a text that never changes.
                <span key={index} data-sign={line.charAt(0)}>
                  {`${line}\n`}
                </span>
              ))}
            </pre>
          </section>
          <p className="tuning-words">
            The running robot goes on with its own file. Whoever answers for the robot reads the difference;
            the file is in force once it is in place and the robot is started with it.
          </p>
          <p className="tuning-downloads">
            <button
              type="button"
              className="button primary"
              onClick={() => download(name, "application/toml", text)}
            >
              Download {name}
            </button>
            <button
              type="button"
              className="button"
              onClick={() => download(`${name}.diff`, "text/x-diff", diff)}
            >
              Download the difference
            </button>
          </p>
        </>
      )}
    </>
  );
}

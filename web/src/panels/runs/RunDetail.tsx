import { useId, useMemo, useState } from "react";
import { api, type ListedRun, type Run, type RunAxis } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { download } from "../../design/download";
import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import { type Notice, noticeOfProblem } from "../../state/notice";
import { proposalHash, runHash } from "../../state/route";
import { useConsole } from "../../state/store";
import { useKept } from "../../state/useKept";
import { useReason } from "../../state/useReason";
import { localDate, localTime } from "../../units/time";
import type { Span } from "../plots/ChartCanvas";
import { SheetView } from "../plots/SheetView";
import { Code, Fact } from "../proposals/ProposalDetail";
import { StateChip, sourceWord } from "../proposals/ProposalParts";
import {
  largestError,
  missCounts,
  placeWords,
  runSheet,
  sizeWords,
  titleOf,
  type WholeRun,
  wholeSpan,
} from "./runs";
import { useRun } from "./useRuns";

/** One or two charts have room to be tall. */
const [TALL_PX, LOW_PX, MOST_TALL] = [220, 120, 2];
const MOST_OF_NOTE = 1000;

interface RunDetailProps {
  readonly id: number;
  /** The run that it is compared with. */
  readonly other: number | null;
  /** The runs that it can be compared with. */
  readonly choices: readonly ListedRun[];
  readonly onNote: () => Promise<void>;
}

/** One run as a whole: what was planned, what was done, what became of it, and another one beside it. */
export function RunDetail({ id, other, choices, onNote }: RunDetailProps) {
  const first = useRun(id);
  const second = useRun(other);
  const compared = second.value?.run.id === other ? second.value : null;
  const [refusal, setRefusal] = useState<Notice | null>(null);
  const save = async (): Promise<void> => {
    const answer = await api.runTable(id);
    setRefusal(answer.ok ? null : noticeOfProblem(answer.problem));
    if (answer.ok) download(`run-${id}.csv`, "text/csv", answer.value);
  };
  const notice = refusal ?? first.notice ?? second.notice;
  const tools = (
    <>
      <ProposalLink id={id} />
      <CommandButton need="viewer" label={`CSV of run ${id}`} onCommand={save}>
        CSV
      </CommandButton>
    </>
  );
  return (
    <Panel title={`Run ${id}`} className="run-detail" asked={first.asked} tools={tools}>
      {notice !== null && (
        <p className="panel-notice" role="alert">
          <NoticeText lead="No answer:" notice={notice} />
        </p>
      )}
      {first.value !== null && (
        <>
          <p className="detail-wish">
            <span>
              <strong>{titleOf(first.value.run)}</strong>
            </span>
            <StateChip state={first.value.run.outcome} />
          </p>
          <Facts run={first.value.run} />
          <Note
            run={first.value.run}
            onSaved={async () => void (await Promise.all([first.refresh(), onNote()]))}
          />
          <section className="detail-part" aria-label="Planned and actual">
            <div className="run-part-head">
              <h3>Planned and actual</h3>
              <Comparing id={id} other={other} choices={choices} />
            </div>
            <Charts run={first.value} other={compared} />
          </section>
          <section className="detail-part" aria-label="Numbers">
            <h3>Numbers</h3>
            <Numbers run={first.value.run} other={compared?.run ?? null} />
          </section>
        </>
      )}
    </Panel>
  );
}

/** Leads to the proposal of the same number, for as long as the app has it. */
function ProposalLink({ id }: { readonly id: number }) {
  const known = useConsole((state) => state.proposals.some((proposal) => proposal.id === id));
  if (!known) return null;
  return (
    <a className="button" href={proposalHash("proposals", id)}>
      Proposal {id}
    </a>
  );
}

function Facts({ run }: { readonly run: Run }) {
  const { author, begun, ended, kept, duration_s, verdict, detail, aim, recordings } = run;
  return (
    <dl className="detail-facts">
      <Fact name="Begun">
        <time dateTime={begun}>{localDate(begun)}</time>
      </Fact>
      {ended !== null && (
        <Fact name="Ended">
          <time dateTime={ended}>{localTime(ended)}</time>
        </Fact>
      )}
      {ended === null && <Fact name="Followed until">{localTime(kept)}</Fact>}
      {duration_s !== null && <Fact name="Duration">{duration_s.toFixed(1)} s</Fact>}
      <Fact name="Author">{author}</Fact>
      <Fact name="Source">{sourceWord(run)}</Fact>
      <Fact name="Case">
        {run.case === null ? (
          "none"
        ) : (
          <a className="code-link" href="#/targeting">
            Case {run.case}
          </a>
        )}
      </Fact>
      <Fact name="Largest deviation">{largestError(run.axes) ?? "none: not planned in time"}</Fact>
      {aim !== null && (
        <Fact name="Misses the aim by">
          {aim.deviation.distance_mm.toFixed(2)} mm and {aim.deviation.angle_deg.toFixed(2)}°
        </Fact>
      )}
      <Fact name="Outcome">{detail === "" ? run.outcome : detail}</Fact>
      {verdict !== null && (
        <Fact name="Verdict">
          <Code code={verdict} />
        </Fact>
      )}
      <Fact name="Black box">
        {recordings.length === 0 ? (
          "no recording"
        ) : (
          <ul className="run-recordings">
            {recordings.map((name) => (
              <li key={name}>
                <code>{name}</code>
              </li>
            ))}
          </ul>
        )}
      </Fact>
    </dl>
  );
}

interface NoteProps {
  readonly run: Run;
  readonly onSaved: () => Promise<void>;
}

/** What somebody wrote about it. What is typed stays until it is saved. */
function Note({ run, onSaved }: NoteProps) {
  // Empty: nothing was typed, so that what others write is shown.
  const [typed, keepTyped] = useKept(`run-note-${run.id}`, "");
  const draft = typed === "" ? run.note : typed.slice(1);
  const [notice, setNotice] = useState<Notice | null>(null);
  const reason = useReason("engineer");
  const hintId = useId();
  if (reason !== null)
    return (
      <dl className="detail-facts">
        <Fact name="Note">{run.note === "" ? "none" : run.note}</Fact>
      </dl>
    );
  const save = async (): Promise<void> => {
    const answer = await api.setRunNote(run.id, draft.trim());
    setNotice(answer.ok ? null : noticeOfProblem(answer.problem));
    if (!answer.ok) return;
    await onSaved();
    keepTyped("");
  };
  return (
    <div className="run-note">
      <label>
        Note{" "}
        <input
          className="text"
          value={draft}
          maxLength={MOST_OF_NOTE}
          autoComplete="off"
          aria-describedby={hintId}
          onChange={({ target }) => keepTyped(`=${target.value}`)}
        />
      </label>
      <CommandButton
        need="engineer"
        off={draft.trim() === run.note ? "The note is kept as it stands here." : null}
        onCommand={save}
      >
        Save note
      </CommandButton>
      <small id={hintId} className="muted">
        One line. No patient data.
      </small>
      {notice !== null && (
        <p className="panel-notice" role="alert">
          <NoticeText lead="Refused:" notice={notice} />
        </p>
      )}
    </div>
  );
}

/** Leads to the same run beside another one. */
function Comparing({ id, other, choices }: Omit<RunDetailProps, "onNote">) {
  const known = choices.filter((run) => run.id !== id);
  const lost = other !== null && !known.some((run) => run.id === other);
  return (
    <label>
      Compare with{" "}
      <select
        value={other ?? ""}
        onChange={({ target }) => {
          window.location.hash = runHash(id, target.value === "" ? null : Number(target.value));
        }}
      >
        <option value="">none</option>
        {lost && <option value={other}>#{other}</option>}
        {known.map((run) => (
          <option key={run.id} value={run.id}>
            {`#${run.id} ${titleOf(run)}, ${localDate(run.begun)}`}
          </option>
        ))}
      </select>
    </label>
  );
}

interface ChartsProps {
  readonly run: WholeRun;
  readonly other: WholeRun | null;
}

function Charts({ run, other }: ChartsProps) {
  const [kept, keepHidden] = useKept("runs-hidden-axes", "");
  const hidden = useMemo(() => new Set(kept.split(" ")), [kept]);
  const [zoomed, setZoomed] = useState<Span | null>(null);
  const [deviation, keepDeviation] = useKept("runs-deviation", "");
  const sheet = useMemo(
    () => runSheet(run, other, hidden, deviation !== ""),
    [run, other, hidden, deviation],
  );
  const whole = useMemo(() => wholeSpan(other === null ? [run] : [run, other]), [run, other]);
  const toggle = (axis: string): void => {
    const wanted = new Set(hidden);
    if (!wanted.delete(axis)) wanted.add(axis);
    keepHidden([...wanted].join(" "));
  };
  const { basis, why } = run.samples.plan;
  return (
    <>
      <fieldset className="run-axes" aria-label="Axes that are drawn">
        {run.run.axes.map(({ axis, title }) => (
          <button
            key={axis}
            type="button"
            className="button small"
            aria-pressed={!hidden.has(axis)}
            onClick={() => toggle(axis)}
          >
            {title}
          </button>
        ))}
        <button
          type="button"
          className="button small"
          aria-pressed={deviation !== ""}
          onClick={() => keepDeviation(deviation === "" ? "shown" : "")}
        >
          Deviation
        </button>
        {zoomed !== null && (
          <button type="button" className="button small" onClick={() => setZoomed(null)}>
            Whole run
          </button>
        )}
      </fieldset>
      {sheet.charts.length === 0 ? (
        <p className="plan-words">No axis is drawn: press the name of one.</p>
      ) : (
        <SheetView
          name="run"
          sheet={sheet}
          span={zoomed ?? whole}
          height={sheet.charts.length > MOST_TALL ? LOW_PX : TALL_PX}
          onZoom={setZoomed}
          onReset={() => setZoomed(null)}
        />
      )}
      <p className="plan-words">
        Time is since the begin{other !== null && " of each run"}; pauses are not in the plan.{" "}
        {basis !== "time" && `Not planned in time: drawn is what was commanded. ${why ?? ""} `}
        Drag, or + and −, zoom; a double click shows all; arrows move the cursor.
      </p>
    </>
  );
}

interface NumbersProps {
  readonly run: Run;
  readonly other: Run | null;
}

/** Each axis in numbers; of two runs, below each other. */
function Numbers({ run, other }: NumbersProps) {
  const names = [...new Set([...run.axes, ...(other?.axes ?? [])].map(({ axis }) => axis))];
  const runs = other === null ? [run] : [run, other];
  return (
    // biome-ignore lint/a11y/noNoninteractiveTabindex: a narrow page scrolls it by the arrow keys.
    <section className="run-numbers" aria-label="Numbers of each axis" tabIndex={0}>
      <table className="table">
        <thead>
          <tr>
            <th scope="col">Axis</th>
            {other !== null && <th scope="col">Run</th>}
            {["Begin", "Target", "End", "Off target", "Largest deviation", "RMS deviation"].map((title) => (
              <th key={title} scope="col" className="number">
                {title}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {names.flatMap((name) =>
            runs.map(({ id, axes }) => {
              const axis = axes.find((each) => each.axis === name);
              return (
                <tr key={`${name} ${id}`}>
                  <th scope="row">{axis?.title ?? name}</th>
                  {other !== null && <td data-other={id === other.id || undefined}>#{id}</td>}
                  {axis === undefined ? <td colSpan={6}>not moved</td> : <AxisNumbers axis={axis} />}
                </tr>
              );
            }),
          )}
        </tbody>
      </table>
    </section>
  );
}

function AxisNumbers({ axis }: { readonly axis: RunAxis }) {
  const cells = [
    placeWords(axis, axis.begin_counts),
    placeWords(axis, axis.target_counts),
    placeWords(axis, axis.end_counts),
    sizeWords(axis, missCounts(axis)),
    sizeWords(axis, axis.largest_error_counts),
    sizeWords(axis, axis.rms_error_counts),
  ];
  return cells.map((words, place) => (
    // biome-ignore lint/suspicious/noArrayIndexKey: the columns stay where they are.
    <td key={place} className="number">
      {words}
    </td>
  ));
}

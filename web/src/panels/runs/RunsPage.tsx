import { useMemo } from "react";
import { api, type ListedRun } from "../../api/client";
import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import { runHash, useRunPlace } from "../../state/route";
import { useConsole } from "../../state/store";
import { useKept } from "../../state/useKept";
import { usePolled } from "../../state/usePolled";
import { localDate } from "../../units/time";
import { StateChip } from "../proposals/ProposalParts";
import { Retention } from "./Retention";
import { RunDetail } from "./RunDetail";
import { type Filter, filterOf, kinds, largestError, noFilter, outcomes, titleOf } from "./runs";
import { type ListedRuns, useRuns } from "./useRuns";
import "../plots/plots.css";
import "../proposals/proposals.css";
import "../proposals/detail.css";
import "./runs.css";

const CASES_EVERY_MS = 10_000;

/** Every motion that was carried out, and one of them as a whole: the one that the address names, else the newest. */
export default function RunsPage() {
  const [kept, keepFilter] = useKept("runs-filter", "");
  const filter = useMemo(() => filterOf(kept), [kept]);
  const listed = useRuns(filter);
  const place = useRunPlace();
  const shown = place?.id ?? listed.runs[0]?.id;
  return (
    <main className="sheet runs-page">
      <RunsPanel
        listed={listed}
        shown={shown}
        filter={filter}
        onFilter={(wanted) => keepFilter(new URLSearchParams({ ...wanted }).toString())}
      />
      {shown !== undefined && (
        <RunDetail
          key={shown}
          id={shown}
          other={place?.other ?? null}
          choices={listed.runs}
          onNote={listed.refresh}
        />
      )}
      {listed.retention !== null && <Retention retention={listed.retention} onSet={listed.refresh} />}
    </main>
  );
}

interface RunsPanelProps {
  readonly listed: ListedRuns;
  readonly shown: number | undefined;
  readonly filter: Filter;
  readonly onFilter: (filter: Filter) => void;
}

function RunsPanel({ listed, shown, filter, onFilter }: RunsPanelProps) {
  const { runs, more, asked, notice, older } = listed;
  const known = asked.answeredAtMs !== null;
  return (
    <Panel title="Runs" asked={asked}>
      <FilterBar filter={filter} onFilter={onFilter} />
      {notice !== null && (
        <p className="panel-notice" role="alert">
          <NoticeText lead="No answer:" notice={notice} />
        </p>
      )}
      {known && runs.length === 0 && <Nothing filter={filter} onFilter={onFilter} />}
      <ol className="all-proposals all-runs">
        {runs.map((run) => (
          <RunLine key={run.id} run={run} shown={run.id === shown} />
        ))}
      </ol>
      {more && (
        <button type="button" className="button runs-older" onClick={() => void older()}>
          Older runs
        </button>
      )}
    </Panel>
  );
}

function Nothing({ filter, onFilter }: Pick<RunsPanelProps, "filter" | "onFilter">) {
  if (Object.values(filter).some((value) => value !== ""))
    return (
      <p className="runs-words">
        No run fits these choices.{" "}
        <button type="button" className="button small" onClick={() => onFilter(noFilter)}>
          Show all runs
        </button>
      </p>
    );
  return (
    <p className="runs-words">
      No motion was carried out yet. Propose one on the page{" "}
      <a className="code-link" href="#/robot">
        Robot
      </a>{" "}
      or{" "}
      <a className="code-link" href="#/proposals">
        Proposals
      </a>
      , approve it and hold the pedal: it is kept here.
    </p>
  );
}

interface FilterBarProps {
  readonly filter: Filter;
  readonly onFilter: (filter: Filter) => void;
}

function FilterBar({ filter, onFilter }: FilterBarProps) {
  const motors = useConsole((state) => state.motors);
  const { value: cases } = usePolled(api.listCases, CASES_EVERY_MS);
  const choose = (name: keyof Filter, title: string, choices: readonly (readonly [string, string])[]) => {
    const lost = filter[name] !== "" && !choices.some(([value]) => value === filter[name]);
    return (
      <label>
        {title}{" "}
        <select value={filter[name]} onChange={({ target }) => onFilter({ ...filter, [name]: target.value })}>
          <option value="">all</option>
          {[...choices, ...(lost ? [[filter[name], filter[name]] as const] : [])].map(([value, words]) => (
            <option key={value} value={value}>
              {words}
            </option>
          ))}
        </select>
      </label>
    );
  };
  return (
    <search className="runs-filter" aria-label="Which runs">
      {choose("case", "Case", [
        ["0", "none"],
        ...(cases ?? []).map(({ number, label }) => [`${number}`, `${number} ${label ?? ""}`] as const),
      ])}
      {choose(
        "outcome",
        "Outcome",
        outcomes.map((outcome) => [outcome, outcome]),
      )}
      {choose("kind", "Kind", Object.entries(kinds))}
      {choose(
        "axis",
        "Axis",
        motors.map(({ name, title }) => [name, title]),
      )}
    </search>
  );
}

function RunLine({ run, shown }: { readonly run: ListedRun; readonly shown: boolean }) {
  const { id, outcome, begun, duration_s, axes, note, case: number } = run;
  const error = largestError(axes);
  return (
    <li>
      <a href={runHash(id)} aria-current={shown ? "true" : undefined}>
        <span className="proposal-head">
          <span>
            <span className="number">#{id}</span> <strong>{titleOf(run)}</strong>
          </span>
          <StateChip state={outcome} />
        </span>
        <span className="proposal-from">
          <time dateTime={begun}>{localDate(begun)}</time>
          {duration_s !== null && ` · ${duration_s.toFixed(1)} s`}
          {number !== null && ` · Case ${number}`}
        </span>
        <span className="proposal-from">
          {error === null ? "not planned in time" : `largest deviation ${error}`}
        </span>
        {note !== "" && <span className="run-note-begin">✎ {note}</span>}
      </a>
    </li>
  );
}

import type { AlignmentView, TargetingHistory } from "../../api/client";
import { Panel } from "../../design/Panel";
import type { Asked } from "../../state/usePolled";
import { fixed, list } from "./numbers";
import { FRAME, FrameLabel, SetBy } from "./parts";
import { columnNames, type Deviation, deviationOf, rowNames } from "./pose";

interface PosesPanelProps {
  readonly view: AlignmentView | null;
  /** As an imager reported it. */
  readonly reported: readonly number[] | null;
  readonly history: TargetingHistory | null;
  readonly asked: Asked;
}

/** Where the treatment point is, could be, and is to be, and how far these are apart. Nothing here can be edited. */
export function PosesPanel({ view, reported, history, asked }: PosesPanelProps) {
  const alignment = view?.alignment ?? null;
  const current = view?.current ?? null;
  const desiredWords = wordsOf(view?.alignment_problem) ?? "Not known yet.";
  const currentWords = wordsOf(view?.current_problem) ?? "Not known yet.";
  return (
    <Panel title="Poses of the treatment point" className="poses" asked={asked} tools={<FrameLabel />}>
      <div className="pose-row">
        <Pose name="Current" from="by the encoders" pose={current} otherwise={currentWords}>
          {view?.current_deviation != null && (
            <ErrorLine name="current" from="desired" deviation={view.current_deviation} />
          )}
          {current !== null && alignment !== null && (
            <ErrorLine
              name="current"
              from="reachable"
              deviation={deviationOf(current, alignment.reachable)}
            />
          )}
        </Pose>
        <Pose
          name="Desired"
          from="as entry and target ask"
          pose={alignment?.desired ?? null}
          otherwise={desiredWords}
        />
        <Pose
          name="Reachable"
          from="where the setpoints lead"
          pose={alignment?.reachable ?? null}
          otherwise={desiredWords}
        >
          {alignment !== null && (
            <ErrorLine name="reachable" from="desired" deviation={alignment.deviation} />
          )}
        </Pose>
        <Pose
          name="Reported"
          from="by an imager; moves nothing"
          pose={reported}
          otherwise="No imager reported a pose."
        >
          {reported !== null && <SetBy history={history} field="reported_position" unset="" isSet />}
          {reported !== null && current !== null && (
            <ErrorLine name="reported" from="current" deviation={deviationOf(reported, current)} />
          )}
        </Pose>
      </div>
    </Panel>
  );
}

function wordsOf(problem: AlignmentView["current_problem"] | undefined): string | null {
  return problem == null ? null : `${problem.code}: ${problem.text}`;
}

interface PoseProps {
  readonly name: string;
  readonly from: string;
  readonly pose: readonly number[] | null;
  readonly otherwise: string;
  readonly children?: React.ReactNode;
}

function Pose({ name, from, pose, otherwise, children }: PoseProps) {
  return (
    <section className="pose" aria-label={`${name} pose`}>
      <h3>
        {name} <span className="muted">{from}</span>
      </h3>
      {pose === null ? (
        <p className="pose-missing">
          <i aria-hidden="true">▲</i> {otherwise}
        </p>
      ) : (
        <PoseTable name={name} pose={pose} />
      )}
      {children}
    </section>
  );
}

function PoseTable({ name, pose }: { readonly name: string; readonly pose: readonly number[] }) {
  return (
    <table className="matrix">
      <caption className="visually-hidden">
        {name} pose, {FRAME}
      </caption>
      <thead>
        <tr>
          <td />
          {columnNames.map((column) => (
            <th key={column} scope="col">
              {column}
              {column === "origin" && ", mm"}
            </th>
          ))}
        </tr>
      </thead>
      <tbody>
        {rowNames.map((row, at) => (
          <tr key={row}>
            <th scope="row">{row}</th>
            {columnNames.map((column, place) => (
              <td key={column}>{fixed(pose[4 * at + place] ?? 0, place === 3 ? 2 : 4)}</td>
            ))}
          </tr>
        ))}
        <tr className="last-row">
          <td />
          <td>0</td>
          <td>0</td>
          <td>0</td>
          <td>1</td>
        </tr>
      </tbody>
    </table>
  );
}

interface ErrorLineProps {
  readonly name: string;
  readonly from: string;
  readonly deviation: Deviation;
}

/** The distance of two poses in mm and degrees, and its parts in the scanner's directions. */
function ErrorLine({ name, from, deviation }: ErrorLineProps) {
  return (
    <p className="pose-error">
      <span className="muted">from {from}</span>{" "}
      <output aria-label={`Error of the ${name} pose from the ${from} one`}>
        {fixed(deviation.distance_mm, 2)} mm, {fixed(deviation.angle_deg, 2)}°
      </output>{" "}
      <span className="muted">RAS {list(deviation.offset_mm, 2)}</span>
    </p>
  );
}

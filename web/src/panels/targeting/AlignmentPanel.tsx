import { useState } from "react";
import { type Alignment, type AlignmentView, api, type Motor, type ProposalDraft } from "../../api/client";
import { CodeLink } from "../../design/CodeLink";
import { CommandButton } from "../../design/CommandButton";
import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import { useKernel } from "../../kernel/useKernel";
import { isVerdict, type Notice, noticeOfProblem } from "../../state/notice";
import { openPath } from "../../state/proposals";
import { useConsole } from "../../state/store";
import type { Asked } from "../../state/usePolled";
import type { AxisFrame } from "../../stream/decode";
import { formatCounts, formatNumber } from "../../units/units";
import { errorBudgetWords } from "../proposals/errorBudget";
import { ProposalCommands } from "../proposals/ProposalParts";
import { type AxisLine, axisLines, hindrances } from "./alignment";
import { fixed } from "./numbers";

interface AlignmentPanelProps {
  readonly view: AlignmentView | null;
  readonly asked: Asked;
  /** False where the page has the button elsewhere. */
  readonly retracts?: boolean;
}

/** What entry and target ask of each axis, and the move that brings them there. */
export function AlignmentPanel({ view, asked, retracts = true }: AlignmentPanelProps) {
  const alignment = view?.alignment ?? null;
  const problem = view?.alignment_problem ?? null;
  return (
    <Panel title="Alignment" className="alignment" asked={asked}>
      {problem !== null && (
        <p className="pose-missing">
          <i aria-hidden="true">▲</i> <strong>{problem.code}</strong>: {problem.text}
        </p>
      )}
      {alignment !== null && <Asks alignment={alignment} />}
      <Propose alignment={alignment} retracts={retracts} />
    </Panel>
  );
}

function Asks({ alignment }: { readonly alignment: Alignment }) {
  const motors = useConsole((state) => state.motors);
  return (
    <table className="table">
      <caption className="visually-hidden">What the alignment asks of each axis</caption>
      <thead>
        <tr>
          <th scope="col">Axis</th>
          <th scope="col" className="number">
            Now
          </th>
          <th scope="col" className="number">
            Asked
          </th>
          <th scope="col" className="number">
            Range
          </th>
        </tr>
      </thead>
      <tbody>
        {axisLines(alignment, motors).map((line) => (
          <Ask key={line.motor.slot} line={line} />
        ))}
      </tbody>
    </table>
  );
}

function Ask({ line: { motor, counts, clamped } }: { readonly line: AxisLine }) {
  const axis = useConsole((state) => state.frame?.axes[motor.slot]);
  return (
    <tr data-clamped={clamped}>
      <th scope="row">{motor.title}</th>
      <td className="number">{axis === undefined ? "–" : nowWords(motor, axis)}</td>
      <td className="number asked">
        {formatCounts(motor, counts)}
        {clamped && <span className="chip medium">▲ clamped</span>}
      </td>
      <td className="number muted">
        {formatNumber(motor, motor.soft_min_counts)} to {formatNumber(motor, motor.soft_max_counts)}
      </td>
    </tr>
  );
}

/** A count without reference is no position. */
function nowWords(motor: Motor, axis: AxisFrame): string {
  return axis.homed ? formatCounts(motor, axis.positionCounts) : "unhomed";
}

interface ProposeProps {
  readonly alignment: Alignment | null;
  readonly retracts: boolean;
}

function Propose({ alignment, retracts }: ProposeProps) {
  const motors = useConsole((state) => state.motors);
  const [insert, setInsert] = useState(false);
  const [refusal, setRefusal] = useState<Notice | null>(null);
  const [proposed, setProposed] = useState<number | null>(null);
  const send = async (draft: ProposalDraft): Promise<void> => {
    const outcome = await api.propose(draft);
    setRefusal(outcome.ok ? null : noticeOfProblem(outcome.problem));
    setProposed(outcome.ok ? outcome.value.id : null);
  };
  const propose = (pose: NonNullable<ProposalDraft["pose"]>): Promise<void> => {
    const accepted =
      alignment === null || pose === "desired"
        ? {}
        : { accepted_mm: alignment.deviation.distance_mm, accepted_deg: alignment.deviation.angle_deg };
    return send({ kind: "pose", pose, insert, ...accepted });
  };
  const clamped = alignment === null ? [] : axisLines(alignment, motors).filter((line) => line.clamped);
  const none = alignment === null ? "There is no alignment." : null;
  const isMissed = alignment?.within_tolerance === false;
  const miss =
    alignment === null
      ? ""
      : `${fixed(alignment.deviation.distance_mm, 2)} mm and ${fixed(alignment.deviation.angle_deg, 2)}°`;
  return (
    <div className="propose">
      {alignment !== null && <Hindrances alignment={alignment} />}
      {clamped.length > 0 && (
        <p className="clamped">
          <i aria-hidden="true">▲</i> {isMissed && "The desired pose would be refused, UNREACHABLE: "}
          {clamped.map(({ motor }) => motor.title).join(", ")} {clamped.length === 1 ? "ends" : "end"} before
          it.
        </p>
      )}
      {alignment !== null && (
        <p className={isMissed ? "clamped" : "muted"}>The reachable pose misses the desired one by {miss}.</p>
      )}
      {alignment !== null && (
        <p className="muted">Error of the reachable pose: {errorBudgetWords(alignment)}</p>
      )}
      {alignment?.cannula_length_mm != null && (
        <p className="muted">Length of the cannula: {fixed(alignment.cannula_length_mm, 2)} mm</p>
      )}
      <label className="tick">
        <input type="checkbox" checked={insert} onChange={({ target }) => setInsert(target.checked)} />
        Insert the probe once it is aligned; else it stays out
      </label>
      <span className="propose-answers">
        <CommandButton
          need="holder"
          className="primary"
          off={none ?? (isMissed ? "It is out of reach." : null)}
          onCommand={() => propose("desired")}
        >
          Propose desired pose
        </CommandButton>
        <CommandButton
          need="holder"
          off={none ?? (isMissed ? null : "The desired pose is within reach.")}
          onCommand={() => propose("reachable")}
        >
          {isMissed ? `Accept ${miss}, and propose the reachable pose` : "Propose reachable pose"}
        </CommandButton>
        {retracts && (
          <CommandButton need="holder" onCommand={() => send({ kind: "retraction" })}>
            Retract probe
          </CommandButton>
        )}
      </span>
      {refusal !== null && (
        <p className="refusal" role="alert">
          <NoticeText lead="Refused:" notice={refusal} />
        </p>
      )}
      <Proposed id={proposed} />
    </div>
  );
}

/** Why the proposal would be refused now, by the kernel in the page, before anything is sent. */
function Hindrances({ alignment }: { readonly alignment: Alignment }) {
  const motors = useConsole((state) => state.motors);
  const frame = useConsole((state) => state.frame);
  const lines = axisLines(alignment, motors);
  const verdicts = useKernel((kernel) =>
    lines.map(
      ({ motor, counts }) => kernel.foresee(motor.slot, { kind: "MOVE", targetCounts: counts }).verdict,
    ),
  );
  const found = hindrances(lines, verdicts, (slot) => frame?.axes[slot]?.homed ?? false);
  if (found.length === 0) return null;
  return (
    <ul className="hindrances" aria-label="Why it would be refused now">
      {found.map(({ code, text }) => (
        <li key={code}>
          <i aria-hidden="true">▲</i> Would be refused now,{" "}
          <strong>{isVerdict(code) ? <CodeLink family="verdict" code={code} /> : code}</strong>: {text}
        </li>
      ))}
    </ul>
  );
}

/** What becomes of the motion that is open, whoever proposed it; else of what was proposed here. */
function Proposed({ id }: { readonly id: number | null }) {
  const proposal = useConsole(
    (state) => openPath(state.proposals) ?? state.proposals.find((each) => each.id === id),
  );
  if (proposal === undefined) return null;
  return (
    <p className="proposed" role="status">
      Proposal {proposal.id}: <strong>{proposal.state}</strong>. {proposal.detail}{" "}
      <ProposalCommands proposal={proposal} />
    </p>
  );
}

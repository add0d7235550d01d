import type { Motor, Proposal } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { Panel } from "../../design/Panel";
import { entry } from "../../generated/catalog";
import { MoveForetelling } from "../../kernel/MoveForetelling";
import { abort, approve } from "../../state/commands";
import { noticeOfProposal } from "../../state/notice";
import { isOpen } from "../../state/proposals";
import { useConsole } from "../../state/store";
import { localTime } from "../../units/time";
import { formatCounts } from "../../units/units";
import { FirstSteps, FirstStepsButton } from "../first/FirstSteps";
import "./proposals.css";

const MOST_SHOWN = 20;

/** What was asked for, by whom, and what became of it; newest first. */
export function ProposalsPanel() {
  const proposals = useConsole((state) => state.proposals);
  const motors = useConsole((state) => state.motors);
  return (
    <Panel title="Proposals" className="proposals-panel">
      <FirstSteps />
      {proposals.length === 0 && (
        <p className="proposals-empty">
          No move was proposed yet. <FirstStepsButton />
        </p>
      )}
      <ol className="proposals">
        {proposals.slice(0, MOST_SHOWN).map((proposal) => (
          <ProposalItem
            key={proposal.id}
            proposal={proposal}
            motor={motors.find((motor) => motor.slot === proposal.slot)}
          />
        ))}
      </ol>
    </Panel>
  );
}

type State = Proposal["state"];

const looks: Record<State, { readonly shape: string; readonly tone: string }> = {
  drafted: { shape: "·", tone: "" },
  checked: { shape: "?", tone: "wish" },
  approved: { shape: "◷", tone: "wish" },
  executing: { shape: "▶", tone: "wish" },
  paused: { shape: "‖", tone: "wish" },
  done: { shape: "✓", tone: "calm" },
  refused: { shape: "✕", tone: "medium" },
  aborted: { shape: "■", tone: "" },
  expired: { shape: "◌", tone: "" },
};

function ProposalItem({
  proposal,
  motor,
}: {
  readonly proposal: Proposal;
  readonly motor: Motor | undefined;
}) {
  const look = looks[proposal.state];
  const refusal = noticeOfProposal(proposal);
  return (
    <li className="proposal" data-state={proposal.state} aria-label={`Proposal ${proposal.id}`}>
      <span className="proposal-head">
        <span>
          <span className="number">#{proposal.id}</span> <Wish proposal={proposal} motor={motor} />
        </span>
        <span className={`chip ${look.tone}`}>
          <i aria-hidden="true">{look.shape}</i>
          {proposal.state}
        </span>
      </span>
      <span className="proposal-words">
        {refusal === null ? (
          proposal.detail
        ) : (
          <>
            {refusal.code}: {refusal.meaning} <span className="next-step">{refusal.nextStep}</span>
          </>
        )}
        {refusal === null && proposal.verdict != null && proposal.verdict !== "ACCEPTED" && (
          <span className="next-step">{entry("verdict", proposal.verdict).next_step}</span>
        )}
      </span>
      <WaitingMove proposal={proposal} motor={motor} />
      <span className="proposal-foot">
        {proposal.author} · <time dateTime={proposal.created}>{localTime(proposal.created)}</time>
        {proposal.state === "checked" && (
          <CommandButton
            need="holder"
            label={`Approve proposal ${proposal.id}`}
            onCommand={() => approve(proposal.id)}
          >
            Approve
          </CommandButton>
        )}
        {isOpen(proposal) && (
          <CommandButton
            need="holder"
            className="quiet"
            label={`Abort proposal ${proposal.id}`}
            onCommand={() => abort(proposal.id, proposal.slot)}
          >
            Abort
          </CommandButton>
        )}
      </span>
    </li>
  );
}

const waiting: ReadonlySet<State> = new Set(["checked", "approved", "paused"]);

/** What the kernel would say to a move that waits, for the approval or the pedal. */
function WaitingMove({ proposal, motor }: WishProps) {
  const axis = useConsole((state) => (motor === undefined ? undefined : state.frame?.axes[motor.slot]));
  const { kind, state, target_counts } = proposal;
  if (kind !== "move" || !waiting.has(state) || target_counts == null) return null;
  if (motor === undefined || axis === undefined) return null;
  return <MoveForetelling motor={motor} axis={axis} targetCounts={target_counts} />;
}

function capital(word: string): string {
  return word.charAt(0).toUpperCase() + word.slice(1);
}

interface WishProps {
  readonly proposal: Proposal;
  readonly motor: Motor | undefined;
}

function Wish({ proposal, motor }: WishProps) {
  const name = motor?.title ?? proposal.axis;
  if (proposal.kind === "home") {
    return (
      <>
        Home <strong>{name ?? `${proposal.axes.length} axes`}</strong>
      </>
    );
  }
  if (proposal.kind === "path") {
    return (
      <>
        <strong>{capital(proposal.mode ?? "path")}</strong>: {proposal.axes.join(", ")}
        {proposal.duration_s !== undefined && ` in ${proposal.duration_s.toFixed(1)} s`}
      </>
    );
  }
  if (proposal.kind === "sweep" || proposal.kind === "biopsy") {
    return (
      <>
        <strong>{proposal.kind === "sweep" ? "Frequency sweep" : "Cooperative biopsy"}</strong>:{" "}
        {proposal.axes.join(", ")}
      </>
    );
  }
  const counts = proposal.target_counts ?? 0;
  return (
    <>
      <strong>{name}</strong> to {motor === undefined ? `${counts} counts` : formatCounts(motor, counts)}
    </>
  );
}

import type { Motor, Proposal } from "../../api/client";
import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import { entry } from "../../generated/catalog";
import { noticeOfProposal } from "../../state/notice";
import { proposalHash } from "../../state/route";
import { useConsole } from "../../state/store";
import { localTime } from "../../units/time";
import { FirstSteps, FirstStepsButton } from "../first/FirstSteps";
import { originWords, ProposalCommands, RunLink, StateChip, WaitingWish, Wish } from "./ProposalParts";
import "./proposals.css";

const MOST_SHOWN = 20;

/** What was asked for, by whom, and what became of it; newest first. */
export function ProposalsPanel() {
  const proposals = useConsole((state) => state.proposals);
  const motors = useConsole((state) => state.motors);
  const approvesItself = useConsole((state) => state.robot?.auto_approve === true);
  return (
    <Panel title="Proposals" className="proposals-panel">
      <FirstSteps />
      {approvesItself && (
        <p className="panel-notice" role="status">
          <i aria-hidden="true">▲</i> This robot approves motions by itself: its file says auto_approve.
        </p>
      )}
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

function ProposalItem({
  proposal,
  motor,
}: {
  readonly proposal: Proposal;
  readonly motor: Motor | undefined;
}) {
  const refusal = noticeOfProposal(proposal);
  return (
    <li className="proposal" data-state={proposal.state} aria-label={`Proposal ${proposal.id}`}>
      <span className="proposal-head">
        <span>
          <span className="number">#{proposal.id}</span> <Wish proposal={proposal} motor={motor} />
        </span>
        <StateChip state={proposal.state} />
      </span>
      <span className="proposal-words">
        {refusal === null ? proposal.detail : <NoticeText lead="" notice={refusal} />}
        {refusal === null && proposal.verdict != null && proposal.verdict !== "ACCEPTED" && (
          <span className="next-step">{entry("verdict", proposal.verdict).next_step}</span>
        )}
      </span>
      <WaitingWish proposal={proposal} />
      <span className="proposal-foot">
        <span className="proposal-from">
          {originWords(proposal)} · <time dateTime={proposal.created}>{localTime(proposal.created)}</time>
        </span>
        <span className="proposal-commands">
          <a
            className="button quiet"
            href={proposalHash("proposals", proposal.id)}
            aria-label={`Details of proposal ${proposal.id}`}
          >
            Details
          </a>
          <RunLink className="button quiet" proposal={proposal} />
          <ProposalCommands proposal={proposal} />
        </span>
      </span>
    </li>
  );
}

import type { Proposal } from "../../api/client";
import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import { isOpen } from "../../state/proposals";
import { proposalHash, useProposalPlace } from "../../state/route";
import { useConsole } from "../../state/store";
import { localTime } from "../../units/time";
import { LivePage } from "../cover/LivePage";
import { MotionPanel } from "./MotionPanel";
import { ProposalDetail } from "./ProposalDetail";
import { originWords, StateChip, Wish } from "./ProposalParts";
import { TrajectoryPanel } from "./TrajectoryPanel";
import "./proposals.css";
import "./detail.css";

/** Every proposal that the app keeps, one of them as a whole, and the ways to propose what is typed or what a file says. */
export default function ProposalsPage() {
  const proposals = useConsole((state) => state.proposals);
  const notice = useConsole((state) => state.notices.robot);
  const asked = useProposalPlace();
  const shown = shownOf(proposals, asked);
  return (
    <LivePage className="proposals-page">
      <div className="main-column">
        {notice !== undefined && (
          <p className="panel-notice page-notice" role="alert">
            <NoticeText lead="Refused:" notice={notice} />
          </p>
        )}
        {shown === undefined ? <Nothing asked={asked} /> : <ProposalDetail key={shown.id} proposal={shown} />}
      </div>
      <div className="side">
        <AllProposals proposals={proposals} shown={shown?.id} />
        <MotionPanel />
        <TrajectoryPanel />
      </div>
    </LivePage>
  );
}

/** The one that was asked for, else the newest that is open, else the newest. */
function shownOf(proposals: readonly Proposal[], asked: number | null): Proposal | undefined {
  if (asked !== null) return proposals.find(({ id }) => id === asked);
  return proposals.find(isOpen) ?? proposals[0];
}

function Nothing({ asked }: { readonly asked: number | null }) {
  return (
    <Panel title="Proposal">
      <p className="panel-words">
        {asked === null
          ? "No move was proposed yet."
          : `Proposal ${asked} is not among those that the app keeps.`}
      </p>
    </Panel>
  );
}

interface AllProposalsProps {
  readonly proposals: readonly Proposal[];
  readonly shown: number | undefined;
}

function AllProposals({ proposals, shown }: AllProposalsProps) {
  const motors = useConsole((state) => state.motors);
  return (
    <Panel title="All proposals">
      {proposals.length === 0 && <p className="panel-words">No move was proposed yet.</p>}
      <ol className="all-proposals">
        {proposals.map((proposal) => (
          <li key={proposal.id}>
            <a
              href={proposalHash("proposals", proposal.id)}
              aria-current={proposal.id === shown ? "true" : undefined}
            >
              <span className="proposal-head">
                <span>
                  <span className="number">#{proposal.id}</span>{" "}
                  <Wish proposal={proposal} motor={motors.find(({ slot }) => slot === proposal.slot)} />
                </span>
                <StateChip state={proposal.state} />
              </span>
              <span className="proposal-from">
                {originWords(proposal)} · {localTime(proposal.created)}
              </span>
            </a>
          </li>
        ))}
      </ol>
    </Panel>
  );
}

import { useEffect, useState } from "react";
import { api, type Motor, type Proposal, type ProposalPlan } from "../../api/client";
import { CodeLink } from "../../design/CodeLink";
import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import { entry } from "../../generated/catalog";
import { isVerdict } from "../../state/notice";
import { proposalHash } from "../../state/route";
import { useConsole } from "../../state/store";
import { localDate, localTime } from "../../units/time";
import { errorBudgetWords } from "./errorBudget";
import { ProfilePlots } from "./ProfilePlots";
import { ProposalCommands, RunLink, StateChip, sourceWord, WaitingWish, Wish } from "./ProposalParts";
import { progressOf } from "./progress";
import { usePlan } from "./usePlan";

/** One proposal as a whole: who wants what, what was checked, what it will do, and what became of it. */
export function ProposalDetail({ proposal }: { readonly proposal: Proposal }) {
  const motor = useConsole((state) => state.motors.find(({ slot }) => slot === proposal.slot));
  const { plan, notice } = usePlan(proposal);
  const found = useFoundRun(proposal);
  const tools = (
    <>
      <RunLink proposal={proposal} found={found} />
      <a className="button" href={proposalHash("view", proposal.id)}>
        Show in 3D
      </a>
      <ProposalCommands proposal={proposal} />
    </>
  );
  return (
    <Panel title={`Proposal ${proposal.id}`} className="proposal-detail" tools={tools}>
      <p className="detail-wish">
        <span>
          <Wish proposal={proposal} motor={motor} />
        </span>
        <StateChip state={proposal.state} />
      </p>
      <Facts proposal={proposal} plan={plan} />
      <WaitingWish proposal={proposal} />
      <ProgressLine proposal={proposal} motor={motor} plan={plan} />
      {notice !== null && (
        <p className="panel-notice" role="alert">
          <NoticeText lead="No plan:" notice={notice} />
        </p>
      )}
      {plan !== null && (
        <>
          <Checks plan={plan} aim={proposal.aim} />
          <section className="detail-part" aria-label="Profile">
            <h3>Profile against limits</h3>
            <ProfilePlots profile={plan.profile} />
          </section>
        </>
      )}
    </Panel>
  );
}

/** Whether the app keeps a run of the proposal; asked anew with each of its states. */
function useFoundRun({ id, state }: Proposal): boolean {
  const [found, setFound] = useState(false);
  // biome-ignore lint/correctness/useExhaustiveDependencies: a run begins when its proposal has another state.
  useEffect(() => {
    let gone = false;
    void api.runs({ before: id + 1, count: 1 }).then((answer) => {
      if (!gone) setFound(answer.ok && answer.value.runs[0]?.id === id);
    });
    return () => {
      gone = true;
    };
  }, [id, state]);
  return found;
}

interface FactsProps {
  readonly proposal: Proposal;
  readonly plan: ProposalPlan | null;
}

function Facts({ proposal, plan }: FactsProps) {
  const { author, created, created_tick, ended, duration_s, mode, verdict } = proposal;
  return (
    <dl className="detail-facts">
      <Fact name="Author">{author}</Fact>
      <Fact name="Source">{sourceWord(proposal)}</Fact>
      {proposal.case !== null && <Fact name="Belongs to">Case {proposal.case}</Fact>}
      {mode !== undefined && <Fact name="Mode">{mode}</Fact>}
      <Fact name="Proposed">
        <time dateTime={created}>{localDate(created)}</time>, tick {created_tick}
      </Fact>
      {plan?.checked_tick != null && <Fact name="Checked">against tick {plan.checked_tick}</Fact>}
      {duration_s !== undefined && duration_s > 0 && (
        <Fact name="Planned for">{duration_s.toFixed(1)} s</Fact>
      )}
      {ended != null && (
        <Fact name="Ended">
          <time dateTime={ended}>{localTime(ended)}</time>
        </Fact>
      )}
      {proposal.line !== undefined && (
        <Fact name="Straight line">
          {proposal.line.length_mm.toFixed(2)} mm with the {proposal.line.keep} kept, planned to leave it by
          at most {proposal.line.planned_mm.toFixed(3)} mm of {proposal.line.allowed_mm} mm
        </Fact>
      )}
      {proposal.aim !== null && (
        <Fact name="Misses the aim by">
          {proposal.aim.deviation.distance_mm.toFixed(2)} mm and {proposal.aim.deviation.angle_deg.toFixed(2)}
          °
        </Fact>
      )}
      <Fact name="Outcome">{proposal.detail}</Fact>
      {verdict != null && (
        <Fact name="Verdict">
          <Code code={verdict} /> {nextStepOf(verdict, proposal.detail)}
        </Fact>
      )}
    </dl>
  );
}

/** One line of what is known, by its name. */
export function Fact({ name, children }: { readonly name: string; readonly children: React.ReactNode }) {
  return (
    <div>
      <dt>{name}</dt>
      <dd>{children}</dd>
    </div>
  );
}

/** What to do next; nothing where the outcome says it already. */
function nextStepOf(verdict: string, outcome: string): string {
  const nextStep = isVerdict(verdict) ? entry("verdict", verdict).next_step : "";
  return outcome.includes(nextStep) ? "" : nextStep;
}

/** Verdicts lead to their page; codes of the app alone have none. */
export function Code({ code }: { readonly code: string }) {
  return isVerdict(code) ? <CodeLink family="verdict" code={code} /> : <strong>{code}</strong>;
}

interface ProgressLineProps extends FactsProps {
  readonly motor: Motor | undefined;
}

function ProgressLine({ proposal, motor, plan }: ProgressLineProps) {
  const robot = useConsole((state) => state.robot);
  const nowCounts = useConsole((state) =>
    motor === undefined ? undefined : state.frame?.axes[motor.slot]?.positionCounts,
  );
  const fromCounts = plan?.profile.axes[0]?.positions_counts[0];
  const progress = progressOf(proposal, { motor, robot, fromCounts, nowCounts });
  if (progress === null) return null;
  return (
    <p className="detail-progress">
      <progress max={1} value={progress.share} aria-label="Progress" /> {progress.words}
    </p>
  );
}

const outcomes: Record<ProposalPlan["checks"][number]["outcome"], { shape: string; word: string }> = {
  passed: { shape: "✓", word: "passed" },
  failed: { shape: "✕", word: "failed" },
  not_reached: { shape: "·", word: "not looked at" },
};

/** By name, in the order in which they were made; the first that fails is the refusal. */
function Checks({ plan, aim }: { readonly plan: ProposalPlan; readonly aim: Proposal["aim"] }) {
  return (
    <section className="detail-part" aria-label="Checks">
      <h3>Checks</h3>
      {plan.checks.length === 0 && <p className="plan-words">None was made.</p>}
      <ol className="checks">
        {plan.checks.map(({ name, words, outcome, code }) => (
          <li key={name} data-outcome={outcome}>
            <i aria-hidden="true">{outcomes[outcome].shape}</i>
            <span>
              <strong>{name.replaceAll("_", " ")}</strong>{" "}
              <span className="check-outcome">
                {outcomes[outcome].word}
                {code !== null && (
                  <>
                    : <Code code={code} />
                  </>
                )}
              </span>{" "}
              <span className="check-words">{words}</span>
            </span>
          </li>
        ))}
      </ol>
      {aim !== null && <p className="plan-words">Error of the reachable pose: {errorBudgetWords(aim)}</p>}
    </section>
  );
}

import type { ListedRun, Motor, Proposal } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { WishForetelling } from "../../kernel/WishForetelling";
import { abort, approve, confirmInsertion, reject } from "../../state/commands";
import { isOpen, nextWishes } from "../../state/proposals";
import { runHash } from "../../state/route";
import { useConsole } from "../../state/store";
import { formatCounts } from "../../units/units";

type State = Proposal["state"] | ListedRun["outcome"];

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
  running: { shape: "▶", tone: "wish" },
  interrupted: { shape: "!", tone: "medium" },
};

/** Where it stands, by word and shape. */
export function StateChip({ state }: { readonly state: State }) {
  const look = looks[state];
  return (
    <span className={`chip ${look.tone}`}>
      <i aria-hidden="true">{look.shape}</i>
      {state}
    </span>
  );
}

const sources: Record<Proposal["source"], string> = {
  console: "console",
  file: "file",
  openigtlink: "OpenIGTLink",
};

/** Where it came from, as people write it. */
export function sourceWord({ source }: Pick<Proposal, "source">): string {
  return sources[source];
}

/** Who proposed it, from where, and in which case. */
export function originWords(proposal: Proposal): string {
  const { author, case: number } = proposal;
  return `${author} · ${sourceWord(proposal)}${number === null ? "" : ` · Case ${number}`}`;
}

/** What whoever is in control can do about it now. */
export function ProposalCommands({ proposal }: { readonly proposal: Proposal }) {
  const { id, slot, state } = proposal;
  if (!isOpen(proposal)) return null;
  if (state !== "checked") {
    return (
      <>
        {proposal.wants_confirmation && (
          <CommandButton
            need="holder"
            label={`Confirm insertion of proposal ${id}`}
            onCommand={() => confirmInsertion(id)}
          >
            Confirm insertion
          </CommandButton>
        )}
        <CommandButton
          need="holder"
          className="quiet"
          label={`Abort proposal ${id}`}
          onCommand={() => abort(id, slot)}
        >
          Abort
        </CommandButton>
      </>
    );
  }
  return (
    <>
      <CommandButton need="holder" label={`Approve proposal ${id}`} onCommand={() => approve(id)}>
        Approve
      </CommandButton>
      <CommandButton need="holder" label={`Reject proposal ${id}`} onCommand={() => reject(id)}>
        Reject
      </CommandButton>
    </>
  );
}

const ran: ReadonlySet<State> = new Set(["executing", "paused", "done"]);

interface RunLinkProps {
  readonly proposal: Proposal;
  /** Whether a run of it was found; its state alone does not tell of one that ended early. */
  readonly found?: boolean;
  readonly className?: string;
}

/** Leads to the run of the same number; nothing where no axis is known to have moved. */
export function RunLink({ proposal: { id, state }, found = false, className = "button" }: RunLinkProps) {
  if (!found && !ran.has(state)) return null;
  return (
    <a className={className} href={runHash(id)}>
      Run {id}
    </a>
  );
}

const waiting: ReadonlySet<State> = new Set(["checked", "approved", "paused"]);

/** What the kernel would say to what waits, for the approval or the pedal. */
export function WaitingWish({ proposal }: { readonly proposal: Proposal }) {
  const motors = useConsole((state) => state.motors);
  const robot = useConsole((state) => state.robot);
  return waiting.has(proposal.state) && <WishForetelling wishes={nextWishes(proposal, motors, robot)} />;
}

function capital(word: string): string {
  return word.charAt(0).toUpperCase() + word.slice(1);
}

interface WishProps {
  readonly proposal: Proposal;
  readonly motor: Motor | undefined;
}

const motions: Partial<Record<Proposal["kind"], string>> = {
  sweep: "Frequency sweep",
  biopsy: "Cooperative biopsy",
  identify: "Measurement",
};

export function Wish({ proposal, motor }: WishProps) {
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
  const motion = proposal.kind === "move" ? undefined : motions[proposal.kind];
  if (motion !== undefined) {
    return (
      <>
        <strong>{motion}</strong>: {proposal.axes.join(", ")}
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

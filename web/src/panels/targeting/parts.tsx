/** What several panels of the page are made of. */
import type { TargetingHistory } from "../../api/client";
import { localTime } from "../../units/time";
import { ageWords, sourceWords } from "./history";

/** The frame of every pose and point on the page. */
export const FRAME = "scanner RAS, mm";

export function FrameLabel() {
  return <span className="frame-label">{FRAME}</span>;
}

interface SetByProps {
  readonly history: Pick<TargetingHistory, "now" | "last_set"> | null;
  /** Name of the value in the interface. */
  readonly field: string;
  /** Whether there is a value: one that an older release set has nobody noted. */
  readonly isSet: boolean;
  /** What to say while there is none. */
  readonly unset: string;
}

/** Who set a value, from where, and how long ago. */
export function SetBy({ history, field, isSet, unset }: SetByProps) {
  if (history === null) return <p className="set-by">Who set it is not known yet.</p>;
  const origin = history.last_set[field];
  if (origin === undefined) return <p className="set-by">{isSet ? "Set before that was noted." : unset}</p>;
  return (
    <p className="set-by" title={`${localTime(origin.time)}; record ${origin.record} of the audit`}>
      Set {ageWords(origin.time, history.now)} by <strong>{origin.user}</strong> ({sourceWords(origin)})
    </p>
  );
}

interface NewsProps {
  /** What arrived, in words. */
  readonly arrived: string;
  readonly onTake: () => void;
  readonly onKeep: () => void;
}

/** Something else arrived for what was edited here: nothing is overwritten, and nothing is sent before one of both is chosen. */
export function News({ arrived, onTake, onKeep }: NewsProps) {
  return (
    <div className="news" role="alert">
      <p>
        <i aria-hidden="true">▲</i> While you edited, something else arrived: {arrived}. Yours is kept and not
        sent.
      </p>
      <span className="news-answers">
        <button type="button" className="button small" onClick={onTake}>
          Take what arrived
        </button>
        <button type="button" className="button small" onClick={onKeep}>
          Keep mine
        </button>
      </span>
    </div>
  );
}

/** What is wrong with what was written, one sentence each. */
export function Problems({ id, problems }: { readonly id: string; readonly problems: readonly string[] }) {
  return (
    <div id={id} role="alert">
      {problems.length > 0 && (
        <ul className="problems">
          {problems.map((problem) => (
            <li key={problem}>
              <i aria-hidden="true">✕</i> {problem}
            </li>
          ))}
        </ul>
      )}
    </div>
  );
}

interface SendBarProps {
  readonly action: string;
  /** Why there is nothing that could be sent; null when there is. */
  readonly off: string | null;
  readonly edited: boolean;
  readonly onUndo: () => void;
  /** What is sent, or was. */
  readonly words: string;
}

/** Sends what was edited, or gives it up. */
export function SendBar({ action, off, edited, onUndo, words }: SendBarProps) {
  return (
    <div className="send-bar">
      <output className={edited ? "edited" : "muted"}>{words}</output>
      {edited && (
        <button type="button" className="button" onClick={onUndo}>
          Undo
        </button>
      )}
      <button type="submit" className="button primary" disabled={off !== null} title={off ?? undefined}>
        {action}
      </button>
    </div>
  );
}

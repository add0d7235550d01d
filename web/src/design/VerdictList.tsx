import { useState } from "react";
import type { AxisVerdict, Outcome } from "../api/client";
import { noticeOfProblem } from "../state/notice";
import { useConsole } from "../state/store";
import { CodeLink } from "./CodeLink";
import { NoticeText } from "./NoticeText";

type Answer = Outcome<readonly AxisVerdict[]>;

/** Sends a request to several axes, and has the list of what the kernel said to each, until somebody closes it. */
export function useVerdicts(title: string) {
  const [answer, setAnswer] = useState<Answer | null>(null);
  const send = async (ask: () => Promise<Answer>): Promise<void> => setAnswer(await ask());
  const list = answer !== null && (
    <VerdictList title={title} answer={answer} onClose={() => setAnswer(null)} />
  );
  return { send, list };
}

interface VerdictListProps {
  readonly title: string;
  readonly answer: Answer;
  readonly onClose: () => void;
}

/** What the kernel said to each axis of a request to several, or why it was not asked. */
export function VerdictList({ title, answer, onClose }: VerdictListProps) {
  const motors = useConsole((state) => state.motors);
  return (
    <section className="verdicts" aria-label={`Answer to ${title}`}>
      <div role="status">
        {!answer.ok && <NoticeText lead="Refused:" notice={noticeOfProblem(answer.problem)} />}
        <ul>
          {(answer.ok ? answer.value : []).map(({ slot, axis, verdict, detail }) => (
            <li key={slot} data-accepted={verdict === "ACCEPTED"}>
              <i aria-hidden="true">{verdict === "ACCEPTED" ? "✓" : "✕"}</i>{" "}
              <strong>{motors.find((motor) => motor.slot === slot)?.title ?? axis}</strong>{" "}
              {verdict === null ? "NO VERDICT" : <CodeLink family="verdict" code={verdict} />}{" "}
              {detail !== undefined && <span className="next-step">{detail}</span>}
            </li>
          ))}
        </ul>
      </div>
      <button type="button" className="button" onClick={onClose}>
        Close
      </button>
    </section>
  );
}

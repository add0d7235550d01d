import type { AxisVerdict } from "../api/client";
import type { Notice } from "../state/notice";
import { useConsole } from "../state/store";
import { CodeLink } from "./CodeLink";
import { NoticeText } from "./NoticeText";

interface VerdictListProps {
  readonly title: string;
  readonly verdicts: readonly AxisVerdict[];
  /** Why there are no verdicts. */
  readonly notice: Notice | null;
  readonly onClose: () => void;
}

/** What the kernel said to each axis of a request to several. */
export function VerdictList({ title, verdicts, notice, onClose }: VerdictListProps) {
  const motors = useConsole((state) => state.motors);
  return (
    <section className="verdicts" aria-label={`Answer to ${title}`}>
      <div role="status">
        {notice !== null && <NoticeText lead="Refused:" notice={notice} />}
        <ul>
          {verdicts.map(({ slot, axis, verdict, detail }) => (
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

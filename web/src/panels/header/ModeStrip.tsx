import { Fragment } from "react";
import { CodeLink } from "../../design/CodeLink";
import { entry } from "../../generated/catalog";
import { gateWords, scanWords } from "../../state/holds";
import { useConsole } from "../../state/store";
import type { Glance } from "../../stream/decode";

/** What the mode means and the operator's next step; when LOCKED, the cause in its place, else during a scan that. */
export function ModeStrip({ glance }: { readonly glance: Glance | null }) {
  const scan = useConsole(scanWords);
  const gate = useConsole((state) => gateWords(state.holds));
  if (glance === null) {
    return <p className="mode-strip">The state is unknown. If anything moves, pull the E-stop.</p>;
  }
  const locked = glance.mode === "LOCKED";
  if (scan !== null && !locked) {
    return (
      <p className="mode-strip" role="status" aria-label="Scan">
        <strong className="scan">HELD STILL FOR A SCAN</strong> <span>{scan}</span>
      </p>
    );
  }
  const text = locked ? entry("cause", glance.cause) : entry("mode", glance.mode);
  return (
    <p
      className="mode-strip"
      aria-live="polite"
      title={locked ? `Seen in tick ${glance.causeTick}; value ${glance.causeValue}` : undefined}
    >
      {locked && (
        <strong>
          <CodeLink family="cause" code={text.name} />{" "}
        </strong>
      )}
      <span>{text.meaning} </span>
      <span className="next-step">{text.next_step}</span>
      {gate !== null && <span className="gate"> {gate}</span>}
      <AlsoSeen glance={glance} />
    </p>
  );
}

/** What else locked, besides the first cause. */
export function AlsoSeen({ glance }: { readonly glance: Glance }) {
  const later = glance.causesSeen.filter((cause) => cause !== glance.cause && cause !== "NONE");
  if (glance.mode !== "LOCKED" || later.length === 0) return null;
  return (
    <span className="detail">
      {" also seen: "}
      {later.map((cause, index) => (
        <Fragment key={cause}>
          {index > 0 && ", "}
          <CodeLink family="cause" code={cause} />
        </Fragment>
      ))}
    </span>
  );
}

import { Fragment } from "react";
import { CodeLink } from "../../design/CodeLink";
import { entry } from "../../generated/catalog";
import type { Glance } from "../../stream/decode";

/** What the mode means and the operator's next step; when LOCKED, the cause in its place. */
export function ModeStrip({ glance }: { readonly glance: Glance | null }) {
  if (glance === null) {
    return <p className="mode-strip">The state is unknown. If anything moves, pull the E-stop.</p>;
  }
  const locked = glance.mode === "LOCKED";
  const text = locked ? entry("cause", glance.cause) : entry("mode", glance.mode);
  const later = glance.causesSeen.filter((cause) => cause !== glance.cause && cause !== "NONE");
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
      {locked && later.length > 0 && (
        <span className="detail">
          {" also seen: "}
          {later.map((cause, index) => (
            <Fragment key={cause}>
              {index > 0 && ", "}
              <CodeLink family="cause" code={cause} />
            </Fragment>
          ))}
        </span>
      )}
    </p>
  );
}

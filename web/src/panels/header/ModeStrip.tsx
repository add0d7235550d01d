import { entry } from "../../generated/catalog";
import type { Frame } from "../../stream/decode";

/** What the mode means and the operator's next step; when LOCKED, the cause in its place. */
export function ModeStrip({ frame }: { readonly frame: Frame | null }) {
  if (frame === null) {
    return <p className="mode-strip">The state is unknown. If anything moves, pull the E-stop.</p>;
  }
  const locked = frame.mode === "LOCKED";
  const text = locked ? entry("cause", frame.cause) : entry("mode", frame.mode);
  const later = frame.causesSeen.filter((cause) => cause !== frame.cause && cause !== "NONE");
  return (
    <p
      className="mode-strip"
      aria-live="polite"
      title={locked ? `Seen in tick ${frame.causeTick}; value ${frame.causeValue}` : undefined}
    >
      {locked && <strong>{text.name} </strong>}
      <span>{text.meaning} </span>
      <span className="next-step">{text.next_step}</span>
      {locked && later.length > 0 && <span className="detail"> also seen: {later.join(", ")}</span>}
    </p>
  );
}

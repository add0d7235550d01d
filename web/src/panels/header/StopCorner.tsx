import type { MouseEvent, PointerEvent } from "react";
import { useEffect } from "react";
import { AlarmSign } from "../../design/AlarmSign";
import { stop } from "../../state/commands";
import { type StopReport, useConsole } from "../../state/store";

/** STOP, always in this corner, and Esc from anywhere. One action, no question asked. */
export function StopCorner() {
  const report = useConsole((state) => state.stop);
  useEffect(() => {
    const onKey = (event: KeyboardEvent): void => {
      if (event.key === "Escape" && !event.repeat) void stop();
    };
    // Capture phase: no field or dialog may swallow the key first.
    window.addEventListener("keydown", onKey, { capture: true });
    return () => window.removeEventListener("keydown", onKey, { capture: true });
  }, []);
  return (
    <div className="stop-corner">
      <button
        type="button"
        className="stop"
        onPointerDown={onPress}
        onClick={onClick}
        aria-keyshortcuts="Escape"
      >
        STOP
        <small>Esc</small>
      </button>
      <StopAnswer report={report} />
    </div>
  );
}

/** Already on the way down: the operator means it when the finger lands. */
function onPress(event: PointerEvent): void {
  if (event.button === 0) void stop();
}

/** A click without a pointer comes from the keyboard or assistive technology. */
function onClick(event: MouseEvent): void {
  if (event.detail === 0) void stop();
}

function StopAnswer({ report }: { readonly report: StopReport }) {
  switch (report.phase) {
    case "idle":
      return <output className="stop-answer" aria-label="Answer to STOP" />;
    case "sending":
      return (
        <output className="stop-answer" aria-label="Answer to STOP">
          sending …
        </output>
      );
    case "answered":
      return (
        <output className="stop-answer" aria-label="Answer to STOP">
          {report.verdict === null ? "sent; no kernel connected" : `STOP ${report.verdict.toLowerCase()}`}
        </output>
      );
    case "unanswered":
      return (
        <p className="stop-answer failed" role="alert">
          <AlarmSign priority="high">▲</AlarmSign> NO ANSWER: use the E-stop
        </p>
      );
  }
}

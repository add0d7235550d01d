import type { Motor } from "../api/client";
import { CodeLink } from "../design/CodeLink";
import { useConsole } from "../state/store";
import type { AxisFrame } from "../stream/decode";
import { foretell } from "./foretell";
import { useKernel } from "./useKernel";
import "./foretelling.css";

interface MoveForetellingProps {
  readonly motor: Motor;
  readonly axis: AxisFrame;
  readonly targetCounts: number;
}

const shapes = { moves: "✓", held: "▲", refused: "✕" } as const;

/** What the kernel would say to a move that was not sent yet; nothing of it leaves the page. */
export function MoveForetelling({ motor, axis, targetCounts }: MoveForetellingProps) {
  const frame = useConsole((state) => state.frame);
  const foresight = useKernel((kernel) => kernel.foreseeMove(motor.slot, targetCounts));
  if (frame === null || foresight === null) {
    return (
      <p className="foretelling" data-outcome="unknown" role="status">
        What the kernel would say cannot be told on this page.
      </p>
    );
  }
  const told = foretell(frame, motor, axis, targetCounts, foresight);
  return (
    <p className="foretelling" data-outcome={told.outcome} role="status">
      <i aria-hidden="true">{shapes[told.outcome]}</i>{" "}
      <strong>
        <CodeLink family={told.family} code={told.code} />
      </strong>{" "}
      {told.text} {told.nextStep !== "" && <span className="next-step">{told.nextStep}</span>}
    </p>
  );
}

import type { Motor } from "../api/client";
import { CodeLink } from "../design/CodeLink";
import { useConsole } from "../state/store";
import { type Foretelling, foretell } from "./foretell";
import type { AxisWish } from "./pageKernel";
import { useKernel } from "./useKernel";
import "./foretelling.css";

interface WishOfAxis {
  readonly motor: Motor;
  readonly wish: AxisWish;
}

const shapes = { moves: "✓", held: "▲", refused: "✕" } as const;

/**
 * What the kernel would say to wishes that were not sent yet; nothing of it leaves the page. Of several axes those are named
 * that would not move.
 */
export function WishForetelling({ wishes }: { readonly wishes: readonly WishOfAxis[] }) {
  const frame = useConsole((state) => state.frame);
  const foresights = useKernel((kernel) => wishes.map(({ motor, wish }) => kernel.foresee(motor.slot, wish)));
  if (wishes.length === 0) return null;
  if (frame === null || foresights === null) {
    return (
      <p className="foretelling" data-outcome="unknown" role="status">
        What the kernel would say cannot be told on this page.
      </p>
    );
  }
  const told = wishes.flatMap(({ motor, wish }, index) => {
    const axis = frame.axes[motor.slot];
    const foresight = foresights[index];
    if (axis === undefined || foresight === undefined) return [];
    return [{ motor, telling: foretell(frame, motor, axis, wish, foresight) }];
  });
  const hindered = told.filter(({ telling }) => telling.outcome !== "moves");
  const shown = hindered.length > 0 ? hindered : told.slice(0, 1);
  return shown.map(({ motor, telling }) => (
    <Line
      key={motor.slot}
      telling={telling}
      of={wishes.length === 1 ? null : hindered.length > 0 ? motor.title : "All axes"}
    />
  ));
}

interface LineProps {
  readonly telling: Foretelling;
  /** Whom it concerns, where that is not plain. */
  readonly of: string | null;
}

function Line({ telling: { outcome, family, code, text, nextStep }, of }: LineProps) {
  return (
    <p className="foretelling" data-outcome={outcome} role="status">
      <i aria-hidden="true">{shapes[outcome]}</i> {of !== null && `${of}: `}
      <strong>
        <CodeLink family={family} code={code} />
      </strong>{" "}
      {text} {nextStep !== "" && <span className="next-step">{nextStep}</span>}
    </p>
  );
}

import { useConsole } from "../../state/store";
import { nextStep, steps } from "./steps";
import "./first.css";

/** Opens the walk-through on the robot's page, where it stays until it is closed. */
export function FirstStepsButton({ onOpen }: { readonly onOpen?: () => void }) {
  const open = (): void => {
    useConsole.setState({ firstSteps: true });
    location.hash = "#/robot";
    onOpen?.();
  };
  return (
    <button type="button" className="button small" onClick={open}>
      Show the first steps
    </button>
  );
}

/** Leads a newcomer to the first move: what to do now, what was done. It watches, and does nothing itself. */
export function FirstSteps() {
  const open = useConsole((state) => state.firstSteps);
  const now = useConsole((state) =>
    nextStep({
      mine: state.control?.mine ?? false,
      mode: state.glance?.mode ?? "UNKNOWN",
      axes: state.motors.map(({ slot }) => state.frame?.axes[slot]?.state ?? "DISABLED"),
      proposals: state.proposals,
    }),
  );
  if (!open) return null;
  return (
    <section className="first-steps" aria-label="First steps">
      <ol>
        {steps.map(({ title, words }, index) => (
          <li key={title} aria-current={index === now ? "step" : undefined} data-done={index < now}>
            <i aria-hidden="true">{index < now ? "✓" : index === now ? "▶" : "·"}</i>
            <span>
              <strong>{title}</strong>
              {index < now && <span className="visually-hidden"> (done)</span>}
              {index === now && <> {words}</>}
            </span>
          </li>
        ))}
      </ol>
      <p role="status">{now === steps.length && "You have moved the robot. ? shows what the keys do."}</p>
      <button
        type="button"
        className="button small"
        onClick={() => useConsole.setState({ firstSteps: false })}
      >
        Close the first steps
      </button>
    </section>
  );
}

import type { Proposal } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { abort } from "../../state/commands";
import { homingSteps, type StepLine } from "../../state/proposals";
import { useConsole } from "../../state/store";

const marks: Record<StepLine["place"], { readonly shape: string; readonly word: string }> = {
  before: { shape: "✓", word: "done" },
  now: { shape: "▶", word: "now" },
  after: { shape: "○", word: "later" },
};

/** How far the open homing is, and what the operator has to do for it. */
export function HomingProgress({ homing }: { readonly homing: Proposal }) {
  const robot = useConsole((state) => state.robot);
  const title = useConsole((state) => state.motors.find((motor) => motor.slot === homing.slot)?.title);
  const steps = robot === null ? [] : homingSteps(homing, robot);
  return (
    <section className="homing-progress" aria-label="Homing progress">
      <div>
        <strong>Homing.. {title ?? ""}</strong> <span role="status">{homing.detail}</span>
        {steps.length > 0 && (
          <ol>
            {steps.map(({ name, title: stepTitle, place }) => (
              <li key={name} data-place={place} aria-current={place === "now" ? "step" : undefined}>
                <i aria-hidden="true">{marks[place].shape}</i> {stepTitle} <small>{marks[place].word}</small>
              </li>
            ))}
          </ol>
        )}
      </div>
      <CommandButton need="holder" label="Abort homing" onCommand={() => abort(homing.id, homing.slot)}>
        Abort
      </CommandButton>
    </section>
  );
}

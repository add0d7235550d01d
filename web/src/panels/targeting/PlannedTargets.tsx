import type { Targeting } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { TextForm } from "./CasePanel";
import { list } from "./numbers";
import { FRAME } from "./parts";

type Planned = Targeting["planned_targets"][number];

interface PlannedTargetsProps {
  readonly planned: readonly Planned[];
  /** Entry and target as they stand in the fields; null while one of them is none. */
  readonly points: Omit<Planned, "name"> | null;
  readonly onTake: (planned: Planned) => void;
  /** Gives whether the app took them. */
  readonly onChange: (planned: Planned[]) => Promise<boolean>;
}

/** The case's list. Taking one fills the fields of entry and target, and sets nothing. */
export function PlannedTargets({ planned, points, onTake, onChange }: PlannedTargetsProps) {
  return (
    <details className="planned-targets" open={planned.length > 0}>
      <summary>Planned targets: {planned.length}</summary>
      <ul aria-label={`Planned targets, ${FRAME}`}>
        {planned.map((each) => (
          <li key={each.name} aria-label={each.name}>
            <strong>{each.name}</strong>
            <span className="muted">
              {list(each.entry_point, 1)} → {list(each.target_point, 1)}
            </span>
            <span>
              <CommandButton
                need="holder"
                className="small"
                label={`Take ${each.name} into the fields`}
                onCommand={() => onTake(each)}
              >
                Take
              </CommandButton>{" "}
              <CommandButton
                need="holder"
                className="small"
                label={`Remove ${each.name}`}
                onCommand={() => onChange(planned.filter((other) => other !== each)).then(() => undefined)}
              >
                Remove
              </CommandButton>
            </span>
          </li>
        ))}
      </ul>
      {points === null ? (
        <p className="plan-words">Write entry and target above to plan them under a name.</p>
      ) : (
        <TextForm
          need="holder"
          title="Name"
          most={40}
          hint="No patient data. Nothing goes to a planned target before it is set."
          action="Plan entry and target"
          onSend={(name) => onChange([...planned, { name, ...points }])}
        />
      )}
    </details>
  );
}

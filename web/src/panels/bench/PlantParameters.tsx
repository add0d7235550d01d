import { type FormEvent, useState } from "react";
import { CommandButton } from "../../design/CommandButton";
import { useConsole } from "../../state/store";
import { useReason } from "../../state/useReason";
import type { FaultsProps } from "./faults";
import { draftedValues, knobs } from "./parameters";

/** How the motor, gear and encoder of an axis are simulated. The robot's file, and so the kernel, know nothing of it. */
export function PlantParameters({ plant, send }: FaultsProps) {
  const motors = useConsole((state) => state.motors);
  const reason = useReason("engineer");
  const [chosen, setChosen] = useState<number | null>(null);
  const [drafts, setDrafts] = useState<Readonly<Record<string, string>>>({});
  const motor = motors.find(({ slot }) => slot === chosen) ?? motors[0];
  const axis = plant.axes.find((each) => each.slot === motor?.slot);
  if (motor === undefined || axis === undefined) return null;
  const { slot } = motor;
  const drafted = draftedValues(drafts);
  const onSubmit = async (event: FormEvent): Promise<void> => {
    event.preventDefault();
    setDrafts({});
    await send("parameters", { slot, ...drafted });
  };
  return (
    <form className="faults" aria-label="Simulated motor" onSubmit={(event) => void onSubmit(event)}>
      <p className="wide simulation-words">SIMULATION: how the motor acts, not what the kernel allows.</p>
      <label className="wide">
        Simulated motor of{" "}
        <select
          value={slot}
          onChange={(event) => {
            setChosen(Number(event.target.value));
            setDrafts({});
          }}
        >
          {motors.map((each) => (
            <option key={each.slot} value={each.slot}>
              {each.title}
            </option>
          ))}
        </select>
      </label>
      {knobs.map(({ name, label }) => (
        <label key={name}>
          {label}{" "}
          <input
            type="number"
            step="any"
            disabled={reason !== null}
            title={reason ?? undefined}
            value={drafts[name] ?? axis.parameters[name] ?? ""}
            onChange={({ target }) => setDrafts({ ...drafts, [name]: target.value })}
          />
        </label>
      ))}
      <output className="wide" aria-label="Coast of the simulated motor">
        coasts {axis.parameters.coast_counts ?? 0} counts from full speed
        {axis.parametersChanged && " · ✕ not as in the plant file"}
      </output>
      <button
        type="submit"
        className="button"
        disabled={reason !== null || Object.keys(drafted).length === 0}
        title={reason ?? undefined}
      >
        Set the simulated motor
      </button>
      <CommandButton
        need="engineer"
        off={axis.parametersChanged ? null : "They are as in the plant file."}
        onCommand={() => send("parameters_restore", { slot })}
      >
        As in the plant file
      </CommandButton>
    </form>
  );
}

import { Choice } from "./controls";
import type { FaultsProps } from "./faults";

const states = ["free", "open", "closed"] as const;

/** The pedal's contacts, each by itself. */
export function ContactFaults({ plant, send }: FaultsProps) {
  return (
    <fieldset className="faults" aria-label="Faults of the pedal">
      <Choice
        label="Pedal contact NO"
        options={states}
        value={plant.pedalNo}
        onChoose={(state) => send("pedal_contact", { contact: "no", state })}
      />
      <Choice
        label="Pedal contact NC"
        options={states}
        value={plant.pedalNc}
        onChoose={(state) => send("pedal_contact", { contact: "nc", state })}
      />
    </fieldset>
  );
}

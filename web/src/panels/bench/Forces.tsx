import { useState } from "react";
import { CommandButton } from "../../design/CommandButton";
import type { PlantInput } from "./benchStatus";
import { WholeNumber } from "./controls";
import type { FaultsProps, SendBench } from "./faults";

/** Presses on the force sensors; nothing for a robot without them. */
export function Forces({ plant, send }: FaultsProps) {
  return plant.inputs.map((input) => <Force key={`${input.slot} ${input.adc}`} input={input} send={send} />);
}

const MOST_COUNTS = 65_535;

function Force({ input, send }: { readonly input: PlantInput; readonly send: SendBench }) {
  const { slot, adc, name, forceCounts } = input;
  const [counts, setCounts] = useState(1000);
  return (
    <fieldset className="faults" aria-label={`Sensor ${name}, input ${adc}`}>
      <WholeNumber
        label={`Sensor ${name}, input ${adc}`}
        value={counts}
        most={MOST_COUNTS}
        onChange={setCounts}
      />
      <span className="force-now">now {forceCounts} counts</span>
      <CommandButton need="engineer" onCommand={() => send("force", { slot, adc, counts })}>
        Press
      </CommandButton>
      <CommandButton
        need="engineer"
        off={forceCounts === 0 ? "Nothing presses on it." : null}
        onCommand={() => send("force", { slot, adc, counts: 0 })}
      >
        Release force
      </CommandButton>
    </fieldset>
  );
}

import { useState } from "react";
import { CommandButton } from "../../design/CommandButton";
import { useConsole } from "../../state/store";
import { WholeNumber } from "./controls";
import type { FaultsProps } from "./faults";

const frameFaults = ["corrupt", "drop", "delay", "repeat", "deaf"] as const;

/** What can go wrong with a card, its frames and the bus. */
export function CardFaults({ plant, send }: FaultsProps) {
  const cards = useConsole((state) => state.status?.cards);
  const slots = (cards ?? []).filter(({ card }) => card !== "NONE").map(({ slot }) => slot);
  const [chosen, setChosen] = useState<number | null>(null);
  const [count, setCount] = useState(1);
  const slot = chosen ?? slots[0];
  if (slot === undefined) return null;
  const powered = !plant.unpowered.has(slot);
  return (
    <fieldset className="faults" aria-label="Faults of a card">
      <label>
        Card{" "}
        <select value={slot} onChange={(event) => setChosen(Number(event.target.value))}>
          {slots.map((each) => (
            <option key={each} value={each}>
              slot {each}
            </option>
          ))}
        </select>
      </label>
      <WholeNumber label="Frames" value={count} least={1} most={1_000_000} onChange={setCount} />
      <div className="wide frame-faults">
        {frameFaults.map((fault) => (
          <CommandButton
            key={fault}
            need="engineer"
            label={`${fault} the next ${count} frames of slot ${slot}`}
            onCommand={() => send("frame", { slot, fault, count })}
          >
            {fault}
          </CommandButton>
        ))}
        <CommandButton need="engineer" onCommand={() => send("frame", { all: true, fault: "drop", count })}>
          drop all
        </CommandButton>
      </div>
      <CommandButton need="engineer" onCommand={() => send("card_reset", { slot })}>
        Reset card
      </CommandButton>
      <CommandButton
        need="engineer"
        pressed={!powered}
        onCommand={() => send("card_power", { slot, on: !powered })}
      >
        Unplug card{!powered && " ✕"}
      </CommandButton>
      <CommandButton need="engineer" className="wide" onCommand={() => send("transaction", { count })}>
        Fail {count} {count === 1 ? "transaction" : "transactions"} of the bus
      </CommandButton>
    </fieldset>
  );
}

import { useState } from "react";
import { CommandButton } from "../../design/CommandButton";
import { useConsole } from "../../state/store";
import { Choice, WholeNumber } from "./controls";
import type { FaultsProps } from "./faults";

/** What can go wrong with one axis. */
export function AxisFaults({ plant, send }: FaultsProps) {
  const motors = useConsole((state) => state.motors);
  const [chosen, setChosen] = useState<number | null>(null);
  const [counts, setCounts] = useState(50);
  const [speed, setSpeed] = useState(1);
  const motor = motors.find(({ slot }) => slot === chosen) ?? motors[0];
  if (motor === undefined) return null;
  const { slot } = motor;
  const axis = plant.axes.find((each) => each.slot === slot);
  const runaway = axis?.runawayCountsPerTick ?? 0;
  return (
    <fieldset className="faults" aria-label="Faults of an axis">
      <label className="wide">
        Axis{" "}
        <select value={slot} onChange={(event) => setChosen(Number(event.target.value))}>
          {motors.map((each) => (
            <option key={each.slot} value={each.slot}>
              {each.title}
            </option>
          ))}
        </select>
      </label>
      <Choice
        label="Encoder"
        options={["normal", "stuck"]}
        value={axis?.encoder ?? "normal"}
        onChoose={(state) => send("encoder", { slot, state })}
      />
      <Choice
        label="Limit switch"
        options={["normal", "open", "triggered"]}
        value={axis?.switchState ?? "normal"}
        off={axis?.hasSwitch === false ? "The axis has no switch." : null}
        onChoose={(state) => send("switch", { slot, state })}
      />
      <CommandButton
        need="engineer"
        pressed={axis?.reversed === true}
        onCommand={() => send("reverse", { slot, reversed: axis?.reversed !== true })}
      >
        Motor reversed{axis?.reversed === true && " ✕"}
      </CommandButton>
      <WholeNumber label="Counts" value={counts} most={1_000_000} onChange={setCounts} />
      <CommandButton need="engineer" onCommand={() => send("push", { slot, counts })}>
        Push by hand
      </CommandButton>
      <CommandButton need="engineer" onCommand={() => send("jump", { slot, counts })}>
        Encoder jumps
      </CommandButton>
      <WholeNumber label="Counts a tick" value={speed} most={1000} onChange={setSpeed} />
      <CommandButton need="engineer" onCommand={() => send("runaway", { slot, counts_per_tick: speed })}>
        Run away
      </CommandButton>
      <CommandButton
        need="engineer"
        off={runaway === 0 ? "It does not run away." : null}
        onCommand={() => send("runaway", { slot, counts_per_tick: 0 })}
      >
        End runaway{runaway !== 0 && " ✕"}
      </CommandButton>
    </fieldset>
  );
}

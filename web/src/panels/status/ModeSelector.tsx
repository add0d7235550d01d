import { useState } from "react";
import { CommandButton } from "../../design/CommandButton";
import { setMode } from "../../state/commands";
import { motionHash, motionKinds } from "../../state/route";
import { useConsole } from "../../state/store";
import { useReason } from "../../state/useReason";

const needsTarget: Readonly<Partial<Record<string, string>>> = {
  cooperative_biopsy: "It needs a target: propose it in the panel Biopsy.",
};

/** The robot's modes. Choosing one does nothing yet: arrow keys choose, too. One that needs targets leads to their form. */
export function ModeSelector() {
  const answer = useConsole((state) => state.mode);
  const reason = useReason("holder");
  const [chosen, setChosen] = useState<string | null>(null);
  const mode = answer?.mode ?? "";
  const wanted = chosen ?? mode;
  const form = wanted === mode ? undefined : motionKinds.find((kind) => kind === wanted);
  const change = async (): Promise<void> => {
    await setMode(wanted);
    setChosen(null);
  };
  return (
    <div className="mode-selector">
      <label htmlFor="robot-mode">Robot mode</label>
      <output aria-label="Robot mode now">{mode === "" ? "unknown" : mode}</output>
      <select
        id="robot-mode"
        value={wanted}
        disabled={reason !== null}
        title={reason ?? undefined}
        onChange={(event) => setChosen(event.target.value)}
      >
        {(answer?.modes ?? []).map((name) => (
          <option key={name}>{name}</option>
        ))}
      </select>
      {form === undefined ? (
        <CommandButton
          need="holder"
          label="Change the robot mode"
          off={wanted === mode ? "The robot is in this mode." : (needsTarget[wanted] ?? null)}
          onCommand={change}
        >
          Change
        </CommandButton>
      ) : (
        <a className="button" href={motionHash(form)} aria-label={`Form of the mode ${form}`}>
          Open form
        </a>
      )}
    </div>
  );
}

import { type FormEvent, useId, useState } from "react";
import type { Motor } from "../../api/client";
import { propose } from "../../state/commands";
import { useReason } from "../../state/useReason";
import { parseEntry, unitName, unitWord } from "../../units/units";

interface TargetEntryProps {
  readonly motor: Motor;
  /** Told of what is typed: counts, null while it is no target and once it was proposed. */
  readonly onTyped: (counts: number | null) => void;
}

/** A target typed in the axis' unit. */
export function TargetEntry({ motor, onTyped }: TargetEntryProps) {
  const [text, setText] = useState("");
  const [expected, setExpected] = useState<string | null>(null);
  const messageId = useId();
  const reason = useReason("setpoint");

  const onType = (typed: string): void => {
    setText(typed);
    const entered = parseEntry(motor, typed);
    onTyped(entered.ok ? Math.round(entered.value * motor.counts_per_unit) : null);
  };

  const onSubmit = (event: FormEvent): void => {
    event.preventDefault();
    const entered = parseEntry(motor, text);
    setExpected(entered.ok ? null : entered.expected);
    onTyped(null);
    if (entered.ok) void propose({ kind: "move", slot: motor.slot, target: entered.value });
  };

  return (
    <form className="target-entry" onSubmit={onSubmit} noValidate>
      <span className="field">
        <input
          value={text}
          disabled={reason !== null}
          title={reason ?? undefined}
          inputMode="decimal"
          autoComplete="off"
          placeholder="target"
          aria-label={`${motor.title} target in ${unitWord(motor)}`}
          aria-invalid={expected !== null}
          aria-describedby={messageId}
          onChange={(event) => onType(event.target.value)}
        />
        <span className="unit">{unitName(motor)}</span>
      </span>
      <button
        type="submit"
        className="button"
        disabled={reason !== null || text.trim() === ""}
        title={reason ?? undefined}
        aria-label={`Propose ${motor.title}`}
      >
        Propose
      </button>
      <span id={messageId} className="entry-error" role="alert">
        {expected !== null && `Not sent: expected ${expected}.`}
      </span>
    </form>
  );
}

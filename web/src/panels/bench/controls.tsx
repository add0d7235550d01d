import { useReason } from "../../state/useReason";

interface ChoiceProps {
  readonly label: string;
  readonly options: readonly string[];
  readonly value: string;
  readonly off?: string | null;
  readonly onChoose: (option: string) => Promise<void>;
}

/** One of few states of a part; anything but the first is a fault. */
export function Choice({ label, options, value, off, onChoose }: ChoiceProps) {
  const reason = useReason("engineer") ?? off ?? null;
  return (
    <label data-faulty={value !== options[0]}>
      {label}{" "}
      <select
        value={value}
        disabled={reason !== null}
        title={reason ?? undefined}
        onChange={(event) => void onChoose(event.target.value)}
      >
        {options.map((option) => (
          <option key={option}>{option}</option>
        ))}
      </select>
    </label>
  );
}

interface WholeNumberProps {
  readonly label: string;
  readonly value: number;
  readonly least?: number;
  readonly most: number;
  readonly onChange: (value: number) => void;
}

/** A whole number within its bounds; what is typed beyond them is brought back. */
export function WholeNumber({ label, value, least, most, onChange }: WholeNumberProps) {
  const lowest = least ?? -most;
  return (
    <label>
      {label}{" "}
      <input
        type="number"
        value={value}
        min={lowest}
        max={most}
        step={1}
        onChange={(event) => {
          const typed = Math.round(event.target.valueAsNumber);
          if (Number.isFinite(typed)) onChange(Math.min(most, Math.max(lowest, typed)));
        }}
      />
    </label>
  );
}

import { type KeyboardEvent, type PointerEvent, useState } from "react";
import type { JogDirection, Motor } from "../../api/client";
import { jogger, propose } from "../../state/commands";
import { useHold } from "../../state/useHold";
import { useReason } from "../../state/useReason";
import type { AxisFrame } from "../../stream/decode";
import { unitName, unitWord } from "../../units/units";
import { countsOf, increments } from "./increments";

/** The app ends a jog 200 ms after the last renewal. */
const RENEW_EVERY_MS = 60;

interface JogPadProps {
  readonly motor: Motor;
  readonly axis: AxisFrame;
}

/** Jogs an axis by a chosen increment, or for as long as a button is held; the pedal has to be held besides. */
export function JogPad({ motor, axis }: JogPadProps) {
  const [increment, setIncrement] = useState<number>(increments[2]);
  const reason = useReason("setpoint");
  const step = (sense: 1 | -1): Promise<void> => {
    const from = axis.setpointCounts ?? axis.positionCounts;
    const target_counts = from + sense * countsOf(motor, increment);
    return propose({ kind: "move", slot: motor.slot, target_counts });
  };
  const stepName = (sign: string): string => `Step ${motor.title} by ${sign}${increment} ${unitWord(motor)}`;
  return (
    <fieldset className="jog-pad" disabled={reason !== null} title={reason ?? undefined}>
      <legend className="visually-hidden">Jog {motor.title}</legend>
      <HoldToJog motor={motor} direction="decreasing" />
      <button type="button" className="button small" aria-label={stepName("−")} onClick={() => void step(-1)}>
        −
      </button>
      <select
        aria-label={`Increment of ${motor.title}`}
        value={increment}
        onChange={({ target }) => setIncrement(Number(target.value))}
      >
        {increments.map((each) => (
          <option key={each} value={each}>
            {each} {unitName(motor)}
          </option>
        ))}
      </select>
      <button type="button" className="button small" aria-label={stepName("+")} onClick={() => void step(1)}>
        +
      </button>
      <HoldToJog motor={motor} direction="increasing" />
    </fieldset>
  );
}

const shapes: Record<JogDirection, string> = { decreasing: "◀", increasing: "▶" };
const ends: Record<JogDirection, string> = { decreasing: "smaller", increasing: "larger" };
const holdingKeys: ReadonlySet<string> = new Set([" ", "Enter"]);

function HoldToJog({ motor, direction }: { readonly motor: Motor; readonly direction: JogDirection }) {
  const mayNot = useReason("setpoint") !== null;
  const [send] = useState(() => jogger(motor.slot, direction));
  const { down, press, letGo } = useHold(send, RENEW_EVERY_MS, mayNot);

  const onPointerDown = (event: PointerEvent<HTMLButtonElement>): void => {
    if (event.button !== 0) return;
    event.currentTarget.setPointerCapture(event.pointerId);
    press();
  };
  const onKeyDown = (event: KeyboardEvent): void => {
    if (!holdingKeys.has(event.key)) return;
    event.preventDefault();
    if (!event.repeat) press();
  };

  return (
    <button
      type="button"
      className="button small hold"
      aria-pressed={down}
      aria-label={`Hold to jog ${motor.title} towards ${ends[direction]} positions`}
      title="Moves while it is held, and the pedal with it."
      onPointerDown={onPointerDown}
      onPointerUp={letGo}
      onPointerCancel={letGo}
      onLostPointerCapture={letGo}
      onContextMenu={(event) => event.preventDefault()}
      onKeyDown={onKeyDown}
      onKeyUp={letGo}
      onBlur={letGo}
    >
      {shapes[direction]}
    </button>
  );
}

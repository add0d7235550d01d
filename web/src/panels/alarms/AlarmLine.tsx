import { useState } from "react";
import { AlarmSign } from "../../design/AlarmSign";
import { allowSound } from "../../state/announce";
import { useConsole } from "../../state/store";
import type { Glance } from "../../stream/decode";
import { AlsoSeen, ModeStrip } from "../header/ModeStrip";
import { AlarmList } from "./AlarmList";
import { AlarmWords, signs } from "./AlarmWords";
import "./alarms.css";

/** One line whose height never changes: the worst alarm or, where nobody has to act soon, what the mode means. A button shows every
 * alarm. Null: the state is unknown. */
export function AlarmLine({ glance }: { readonly glance: Glance | null }) {
  const alarms = useConsole((state) => state.alarms);
  const [shown, setShown] = useState(false);
  const worst = alarms[0];
  if (glance === null || worst === undefined) {
    return (
      <div className="alarm-line">
        <ModeStrip glance={glance} />
      </div>
    );
  }
  const urgent = worst.priority !== "low";
  const rest = urgent ? alarms.length - 1 : alarms.length;
  const toggle = (): void => {
    allowSound();
    setShown(!shown);
  };
  return (
    <div className="alarm-line" data-priority={worst.priority}>
      {urgent ? (
        <p role="alert" title={`${worst.text} ${worst.next_step}`}>
          <AlarmWords alarm={worst} />
          <AlsoSeen glance={glance} />
        </p>
      ) : (
        <ModeStrip glance={glance} />
      )}
      <button
        type="button"
        className="button"
        aria-expanded={shown}
        aria-controls="alarm-list"
        aria-label={alarms.length === 1 ? "1 alarm" : `${alarms.length} alarms`}
        onClick={toggle}
      >
        {urgent ? (
          rest === 0 ? (
            "Details"
          ) : (
            `+${rest} more`
          )
        ) : (
          <>
            <AlarmSign priority={null}>{signs.low}</AlarmSign> {worst.code}
            {rest > 1 && ` +${rest - 1}`}
          </>
        )}
      </button>
      {shown && <AlarmList alarms={alarms} />}
    </div>
  );
}

import { useEffect, useState } from "react";
import type { Alarm } from "../../api/client";
import { AlarmSign } from "../../design/AlarmSign";
import { allowSound } from "../../state/announce";
import { useRoute } from "../../state/route";
import { useConsole } from "../../state/store";
import type { Glance } from "../../stream/decode";
import { AlsoSeen, ModeStrip } from "../header/ModeStrip";
import { AlarmList } from "./AlarmList";
import { AlarmWords, signs } from "./AlarmWords";
import "./alarms.css";

/** One line whose height never changes: the worst alarm or, where nobody has to act soon, what the mode means. A button, which is always
 * there, shows every alarm. */
export function AlarmLine({ glance }: { readonly glance: Glance | null }) {
  const alarms = useConsole((state) => state.alarms);
  const loggedIn = useConsole((state) => state.login.phase === "in");
  const [shown, setShown] = useState(false);
  const route = useRoute();
  const stops = useConsole((state) => state.stops);
  // biome-ignore lint/correctness/useExhaustiveDependencies: another page, and Esc, which is STOP, close the list
  useEffect(() => setShown(false), [route, stops]);
  const worst = glance === null ? undefined : alarms[0];
  const urgent = worst !== undefined && worst.priority !== "low";
  const toggle = (): void => {
    allowSound();
    setShown(!shown);
  };
  return (
    <div className="alarm-line" data-priority={worst?.priority}>
      {urgent ? (
        <p role="alert" title={`${worst.text} ${worst.next_step}`}>
          <AlarmWords alarm={worst} />
          {glance !== null && <AlsoSeen glance={glance} />}
        </p>
      ) : (
        <ModeStrip glance={glance} />
      )}
      {loggedIn && (
        <button
          type="button"
          className={`button ${worst === undefined ? "quiet" : ""}`}
          aria-expanded={shown}
          aria-controls="alarm-list"
          onClick={toggle}
        >
          {glance === null ? "Alarms unknown" : <Count alarms={alarms} />}
        </button>
      )}
      {loggedIn && shown && <AlarmList alarms={alarms} />}
    </div>
  );
}

function Count({ alarms }: { readonly alarms: readonly Alarm[] }) {
  const worst = alarms[0];
  if (worst === undefined) return "No alarm";
  if (worst.priority !== "low") return alarms.length === 1 ? "1 alarm" : `${alarms.length} alarms`;
  return (
    <>
      <AlarmSign priority={null}>{signs.low}</AlarmSign> {worst.code}
      {alarms.length > 1 && ` +${alarms.length - 1}`}
    </>
  );
}

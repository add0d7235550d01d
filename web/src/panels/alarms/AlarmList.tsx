import { useEffect, useState } from "react";
import { type Alarm, api } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { pauseSound, setNotices, setSound, wantsNotices, wantsSound } from "../../state/announce";
import { acknowledgeAlarm, makeReady } from "../../state/commands";
import { useConsole } from "../../state/store";
import { localDate, localTime } from "../../units/time";
import { AlarmWords } from "./AlarmWords";

const layerWords: Readonly<Record<Alarm["layer"], string>> = {
  person: "a person's doing",
  pedal: "the pedal",
  axis: "the axis",
  card: "the card",
  bus: "the bus",
  computer: "this computer",
  simulator: "the simulator",
  kernel: "the kernel",
};

/** Every alarm with what to do, and what ends several of them at once. */
export function AlarmList({ alarms }: { readonly alarms: readonly Alarm[] }) {
  const isFaulted = useConsole(
    (state) => state.frame?.axes.some(({ state: now }) => now === "FAULTED") ?? false,
  );
  return (
    <section id="alarm-list" className="alarm-list" aria-label="Alarms">
      <ul>
        {alarms.map((alarm) => (
          <AlarmRow key={alarm.id} alarm={alarm} />
        ))}
      </ul>
      {alarms.length === 0 && <p className="alarm-facts">Nothing asks anybody to act.</p>}
      <Lately alarms={alarms} />
      <div className="alarm-tools">
        {isFaulted && (
          <CommandButton need="holder" onCommand={makeReady}>
            Clear and enable all
          </CommandButton>
        )}
        <Announcements />
      </div>
    </section>
  );
}

function AlarmRow({ alarm }: { readonly alarm: Alarm }) {
  const titles = useConsole((state) => state.motors)
    .filter(({ name }) => alarm.axes.includes(name))
    .map(({ title }) => title);
  const often = alarm.count === 1 ? "" : `, ${alarm.count} times`;
  return (
    <li data-priority={alarm.priority}>
      <p>
        <AlarmWords alarm={alarm} />
      </p>
      <p className="alarm-facts">
        Priority {alarm.priority}, {layerWords[alarm.layer]}, since{" "}
        <time dateTime={alarm.begun} title={localDate(alarm.begun)}>
          {localTime(alarm.begun)}
        </time>
        {often}
        {titles.length > 1 && `: ${titles.join(", ")}`}
      </p>
      {alarm.acknowledged === null ? (
        <CommandButton
          need="engineer"
          label={`Acknowledge ${alarm.code}`}
          onCommand={() => acknowledgeAlarm(alarm.id)}
        >
          Acknowledge
        </CommandButton>
      ) : (
        <span className="alarm-facts">
          Acknowledged by {alarm.acknowledged.user}, {localTime(alarm.acknowledged.time)}
        </span>
      )}
    </li>
  );
}

/** The last ones that are over. */
function Lately({ alarms }: { readonly alarms: readonly Alarm[] }) {
  const [past, setPast] = useState<readonly Alarm[]>([]);
  // biome-ignore lint/correctness/useExhaustiveDependencies: asked again whenever one has begun or ended
  useEffect(() => {
    void api.alarms().then((answer) => answer.ok && setPast(answer.value.past.slice(0, 5)));
  }, [alarms]);
  if (past.length === 0) return null;
  return (
    <p className="alarm-facts">
      Lately:{" "}
      {past
        .map(({ code, begun, ended }) => `${code} (${localTime(begun)} to ${localTime(ended ?? begun)})`)
        .join(", ")}
    </p>
  );
}

/** Sound and notifications, as this computer has them. */
function Announcements() {
  const [sound, changeSound] = useState(wantsSound);
  const [notices, changeNotices] = useState(wantsNotices);
  const [refused, setRefused] = useState(false);
  return (
    <>
      <label>
        <input
          type="checkbox"
          checked={sound}
          onChange={({ target }) => {
            setSound(target.checked);
            changeSound(target.checked);
          }}
        />{" "}
        Sound
      </label>
      {sound && (
        <button type="button" className="button" onClick={pauseSound}>
          Pause sound for 2 min
        </button>
      )}
      <label>
        <input
          type="checkbox"
          checked={notices}
          onChange={async ({ target: { checked } }) => {
            const done = await setNotices(checked);
            changeNotices(checked && done);
            setRefused(!done);
          }}
        />{" "}
        Notify while the page is hidden
      </label>
      {refused && <span className="alarm-facts">The browser does not let this page notify.</span>}
    </>
  );
}

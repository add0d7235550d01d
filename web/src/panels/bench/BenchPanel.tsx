import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import { catalog, entry } from "../../generated/catalog";
import { bench } from "../../state/commands";
import { useConsole } from "../../state/store";
import { useJammedSlots } from "./useJammedSlots";
import { usePedal } from "./usePedal";
import "./bench.css";

/** The hands and feet of the simulated hardware; exists only with it. */
export function BenchPanel() {
  const refusal = useConsole((state) => state.benchRefusal);
  return (
    <Panel title="Bench" className="bench-panel">
      <p className="bench-banner">SIMULATED HARDWARE</p>
      <Pedal />
      <Estop />
      <Jam />
      <Lamps />
      {refusal !== null && (
        <p className="bench-notice" role="alert">
          <NoticeText lead={`Refused ${refusal.command}:`} notice={refusal.notice} />
        </p>
      )}
    </Panel>
  );
}

function Pedal() {
  const { down, latched, press, lift, toggleLatch } = usePedal();
  return (
    <div className="bench-row">
      <button
        type="button"
        className={`button pedal ${down ? "down" : ""}`}
        onPointerDown={(event) => {
          if (event.button !== 0) return;
          event.currentTarget.setPointerCapture(event.pointerId);
          press();
        }}
        onPointerUp={lift}
        onPointerCancel={lift}
      >
        <i aria-hidden="true">{down ? "▼" : "▽"}</i> Pedal
        <small>{down ? (latched ? "latched down" : "held down") : "press and hold"}</small>
      </button>
      <button type="button" className="button latch" aria-pressed={latched} onClick={toggleLatch}>
        Latch pedal
      </button>
    </div>
  );
}

function Estop() {
  return (
    <div className="bench-row">
      <button type="button" className="button" onClick={() => void bench("estop", { pulled: true })}>
        Pull E-stop
      </button>
      <button type="button" className="button" onClick={() => void bench("estop", { pulled: false })}>
        Release E-stop
      </button>
    </div>
  );
}

/** Which axes are jammed is asked of the simulator, since others may jam them too. */
function Jam() {
  const motors = useConsole((state) => state.motors);
  const [jammed, refresh] = useJammedSlots();
  const toggle = async (slot: number): Promise<void> => {
    await bench("jam", { slot, jammed: !jammed.has(slot) });
    refresh();
  };
  return (
    <fieldset className="jam">
      <legend>Jam an axis</legend>
      {motors.map((motor) => (
        <button
          type="button"
          className="button"
          key={motor.slot}
          aria-label={`Jam ${motor.title}`}
          aria-pressed={jammed.has(motor.slot)}
          onClick={() => void toggle(motor.slot)}
        >
          {motor.title}
          {jammed.has(motor.slot) && " ✕"}
        </button>
      ))}
    </fieldset>
  );
}

function Lamps() {
  const lamps = useConsole((state) => state.frame?.lamps);
  return (
    <ul className="lamps" aria-label="Lamps of the front panel">
      {catalog.lamp.map((lamp) => {
        const colour = entry("colour", lamps?.[lamp.number] ?? "OFF").name.toLowerCase();
        return (
          <li key={lamp.name} title={lamp.meaning}>
            <i data-colour={colour} aria-hidden="true" />
            {lamp.name.toLowerCase()}
            <small>{colour}</small>
          </li>
        );
      })}
    </ul>
  );
}

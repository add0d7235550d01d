import { api } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import { ReasonLine } from "../../design/ReasonLine";
import { catalog, entry } from "../../generated/catalog";
import { bench } from "../../state/commands";
import { useConsole } from "../../state/store";
import { usePolled } from "../../state/usePolled";
import { useReason } from "../../state/useReason";
import { AxisFaults } from "./AxisFaults";
import { plantStatus } from "./benchStatus";
import { CardFaults } from "./CardFaults";
import { ContactFaults } from "./ContactFaults";
import { Forces } from "./Forces";
import type { FaultsProps, SendBench } from "./faults";
import { PlantParameters } from "./PlantParameters";
import { usePedal } from "./usePedal";
import "./bench.css";

const ASK_EVERY_MS = 1000;

/** The hands and feet of the simulated hardware; exists only with it. */
export function BenchPanel() {
  const refusal = useConsole((state) => state.benchRefusal);
  // Asked of the simulator, since others may set faults too.
  const { value, asked, refresh } = usePolled(api.bench, ASK_EVERY_MS);
  const plant = plantStatus(value);
  const send: SendBench = async (command, fields) => {
    await bench(command, fields);
    await refresh();
  };
  return (
    <Panel title="Bench" className="bench-panel" asked={asked}>
      <p className="bench-banner">SIMULATED HARDWARE</p>
      <ReasonLine need="engineer" />
      <Pedal />
      <Estop send={send} />
      {refusal !== null && (
        <p className="bench-notice" role="alert">
          <NoticeText lead={`Refused ${refusal.command}:`} notice={refusal.notice} />
        </p>
      )}
      <Jam plant={plant} send={send} />
      <details className="bench-faults">
        <summary>More faults</summary>
        <AxisFaults plant={plant} send={send} />
        <CardFaults plant={plant} send={send} />
        <Forces plant={plant} send={send} />
        <ContactFaults plant={plant} send={send} />
        <CommandButton need="engineer" onCommand={() => send("clear", {})}>
          End every fault
        </CommandButton>
      </details>
      <details className="bench-faults">
        <summary>Plant parameters</summary>
        <PlantParameters plant={plant} send={send} />
      </details>
      <Lamps />
    </Panel>
  );
}

/** The simulated pedal; whoever leaves its page lifts the foot. */
export function Pedal() {
  const { down, latched, press, lift, toggleLatch } = usePedal();
  const reason = useReason("engineer");
  return (
    <div className="bench-row">
      <button
        type="button"
        className={`button pedal ${down ? "down" : ""}`}
        disabled={reason !== null}
        title={reason ?? undefined}
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
      <button
        type="button"
        className="button latch"
        disabled={reason !== null}
        title={reason ?? undefined}
        aria-pressed={latched}
        onClick={toggleLatch}
      >
        Latch pedal
      </button>
    </div>
  );
}

function Estop({ send }: { readonly send: SendBench }) {
  return (
    <div className="bench-row">
      <CommandButton need="engineer" onCommand={() => send("estop", { pulled: true })}>
        Pull E-stop
      </CommandButton>
      <CommandButton need="engineer" onCommand={() => send("estop", { pulled: false })}>
        Release E-stop
      </CommandButton>
    </div>
  );
}

function Jam({ plant, send }: FaultsProps) {
  const motors = useConsole((state) => state.motors);
  return (
    <fieldset className="jam">
      <legend>Jam an axis</legend>
      {motors.map(({ slot, title }) => {
        const jammed = plant.axes.some((axis) => axis.slot === slot && axis.jammed);
        return (
          <CommandButton
            key={slot}
            need="engineer"
            label={`Jam ${title}`}
            pressed={jammed}
            onCommand={() => send("jam", { slot, jammed: !jammed })}
          >
            {title}
            {jammed && " ✕"}
          </CommandButton>
        );
      })}
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

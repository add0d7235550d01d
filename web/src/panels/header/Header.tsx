import { NoticeText } from "../../design/NoticeText";
import { entry } from "../../generated/catalog";
import { unlock } from "../../state/commands";
import { type Freshness, formatAge } from "../../state/freshness";
import { useConsole } from "../../state/store";
import type { Phase } from "../../stream/connection";
import type { Frame } from "../../stream/decode";
import { ModeStrip } from "./ModeStrip";
import { StopCorner } from "./StopCorner";
import "./header.css";

/** Always visible: what the system is, whether it may move, how old that knowledge is, and STOP. */
export function Header() {
  const level = useConsole((state) => state.freshness.level);
  const known = useConsole((state) => (level === "covered" ? null : state.frame));
  const unlockNotice = useConsole((state) => state.unlockNotice);
  return (
    <header className="header" data-level={level}>
      <Banners />
      <div className="status-bar">
        <Robot />
        <div className="status-data">
          <Mode frame={known} />
          <button
            type="button"
            className="button unlock"
            disabled={known?.mode !== "LOCKED"}
            onClick={() => void unlock()}
          >
            Unlock
          </button>
          <Estop frame={known} />
          <Pedal frame={known} />
        </div>
        <Connection />
        <StopCorner />
      </div>
      <ModeStrip frame={known} />
      {unlockNotice !== null && (
        <p className="unlock-notice" role="alert">
          <NoticeText lead="Unlock refused:" notice={unlockNotice} />
        </p>
      )}
    </header>
  );
}

function Banners() {
  const simulated = useConsole((state) => state.frame?.simulated ?? false);
  const degraded = useConsole((state) => state.frame?.degraded ?? false);
  if (!simulated && !degraded) return null;
  return (
    <div className="banners">
      {simulated && <strong className="banner simulated">SIMULATED HARDWARE</strong>}
      {degraded && <strong className="banner degraded">DEGRADED: no real-time rights</strong>}
    </div>
  );
}

function Robot() {
  const robot = useConsole((state) => state.status?.robot);
  const simulatedClock = useConsole((state) => state.frame?.simulatedClock ?? false);
  return (
    <div className="robot">
      <h1>Interlock</h1>
      <p>
        {robot ?? "no robot yet"}
        {simulatedClock && <span className="clock"> · simulated clock</span>}
      </p>
    </div>
  );
}

const modeShape: Record<string, string> = { INIT: "○", LOCKED: "■", READY: "◇", MOTION: "▶" };

function Mode({ frame }: { readonly frame: Frame | null }) {
  const mode = frame?.mode ?? "UNKNOWN";
  return (
    <div className="cell mode" data-mode={mode} data-cause={frame?.cause}>
      <span className="label">Mode</span>
      <output className="value" aria-label="Mode">
        <i aria-hidden="true">{modeShape[mode] ?? "?"}</i> {mode}
      </output>
    </div>
  );
}

function Estop({ frame }: { readonly frame: Frame | null }) {
  const value = frame === null ? "unknown" : frame.estop ? "PULLED" : "released";
  return (
    <div className={`cell ${frame?.estop ? "alarm-high" : ""}`}>
      <span className="label">E-stop</span>
      <output className="value" aria-label="E-stop">
        <i aria-hidden="true">{frame?.estop ? "⬣" : "⬡"}</i> {value}
      </output>
    </div>
  );
}

function Pedal({ frame }: { readonly frame: Frame | null }) {
  const pressed = frame?.pedal === "PRESSED";
  const disagree = frame !== null && !pressed && frame.pedal !== "RELEASED";
  const value = frame === null ? "unknown" : disagree ? "CHANNELS DISAGREE" : frame.pedal.toLowerCase();
  return (
    <div className={`cell ${disagree ? "alarm-medium" : ""} ${pressed ? "wish" : ""}`}>
      <span className="label">
        Pedal
        {frame !== null && (
          <span title={armedHelp(frame)}> · {frame.pedalArmed ? "armed" : "not armed"}</span>
        )}
      </span>
      <output
        className="value"
        aria-label="Pedal"
        title={frame === null ? "" : entry("pedal", frame.pedal).meaning}
      >
        <i aria-hidden="true">{pressed ? "▼" : "▽"}</i> {value}
      </output>
    </div>
  );
}

function armedHelp(frame: Frame): string {
  return frame.pedalArmed
    ? "A press now starts MOTION."
    : "A press counts only after the pedal was seen released in READY.";
}

function Connection() {
  const phase = useConsole((state) => state.phase);
  const freshness = useConsole((state) => state.freshness);
  const appAlive = useConsole((state) => state.frame?.appAlive ?? false);
  const app = phase === "open" && freshness.reason === "late" ? "silent" : appWord[phase];
  const kernel = kernelWord(freshness, appAlive);
  return (
    <dl className="connection">
      <dt>App</dt>
      <dd className={app === "connected" ? "" : "bad"}>{app}</dd>
      <dt>Kernel</dt>
      <dd className={kernel === "connected" ? "" : "bad"}>{kernel}</dd>
      <dt>Age</dt>
      <dd className={freshness.level === "live" ? "" : "bad"}>{formatAge(freshness.ageMs)}</dd>
    </dl>
  );
}

const appWord: Record<Phase, string> = { connecting: "connecting", open: "connected", lost: "lost" };

function kernelWord(freshness: Freshness, appAlive: boolean): string {
  if (freshness.reason === "no-kernel") return "none";
  if (freshness.level === "covered") return "unknown";
  return appAlive ? "connected" : "does not hear app";
}

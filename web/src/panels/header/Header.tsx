import { AlarmSign } from "../../design/AlarmSign";
import { NoticeText } from "../../design/NoticeText";
import { entry } from "../../generated/catalog";
import { KernelButton } from "../../kernel/KernelButton";
import { alarmOfMode } from "../../state/alarms";
import { unlock } from "../../state/commands";
import { type Freshness, formatAge } from "../../state/freshness";
import { hostLateHelp, hostLateWords } from "../../state/hostLate";
import { useConsole } from "../../state/store";
import type { Phase } from "../../stream/connection";
import type { Glance } from "../../stream/decode";
import { AlarmLine } from "../alarms/AlarmLine";
import { ControlBar } from "./ControlBar";
import { LocalClock } from "./LocalClock";
import { StopCorner } from "./StopCorner";
import { Who } from "./Who";
import "./header.css";

/** Always visible: what the system is, whether it may move, how old that knowledge is, and STOP. */
export function Header() {
  const level = useConsole((state) => state.freshness.level);
  const known = useConsole((state) => (level === "covered" ? null : state.glance));
  const loggedIn = useConsole((state) => state.login.phase === "in");
  const unlockNotice = useConsole((state) => state.unlockNotice);
  const controlNotice = useConsole((state) => state.controlNotice);
  return (
    <header className="header" data-level={level}>
      <div className="status-bar">
        <Robot />
        <div className="status-data">
          <Mode glance={known} />
          {loggedIn && (
            <KernelButton
              request="RESET"
              need="holder"
              className="unlock"
              off={known?.mode === "LOCKED" ? null : "The system is not locked."}
              onCommand={unlock}
            >
              Unlock
            </KernelButton>
          )}
          <Estop glance={known} />
          <Pedal glance={known} />
        </div>
        {loggedIn && <ControlBar />}
        <Connection />
        <Who />
        <StopCorner />
      </div>
      <AlarmLine glance={known} />
      {unlockNotice !== null && (
        <p className="header-notice" role="alert">
          <NoticeText lead="Unlock refused:" notice={unlockNotice} />
        </p>
      )}
      {controlNotice !== null && (
        <p className="header-notice" role="alert">
          <NoticeText lead="Refused:" notice={controlNotice} />
        </p>
      )}
    </header>
  );
}

/** What nobody may take for a robot that moves in earnest. */
function Badges() {
  const simulated = useConsole((state) => state.glance?.simulated ?? false);
  const degraded = useConsole((state) => state.glance?.degraded ?? false);
  const replay = useConsole((state) => state.glance?.replay ?? false);
  return (
    <>
      {replay && <strong className="badge replay">REPLAY OF A RECORDING: NOTHING MOVES</strong>}
      {simulated && <strong className="badge simulated">SIMULATED HARDWARE</strong>}
      {degraded && <strong className="badge degraded">DEGRADED: no real-time rights</strong>}
    </>
  );
}

function Robot() {
  const robot = useConsole((state) => state.status?.robot);
  const clock = useConsole((state) => state.status?.clock);
  const late = useConsole((state) => state.status?.host_late ?? null);
  return (
    <div className="robot">
      <h1>{robot ?? "Interlock"}</h1>
      <Badges />
      <p>
        <LocalClock />
        {clock === "sim" && <span className="clock"> · simulated clock</span>}
        {late !== null && (
          <span className="clock" title={hostLateHelp(late)}>
            {" "}
            · {hostLateWords(late)}
          </span>
        )}
      </p>
    </div>
  );
}

const modeShape: Record<string, string> = { INIT: "○", LOCKED: "■", READY: "◇", MOTION: "▶" };

function Mode({ glance }: { readonly glance: Glance | null }) {
  const mode = glance?.mode ?? "UNKNOWN";
  const alarm = alarmOfMode(mode, glance?.cause ?? "NONE");
  return (
    <div className="cell mode" data-mode={mode} data-alarm={alarm ?? undefined}>
      <span className="label">Mode</span>
      <output className="value" aria-label="Mode">
        <AlarmSign priority={alarm}>{modeShape[mode] ?? "?"}</AlarmSign> {mode}
      </output>
    </div>
  );
}

function Estop({ glance }: { readonly glance: Glance | null }) {
  const value = glance === null ? "unknown" : glance.estop ? "PULLED" : "released";
  const alarm = glance?.estop ? "high" : null;
  return (
    <div className="cell" data-alarm={alarm ?? undefined}>
      <span className="label">E-stop</span>
      <output className="value" aria-label="E-stop">
        <AlarmSign priority={alarm}>{glance?.estop ? "⬣" : "⬡"}</AlarmSign> {value}
      </output>
    </div>
  );
}

function Pedal({ glance }: { readonly glance: Glance | null }) {
  const pressed = glance?.pedal === "PRESSED";
  const disagree = glance !== null && !pressed && glance.pedal !== "RELEASED";
  const alarm = disagree ? "medium" : null;
  const value = glance === null ? "unknown" : disagree ? "CHANNELS DISAGREE" : glance.pedal.toLowerCase();
  return (
    <div className={`cell ${pressed ? "wish" : ""}`} data-alarm={alarm ?? undefined}>
      <span className="label">
        Pedal
        {glance !== null && <span title={armedHelp(glance)}> · {armedWords(glance)}</span>}
      </span>
      <output
        className="value"
        aria-label="Pedal"
        title={glance === null ? "" : entry("pedal", glance.pedal).meaning}
      >
        <AlarmSign priority={alarm}>{pressed ? "▼" : "▽"}</AlarmSign> {value}
      </output>
    </div>
  );
}

function armedWords({ power, pedalArmed, mode }: Glance): string {
  if (mode === "MOTION") return "held";
  if (power === "coming_up") return "power coming up";
  return pedalArmed ? "armed" : "not armed";
}

function armedHelp(glance: Glance): string {
  if (glance.power === "coming_up") return "A press counts only once power is up.";
  return glance.pedalArmed
    ? "A press now starts MOTION."
    : "A press counts only after the pedal was seen released in READY.";
}

function Connection() {
  const phase = useConsole((state) => state.phase);
  const freshness = useConsole((state) => state.freshness);
  const appAlive = useConsole((state) => state.glance?.appAlive ?? false);
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

import type { CardStatus } from "../../api/client";
import { CodeLink } from "../../design/CodeLink";
import { Panel } from "../../design/Panel";
import { Refusal } from "../../design/Refusal";
import { entry } from "../../generated/catalog";
import { formatAge } from "../../state/freshness";
import { useConsole } from "../../state/store";
import { HoldFacts } from "./HoldFacts";
import { ImagerFacts } from "./ImagerFacts";
import { ModeSelector } from "./ModeSelector";
import "./status.css";

const STATUS_EVERY_MS = 1000;

/** The system, the robot's mode, and what each slot of the card rack says. */
export function StatusPanel() {
  const answeredAtMs = useConsole((state) => state.statusAtMs);
  const cards = useConsole((state) => state.status?.cards);
  const notice = useConsole((state) => state.notices.mode);
  return (
    <Panel title="Status" className="status-panel" asked={{ answeredAtMs, everyMs: STATUS_EVERY_MS }}>
      <System />
      <HoldFacts />
      <ImagerFacts />
      <ModeSelector />
      {notice !== undefined && (
        <Refusal place="mode" notice={notice} dismissLabel="Dismiss the refusal of the mode" />
      )}
      <table className="table cards" aria-label="Cards">
        <thead>
          <tr>
            <th scope="col">Slot</th>
            <th scope="col">Card</th>
            <th scope="col">Detected</th>
            <th scope="col">Heartbeat</th>
            <th
              scope="col"
              className="number"
              title="How long the newest valid frame lay back when the app answered"
            >
              Last frame
            </th>
            <th scope="col" className="number" title="Frames whose checksum was wrong">
              Bad sums
            </th>
          </tr>
        </thead>
        <tbody>
          {cards?.map((card) => (
            <CardLine key={card.slot} card={card} />
          ))}
        </tbody>
      </table>
    </Panel>
  );
}

function System() {
  const glance = useConsole((state) => (state.freshness.level === "covered" ? null : state.glance));
  if (glance === null) return <p className="system-words">The state is unknown.</p>;
  const locked = glance.mode === "LOCKED";
  const text = locked ? entry("cause", glance.cause) : entry("mode", glance.mode);
  return (
    <dl className="facts">
      <dt>System</dt>
      <dd>
        <strong>
          <CodeLink family="mode" code={glance.mode} />
        </strong>
        {locked && (
          <>
            {" by "}
            <CodeLink family="cause" code={glance.cause} />
          </>
        )}
        <span className="next-step">{text.next_step}</span>
      </dd>
      <dt>E-stop</dt>
      <dd>
        <Lamp on={glance.estop} /> {glance.estop ? "pulled" : "released"}
      </dd>
      <dt>Pedal</dt>
      <dd>
        <Lamp on={glance.pedal === "PRESSED"} /> {glance.pedal.toLowerCase()},{" "}
        {glance.pedalArmed ? "armed" : "not armed"}
      </dd>
      <dt title="Of the amplifiers: only in READY and MOTION">Power</dt>
      <dd>
        <Lamp on={glance.power === "on"} /> {glance.power.replace("_", " ")}
      </dd>
    </dl>
  );
}

function Lamp({ on }: { readonly on: boolean }) {
  return <i className={`lamp ${on ? "on" : ""}`} aria-hidden="true" />;
}

function CardLine({ card }: { readonly card: CardStatus }) {
  const empty = card.card === "NONE";
  const lost = !empty && !card.detected;
  const silent = !empty && !card.heartbeat_live;
  return (
    <tr data-empty={empty}>
      <td>{card.slot}</td>
      <th scope="row" title={entry("card", card.card).meaning}>
        {empty ? "empty" : card.card.replaceAll("_", " ")}
      </th>
      <td className={lost ? "bad" : ""}>{mark(empty, card.detected, "yes", "NO")}</td>
      <td className={silent ? "bad" : ""} title={`heartbeat ${card.heartbeat}`}>
        {mark(empty, card.heartbeat_live, "live", "SILENT")}
      </td>
      <td className={`number ${lost ? "bad" : ""}`}>{empty ? "–" : frameAge(card.frame_age_ms)}</td>
      <td className={`number ${card.checksum_failures > 0 ? "warn" : ""}`}>
        {empty ? "–" : card.checksum_failures}
      </td>
    </tr>
  );
}

function frameAge(ageMs: number | null): string {
  return ageMs === null ? "never" : formatAge(ageMs);
}

function mark(empty: boolean, good: boolean, yes: string, no: string): string {
  if (empty) return "–";
  return good ? `● ${yes}` : `✕ ${no}`;
}

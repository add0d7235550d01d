import { AlarmSign } from "../../design/AlarmSign";
import { alarmOfFreshness } from "../../state/alarms";
import { type Freshness, formatAge } from "../../state/freshness";
import { useConsole } from "../../state/store";
import "./cover.css";

/** Lies over the panels while their data are not to be trusted. The header and STOP stay free. */
export function Cover() {
  const freshness = useConsole((state) => state.freshness);
  const frameError = useConsole((state) => state.frameError);
  if (freshness.level !== "covered") return null;
  return (
    <div className="cover">
      <div className="cover-text">
        <h2>
          <AlarmSign priority={alarmOfFreshness(freshness)}>▲</AlarmSign> {title(freshness)}
        </h2>
        <div role="alert">
          <p>{advice(freshness, frameError)}</p>
          <p>STOP and Esc are still sent. If anything moves, release the pedal or pull the E-stop.</p>
        </div>
      </div>
    </div>
  );
}

function title(freshness: Freshness): string {
  if (freshness.reason === "no-kernel") return "The app has no kernel";
  if (freshness.reason === "unreadable") return "The app speaks another version";
  return freshness.ageMs === null
    ? "Waiting for the first data"
    : `No data for ${formatAge(freshness.ageMs)}`;
}

function advice(freshness: Freshness, frameError: string | null): string {
  switch (freshness.reason) {
    case "no-kernel":
      return "Nothing is driven by this app. It attaches again by itself when the kernel runs.";
    case "unreadable":
      return `Reload the page; if that does not help, install app and console from the same release (${frameError ?? ""}).`;
    case "no-app":
      return "The app cannot be reached; the console keeps trying.";
    default:
      return "The app does not send. What lies below is old and may be wrong.";
  }
}

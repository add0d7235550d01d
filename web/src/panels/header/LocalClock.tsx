import { useEffect, useState } from "react";
import { localTime } from "../../units/time";

const SECOND_MS = 1000;

/** The time of day here, with its zone, as every time on the page is shown. It is the browser's, not the kernel's. */
export function LocalClock() {
  const [now, setNow] = useState(() => new Date());
  useEffect(() => {
    // Anew each time, so that it turns when the second does.
    const timer = setTimeout(() => setNow(new Date()), SECOND_MS - now.getMilliseconds());
    return () => clearTimeout(timer);
  }, [now]);
  const utc = now.toISOString();
  return (
    <time className="wall-clock" dateTime={utc} title="Time of this computer">
      {localTime(utc)}
    </time>
  );
}

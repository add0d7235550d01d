import { useCallback, useEffect, useState } from "react";
import { api } from "../../api/client";
import { useConsole } from "../../state/store";
import { jammedSlots } from "./benchStatus";

const ASK_EVERY_MS = 1000;

/** The jammed axes, asked of the simulator once a second while data live, and the function that asks at once. */
export function useJammedSlots(): [ReadonlySet<number>, () => void] {
  const [jammed, setJammed] = useState<ReadonlySet<number>>(new Set());
  const live = useConsole((state) => state.freshness.level === "live");
  const refresh = useCallback(async (): Promise<void> => {
    const status = await api.bench();
    if (status.ok) setJammed(jammedSlots(status.value));
  }, []);
  useEffect(() => {
    if (!live) return;
    void refresh();
    const timer = setInterval(() => void refresh(), ASK_EVERY_MS);
    return () => clearInterval(timer);
  }, [live, refresh]);
  return [jammed, () => void refresh()];
}

import { useEffect, useState } from "react";
import { useConsole } from "../../state/store";
import { useReason } from "../../state/useReason";

/** A target that is being chosen, or that was sent and has no answer yet. Nothing moves by it. */
export interface Preview {
  readonly counts: number;
  readonly sent: boolean;
}

/**
 * The preview of one axis. STOP drops it, and so do a mode that drives the setpoints and the loss of control or of the data
 * it was chosen by.
 */
export function usePreview(): [Preview | null, (preview: Preview | null) => void] {
  const [preview, setPreview] = useState<Preview | null>(null);
  const stops = useConsole((state) => state.stops);
  const blind = useConsole((state) => state.freshness.level === "covered");
  const mayNot = useReason("setpoint") !== null;
  useEffect(() => {
    if (stops > 0 || blind || mayNot) setPreview(null);
  }, [stops, blind, mayNot]);
  return [preview, setPreview];
}

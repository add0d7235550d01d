import { useEffect, useState } from "react";
import { Hold, type SendStep } from "./hold";
import { useConsole } from "./store";

interface UseHold {
  readonly down: boolean;
  readonly press: () => void;
  readonly letGo: () => void;
}

/**
 * Something that is held under a pointer or a key. STOP, and whatever takes the page out of the operator's hands
 * (another window or tab, leaving, covered data, the loss of the right to it, a renewal that came too late), lets go.
 * `send` must be the same function in every rendering.
 */
export function useHold(send: SendStep, renewEveryMs: number, mayNot: boolean): UseHold {
  const [wanted, setWanted] = useState(false);
  const blind = useConsole((state) => state.freshness.level === "covered");
  const stops = useConsole((state) => state.stops);
  const [hold] = useState(() => new Hold(send, () => setWanted(false), renewEveryMs));
  const down = wanted && !blind && !mayNot;

  useEffect(() => {
    if (down) hold.press();
    else hold.release();
  }, [down, hold]);

  useEffect(() => {
    if (stops > 0 || blind || mayNot) setWanted(false);
  }, [stops, blind, mayNot]);

  useEffect(() => {
    const letGo = (): void => setWanted(false);
    const onVisibility = (): void => {
      if (document.hidden) letGo();
    };
    window.addEventListener("blur", letGo);
    window.addEventListener("pagehide", letGo);
    document.addEventListener("visibilitychange", onVisibility);
    return () => {
      window.removeEventListener("blur", letGo);
      window.removeEventListener("pagehide", letGo);
      document.removeEventListener("visibilitychange", onVisibility);
      hold.release();
    };
  }, [hold]);

  return { down, press: () => setWanted(true), letGo: () => setWanted(false) };
}

import { useCallback, useEffect, useState } from "react";
import { Hold, type SendStep } from "./hold";
import { useConsole } from "./store";
import { useLetGo } from "./useLetGo";

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
  const letGo = useCallback(() => setWanted(false), []);
  const [hold] = useState(() => new Hold(send, letGo, renewEveryMs));
  const down = wanted && !blind && !mayNot;

  useEffect(() => {
    if (down) hold.press();
    else hold.release();
  }, [down, hold]);

  useEffect(() => {
    if (stops > 0 || blind || mayNot) letGo();
  }, [stops, blind, mayNot, letGo]);

  useLetGo(letGo);

  useEffect(() => () => hold.release(), [hold]);

  return { down, press: () => setWanted(true), letGo };
}

import { useEffect, useState } from "react";
import { bench, showPedalLapse } from "../../state/commands";
import { useConsole } from "../../state/store";
import { PedalFoot, type SendPedal } from "./pedal";

/**
 * The pedal under a pointer, with a latch for those who need the pointer elsewhere. Whatever takes the page out
 * of the operator's hands (another window or tab, leaving, covered data, a page too slow to renew the hold) lifts
 * the foot and opens the latch.
 */
export function usePedal() {
  const [held, setHeld] = useState(false);
  const [latched, setLatched] = useState(false);
  const blind = useConsole((state) => state.freshness.level === "covered");
  const [foot] = useState(() => {
    const send: SendPedal = (pressed) => bench("pedal", { pressed });
    return new PedalFoot(send, () => {
      setHeld(false);
      setLatched(false);
      showPedalLapse(true);
    });
  });
  const down = (held || latched) && !blind;

  useEffect(() => {
    if (!down) {
      foot.release();
      return;
    }
    showPedalLapse(false);
    foot.press();
  }, [down, foot]);

  useEffect(() => {
    const letGo = (): void => {
      setHeld(false);
      setLatched(false);
    };
    const onVisibility = (): void => {
      if (document.hidden) letGo();
    };
    if (blind) letGo();
    window.addEventListener("blur", letGo);
    window.addEventListener("pagehide", letGo);
    document.addEventListener("visibilitychange", onVisibility);
    return () => {
      window.removeEventListener("blur", letGo);
      window.removeEventListener("pagehide", letGo);
      document.removeEventListener("visibilitychange", onVisibility);
      foot.release();
    };
  }, [blind, foot]);

  return {
    down,
    latched,
    press: () => setHeld(true),
    lift: () => setHeld(false),
    toggleLatch: () => setLatched((was) => !was),
  };
}

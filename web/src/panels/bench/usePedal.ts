import { useCallback, useEffect, useState } from "react";
import { movePedal } from "../../state/commands";
import { Hold } from "../../state/hold";
import { useConsole } from "../../state/store";
import { useLetGo } from "../../state/useLetGo";

/** The app releases the pedal 500 ms after the last renewal. */
const RENEW_EVERY_MS = 150;

/**
 * The pedal under a pointer, with a latch for those who need the pointer elsewhere. Whatever takes the page out
 * of the operator's hands (another window or tab, leaving, covered data, a hold that was not renewed in time) lifts
 * the foot and opens the latch.
 */
export function usePedal() {
  const [held, setHeld] = useState(false);
  const [latched, setLatched] = useState(false);
  const blind = useConsole((state) => state.freshness.level === "covered");
  const lift = useCallback(() => {
    setHeld(false);
    setLatched(false);
  }, []);
  const [foot] = useState(() => new Hold(movePedal, lift, RENEW_EVERY_MS));
  const down = (held || latched) && !blind;

  useEffect(() => {
    if (down) foot.press();
    else foot.release();
  }, [down, foot]);

  useEffect(() => {
    if (blind) lift();
  }, [blind, lift]);

  useLetGo(lift);

  useEffect(() => () => foot.release(), [foot]);

  return {
    down,
    latched,
    press: () => setHeld(true),
    lift: () => setHeld(false),
    toggleLatch: () => setLatched((was) => !was),
  };
}

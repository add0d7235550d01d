/** What will become of a wish, in words, by the kernel in the page. */
import type { Motor } from "../api/client";
import { entry } from "../generated/catalog";
import type { AxisFrame, Frame } from "../stream/decode";
import { formatCounts, formatNumber } from "../units/units";
import type { AxisWish, Foresight } from "./pageKernel";

export interface Foretelling {
  readonly outcome: "moves" | "held" | "refused";
  /** The code that decides, of `family`. */
  readonly code: string;
  readonly family: "verdict" | "gate";
  readonly text: string;
  readonly nextStep: string;
}

/** Gates that what was accepted passes, or that are no obstacle to it. */
const harmless: ReadonlySet<string> = new Set(["OPEN", "SETPOINT"]);

export function foretell(
  frame: Frame,
  motor: Motor,
  axis: AxisFrame,
  wish: AxisWish,
  { verdict, gate, mode }: Foresight,
): Foretelling {
  if (verdict !== "ACCEPTED") {
    const nextStep = mode === "LOCKED" ? entry("cause", frame.cause).next_step : "";
    return {
      ...{ outcome: "refused", code: verdict, family: "verdict" },
      text: refusalWords(frame, motor, axis, wish, verdict, mode),
      nextStep: nextStep === "" ? entry("verdict", verdict).next_step : nextStep,
    };
  }
  const obstacle = entry("gate", gate);
  if (!harmless.has(gate)) {
    return {
      ...{ outcome: "held", code: gate, family: "gate" },
      text: `would be accepted, but not driven: ${obstacle.meaning}`,
      nextStep: obstacle.next_step,
    };
  }
  // HOME reads its switch before it drives.
  const arrived = gate === "SETPOINT" && wish.kind === "MOVE";
  return {
    ...{ outcome: "moves", code: "ACCEPTED", family: "verdict" },
    text: arrived
      ? "would be accepted; the axis stands there already."
      : frame.mode === "MOTION"
        ? `would be accepted, and ${wish.kind === "MOVE" ? "move" : "home"} at once.`
        : "would be accepted once the pedal is pressed.",
    nextStep: "",
  };
}

function refusalWords(
  frame: Frame,
  motor: Motor,
  axis: AxisFrame,
  wish: AxisWish,
  verdict: string,
  mode: string,
): string {
  if (verdict === "RANGE" && wish.kind === "MOVE") {
    const allowed = `${formatNumber(motor, axis.minCounts)} to ${formatNumber(motor, axis.maxCounts)}`;
    return `would be refused: ${motor.name} ${formatCounts(motor, wish.targetCounts)}, allowed ${allowed}.`;
  }
  if (verdict === "MODE" && mode === "LOCKED") return `would be refused: LOCKED by ${frame.cause}.`;
  if (verdict === "MODE" && mode === "READY")
    return "would not be sent: the pedal does not start MOTION while a required card is lost or an axis that is not enabled moves.";
  return `would be refused: ${entry("verdict", verdict).meaning}`;
}

/** Why the kernel would refuse a request now; null when it would not, or cannot be asked. */
export function foretellRefusal(frame: Frame | null, verdict: string | null): string | null {
  if (frame === null || verdict === null || verdict === "ACCEPTED") return null;
  const { meaning, next_step } = entry("verdict", verdict);
  const locked = verdict === "MODE" && frame.mode === "LOCKED";
  const why = locked ? `The system is LOCKED by ${frame.cause}.` : meaning;
  const step = locked ? entry("cause", frame.cause).next_step : next_step;
  return `The kernel would refuse it, ${verdict}: ${why} ${step}`.trimEnd();
}

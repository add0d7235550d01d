/** The public status, in the words of the stream: what can be known without login. */
import type { Status } from "../api/client";
import type { Code, Glance } from "../stream/decode";

export function glanceOf(status: Status): Glance {
  return {
    connected: status.connected,
    mode: status.mode as Code<"mode">,
    cause: status.cause as Code<"cause">,
    causeTick: status.cause_tick ?? 0,
    causeValue: status.cause_value ?? 0,
    causesSeen: (status.causes_seen ?? []) as Code<"cause">[],
    pedal: status.pedal as Code<"pedal">,
    pedalArmed: status.pedal_armed,
    power: status.power,
    estop: status.estop,
    appAlive: status.app_alive,
    ageMs: status.age_ms,
    simulated: status.simulated,
    degraded: status.degraded,
    simulatedClock: status.clock !== "real",
    replay: status.replay,
  };
}

/** The stream's text messages that the console uses, see `components/x-stream` of spec/openapi.yaml. */
import type { Alarm, Holds, LogLine, ModeAnswer, MotionControl, Proposal } from "../api/client";

export type StreamMessage =
  | ({ readonly type: "proposal" } & Proposal)
  | ({ readonly type: "control" } & MotionControl)
  | ({ readonly type: "mode" } & ModeAnswer)
  | ({ readonly type: "log" } & LogLine)
  | ({ readonly type: "holds" } & Holds)
  | { readonly type: "alarms"; readonly alarms: Alarm[] }
  | { readonly type: "session"; readonly ended: true };

const used: ReadonlySet<unknown> = new Set([
  "proposal",
  "control",
  "mode",
  "log",
  "holds",
  "alarms",
  "session",
]);

/** The message; null when it is of a type that the console does not use. */
export function streamMessage(text: string): StreamMessage | null {
  const message: unknown = JSON.parse(text);
  return isUsed(message) ? message : null;
}

function isUsed(message: unknown): message is StreamMessage {
  return typeof message === "object" && message !== null && "type" in message && used.has(message.type);
}

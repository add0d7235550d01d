import { describe, expect, it } from "vitest";
import { streamMessage } from "./messages";

describe("streamMessage", () => {
  it.each(["proposal", "control", "mode", "log", "session"])("knows messages of type %s", (type) => {
    expect(streamMessage(JSON.stringify({ type, more: 1 }))).toEqual({ type, more: 1 });
  });

  it.each(['{"type":"event","kind":"mode"}', '{"type":"later"}', "{}", "3", "null"])(
    "leaves %s alone",
    (text) => {
      expect(streamMessage(text)).toBeNull();
    },
  );
});

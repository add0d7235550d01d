import { describe, expect, it } from "vitest";
import { isTyping } from "./keys";

describe("isTyping", () => {
  it.each(["INPUT", "TEXTAREA", "SELECT"])("takes a key in %s for text", (tagName) => {
    expect(isTyping({ tagName })).toBe(true);
  });

  it.each([null, {}, { tagName: "BUTTON" }, { tagName: "BODY" }])(
    "takes a key at %j for a command",
    (target) => {
      expect(isTyping(target)).toBe(false);
    },
  );
});

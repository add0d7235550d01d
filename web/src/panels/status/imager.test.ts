import { describe, expect, it } from "vitest";
import { statusWords, tipWords } from "./imager";

const heard = { client: "127.0.0.1:4242", received: "2026-01-01T00:00:00Z", age_s: 1 };

describe("statusWords", () => {
  it.each([
    [{ code: null, name: "", text: "scanning" }, "scanning"],
    [{ code: 1, name: "", text: "" }, "well"],
    [{ code: 18, name: "COIL", text: "too warm" }, "code 18 · COIL · too warm"],
  ])("%j is %j", (status, words) => {
    expect(statusWords({ ...status, ...heard })).toBe(words);
  });
});

describe("tipWords", () => {
  it("takes the origin of a row-major pose", () => {
    const scanner_from_tip = [0, -1, 0, 12.53, 1, 0, 0, -3, 0, 0, 1, 40, 0, 0, 0, 1];
    expect(tipWords({ scanner_from_tip, ...heard })).toBe("R 12.5, A -3.0, S 40.0 mm");
  });
});

import { expect, test } from "vitest";
import { countWord, formatHeardAge, formatRate, formatRoundTrip } from "./figures";

test("an age gets coarser while it grows", () => {
  expect(formatHeardAge(0.04)).toBe("0.0 s");
  expect(formatHeardAge(9.94)).toBe("9.9 s");
  expect(formatHeardAge(59.9)).toBe("59 s");
  expect(formatHeardAge(60)).toBe("1 min");
  expect(formatHeardAge(7199)).toBe("119 min");
});

test("a rate that one message alone cannot tell is a dash", () => {
  expect(formatRate(null)).toBe("–");
  expect(formatRate(0.25)).toBe("0.3 Hz");
  expect(formatRate(59.9)).toBe("60 Hz");
});

test("a round trip that TCP has not measured is a dash", () => {
  expect(formatRoundTrip(null)).toBe("–");
  expect(formatRoundTrip(0.073)).toBe("0.07 ms");
});

test("one is singular", () => {
  expect(countWord(1, "message")).toBe("1 message");
  expect(countWord(0, "message")).toBe("0 messages");
});

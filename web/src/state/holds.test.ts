import { expect, test } from "vitest";
import type { Holds } from "../api/client";
import { gateWords, scanWords } from "./holds";
import { initialState } from "./store";

const holds: Holds = {
  gate: { in_use: true, state: "no_signal", source: null },
  scan: { active: true, source: "ida, session 3", since: "2026-01-01T00:00:00Z", age_s: 70.4 },
};

test("a gate is shown while it is in use, with whose signal it follows", () => {
  expect(gateWords(null)).toBeNull();
  expect(gateWords({ ...holds, gate: { in_use: false, state: "off", source: "belt" } })).toBeNull();
  expect(gateWords(holds)).toBe("Breathing gate: no signal.");
  expect(gateWords({ ...holds, gate: { in_use: true, state: "hold", source: "belt" } })).toBe(
    "Breathing gate: hold, from belt.",
  );
});

test("a scan grows older while nothing new comes", () => {
  const state = { ...initialState, holds, holdsAtMs: 1000, nowMs: 3000 };
  expect(scanWords(state)).toBe("for 1 min 12 s, by ida, session 3. Nothing moves until it has ended.");
  expect(scanWords({ ...state, holds: { ...holds, scan: { ...holds.scan, active: false } } })).toBeNull();
  expect(scanWords(initialState)).toBeNull();
});

import { expect, test } from "vitest";
import { hostLateHelp, hostLateWords } from "./hostLate";

test("says by how much the host is late, and nothing of less than a millisecond", () => {
  const late = { now_ms: 0.4, worst_ms: 12.4, total_ms: 950 };
  expect(hostLateWords(late)).toBe("host on time");
  expect(hostLateWords({ ...late, now_ms: 34.2 })).toBe("host late by 34 ms");
  expect(hostLateHelp({ ...late, total_ms: 5100 })).toContain("at worst 12 ms, in all 5.1 s");
});

import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { type Footwork, PedalFoot, RENEW_EVERY_MS } from "./pedal";

let sent: Footwork[];
let answers: ((heard: boolean) => void)[];
let lapses: number;
let foot: PedalFoot;

const answerAll = async (heard = true): Promise<void> => {
  for (const answer of answers.splice(0)) answer(heard);
  await vi.advanceTimersByTimeAsync(0);
};

beforeEach(() => {
  vi.useFakeTimers();
  sent = [];
  answers = [];
  lapses = 0;
  foot = new PedalFoot(
    (footwork) => {
      sent.push(footwork);
      return new Promise((resolve) => answers.push(resolve));
    },
    () => {
      lapses += 1;
    },
  );
});

afterEach(() => {
  vi.useRealTimers();
});

describe("PedalFoot", () => {
  it("presses at once and renews while held", async () => {
    foot.press();
    expect(sent).toEqual(["press"]);
    await answerAll();
    await vi.advanceTimersByTimeAsync(RENEW_EVERY_MS);
    await answerAll();
    await vi.advanceTimersByTimeAsync(RENEW_EVERY_MS);
    expect(sent).toEqual(["press", "renew", "renew"]);
  });

  it("releases at once between two renewals, and only once", async () => {
    foot.press();
    await answerAll();
    foot.release();
    foot.release();
    await vi.advanceTimersByTimeAsync(0);
    await answerAll();
    await vi.advanceTimersByTimeAsync(10 * RENEW_EVERY_MS);
    expect(sent).toEqual(["press", "release"]);
  });

  it("never lets the release overtake a press without an answer", async () => {
    foot.press();
    foot.release();
    await vi.advanceTimersByTimeAsync(10 * RENEW_EVERY_MS);
    expect(sent).toEqual(["press"]);
    await answerAll();
    expect(sent).toEqual(["press", "release"]);
  });

  it("presses again after a release that is still on its way", async () => {
    foot.press();
    await answerAll();
    foot.release();
    await vi.advanceTimersByTimeAsync(0);
    foot.press();
    expect(sent).toEqual(["press", "release"]);
    await answerAll();
    expect(sent).toEqual(["press", "release", "press"]);
  });

  it("sends nothing when released without a press", async () => {
    foot.release();
    await vi.advanceTimersByTimeAsync(10 * RENEW_EVERY_MS);
    expect(sent).toEqual([]);
  });

  it("comes off instead of pressing anew when a renewal is refused", async () => {
    foot.press();
    await answerAll();
    await vi.advanceTimersByTimeAsync(RENEW_EVERY_MS);
    await answerAll(false);
    await answerAll();
    await vi.advanceTimersByTimeAsync(10 * RENEW_EVERY_MS);
    expect(sent).toEqual(["press", "renew", "release"]);
    expect(lapses).toBe(1);
  });

  it("comes off when a press is refused", async () => {
    foot.press();
    await answerAll(false);
    await answerAll();
    await vi.advanceTimersByTimeAsync(10 * RENEW_EVERY_MS);
    expect(sent).toEqual(["press", "release"]);
    expect(lapses).toBe(1);
  });

  it("does not count a release as a lapse", async () => {
    foot.press();
    await answerAll();
    foot.release();
    await vi.advanceTimersByTimeAsync(0);
    await answerAll();
    expect(lapses).toBe(0);
  });
});

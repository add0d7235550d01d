import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { Hold, type HoldStep } from "./hold";

const RENEW_EVERY_MS = 150;

let sent: HoldStep[];
let answers: ((heard: boolean) => void)[];
let lapses: number;
let hold: Hold;

const answerAll = async (heard = true): Promise<void> => {
  for (const answer of answers.splice(0)) answer(heard);
  await vi.advanceTimersByTimeAsync(0);
};

beforeEach(() => {
  vi.useFakeTimers();
  sent = [];
  answers = [];
  lapses = 0;
  hold = new Hold(
    (step) => {
      sent.push(step);
      return new Promise((resolve) => answers.push(resolve));
    },
    () => {
      lapses += 1;
    },
    RENEW_EVERY_MS,
  );
});

afterEach(() => {
  vi.useRealTimers();
});

describe("Hold", () => {
  it("presses at once and renews while held", async () => {
    hold.press();
    expect(sent).toEqual(["press"]);
    await answerAll();
    await vi.advanceTimersByTimeAsync(RENEW_EVERY_MS);
    await answerAll();
    await vi.advanceTimersByTimeAsync(RENEW_EVERY_MS);
    expect(sent).toEqual(["press", "renew", "renew"]);
  });

  it("releases at once between two renewals, and only once", async () => {
    hold.press();
    await answerAll();
    hold.release();
    hold.release();
    await vi.advanceTimersByTimeAsync(0);
    await answerAll();
    await vi.advanceTimersByTimeAsync(10 * RENEW_EVERY_MS);
    expect(sent).toEqual(["press", "release"]);
  });

  it("never lets the release overtake a press without an answer", async () => {
    hold.press();
    hold.release();
    await vi.advanceTimersByTimeAsync(10 * RENEW_EVERY_MS);
    expect(sent).toEqual(["press"]);
    await answerAll();
    expect(sent).toEqual(["press", "release"]);
  });

  it("presses again after a release that is still on its way", async () => {
    hold.press();
    await answerAll();
    hold.release();
    await vi.advanceTimersByTimeAsync(0);
    hold.press();
    expect(sent).toEqual(["press", "release"]);
    await answerAll();
    expect(sent).toEqual(["press", "release", "press"]);
  });

  it("sends nothing when released without a press", async () => {
    hold.release();
    await vi.advanceTimersByTimeAsync(10 * RENEW_EVERY_MS);
    expect(sent).toEqual([]);
  });

  it("comes off instead of pressing anew when a renewal is refused", async () => {
    hold.press();
    await answerAll();
    await vi.advanceTimersByTimeAsync(RENEW_EVERY_MS);
    await answerAll(false);
    await answerAll();
    await vi.advanceTimersByTimeAsync(10 * RENEW_EVERY_MS);
    expect(sent).toEqual(["press", "renew", "release"]);
    expect(lapses).toBe(1);
  });

  it("comes off when a press is refused", async () => {
    hold.press();
    await answerAll(false);
    await answerAll();
    await vi.advanceTimersByTimeAsync(10 * RENEW_EVERY_MS);
    expect(sent).toEqual(["press", "release"]);
    expect(lapses).toBe(1);
  });

  it("does not count a release as a lapse", async () => {
    hold.press();
    await answerAll();
    hold.release();
    await vi.advanceTimersByTimeAsync(0);
    await answerAll();
    expect(lapses).toBe(0);
  });
});

import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { PedalFoot, RENEW_EVERY_MS } from "./pedal";

let sent: boolean[];
let answer: (() => void)[];
let foot: PedalFoot;

const answerAll = async (): Promise<void> => {
  for (const resolve of answer.splice(0)) resolve();
  await vi.advanceTimersByTimeAsync(0);
};

beforeEach(() => {
  vi.useFakeTimers();
  sent = [];
  answer = [];
  foot = new PedalFoot((pressed) => {
    sent.push(pressed);
    return new Promise((resolve) => answer.push(resolve));
  });
});

afterEach(() => {
  vi.useRealTimers();
});

describe("PedalFoot", () => {
  it("presses at once and renews while held", async () => {
    foot.press();
    expect(sent).toEqual([true]);
    await answerAll();
    await vi.advanceTimersByTimeAsync(RENEW_EVERY_MS);
    await answerAll();
    await vi.advanceTimersByTimeAsync(RENEW_EVERY_MS);
    expect(sent).toEqual([true, true, true]);
  });

  it("releases at once between two renewals, and only once", async () => {
    foot.press();
    await answerAll();
    foot.release();
    foot.release();
    await vi.advanceTimersByTimeAsync(0);
    await answerAll();
    await vi.advanceTimersByTimeAsync(10 * RENEW_EVERY_MS);
    expect(sent).toEqual([true, false]);
  });

  it("never lets the release overtake a press without an answer", async () => {
    foot.press();
    foot.release();
    await vi.advanceTimersByTimeAsync(10 * RENEW_EVERY_MS);
    expect(sent).toEqual([true]);
    await answerAll();
    expect(sent).toEqual([true, false]);
  });

  it("presses again after a release that is still on its way", async () => {
    foot.press();
    await answerAll();
    foot.release();
    await vi.advanceTimersByTimeAsync(0);
    foot.press();
    expect(sent).toEqual([true, false]);
    await answerAll();
    expect(sent).toEqual([true, false, true]);
  });

  it("sends nothing when released without a press", async () => {
    foot.release();
    await vi.advanceTimersByTimeAsync(10 * RENEW_EVERY_MS);
    expect(sent).toEqual([]);
  });
});

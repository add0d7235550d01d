import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { openStream, type Phase, retryPauseMs, type Stream } from "./connection";

/** The browser's socket with its network end in the hands of the test. */
class SocketInHand {
  static readonly opened: SocketInHand[] = [];
  onopen: (() => void) | null = null;
  onmessage: ((event: { data: ArrayBuffer | string }) => void) | null = null;
  onclose: ((event: { code: number }) => void) | null = null;
  closed = false;
  readyState = 0;
  readonly sent: string[] = [];
  constructor() {
    SocketInHand.opened.push(this);
  }
  send(message: string): void {
    this.sent.push(message);
  }
  close(): void {
    this.closed = true;
  }
}

const latest = (): SocketInHand => SocketInHand.opened.at(-1) as SocketInHand;

let phases: Phase[];
let texts: string[];
let sessionsEnded: number;
let stream: Stream;

beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal("WebSocket", SocketInHand);
  SocketInHand.opened.length = 0;
  phases = [];
  texts = [];
  sessionsEnded = 0;
  stream = openStream("ws://host/api/stream", {
    onBinary: () => undefined,
    onText: (text) => texts.push(text),
    onPhase: (phase) => phases.push(phase),
    onSessionEnded: () => {
      sessionsEnded += 1;
    },
  });
});

afterEach(() => {
  stream.close();
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

describe("openStream", () => {
  it("hands over text and reports phases", () => {
    latest().onopen?.();
    latest().onmessage?.({ data: "{}" });
    expect(phases).toEqual(["connecting", "open"]);
    expect(texts).toEqual(["{}"]);
  });

  it("says stop while it is open, and only then", () => {
    stream.stop();
    expect(latest().sent).toEqual([]);
    latest().readyState = 1;
    stream.stop();
    expect(latest().sent).toEqual(["stop"]);
  });

  it("reconnects after growing pauses and starts over after a message", () => {
    for (const pause of [250, 500, 1000, 2000, 4000, 4000]) {
      const sockets = SocketInHand.opened.length;
      latest().onclose?.({ code: 1006 });
      vi.advanceTimersByTime(pause - 1);
      expect(SocketInHand.opened.length).toBe(sockets);
      vi.advanceTimersByTime(1);
      expect(SocketInHand.opened.length).toBe(sockets + 1);
    }
    latest().onmessage?.({ data: "{}" });
    latest().onclose?.({ code: 1006 });
    vi.advanceTimersByTime(250);
    expect(phases.slice(-3)).toEqual(["connecting", "lost", "connecting"]);
  });

  it("gives up on a peer that is silent for five seconds", () => {
    const silent = latest();
    silent.onopen?.();
    vi.advanceTimersByTime(5000);
    expect(silent.closed).toBe(true);
    expect(phases.at(-1)).toBe("lost");
  });

  it("does not come back when the session ended, and says so", () => {
    latest().onclose?.({ code: 4401 });
    vi.advanceTimersByTime(60_000);
    expect([SocketInHand.opened.length, sessionsEnded]).toEqual([1, 1]);
    expect(phases).not.toContain("lost");
  });

  it("does not come back once closed", () => {
    stream.close();
    vi.advanceTimersByTime(60_000);
    expect(SocketInHand.opened.length).toBe(1);
    expect(latest().closed).toBe(true);
  });
});

describe("retryPauseMs", () => {
  it("is bounded", () => {
    expect(retryPauseMs(1000)).toBe(4000);
  });
});

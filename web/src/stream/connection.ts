/** A WebSocket that comes back: it reconnects with growing pauses and gives up on a silent peer. */

export type Phase = "connecting" | "open" | "lost";

export interface StreamHandlers {
  onBinary(message: ArrayBuffer): void;
  onText(message: string): void;
  onPhase(phase: Phase): void;
  /** The app closed the stream because the session ended; it is not opened again. */
  onSessionEnded(): void;
}

export interface Stream {
  /** Asks for a STOP, if the stream is open. */
  stop(): void;
  /** Ends it for good. */
  close(): void;
}

/** Close code of a stream whose session ended, see spec/openapi.yaml. */
const SESSION_ENDED = 4401;

/** `readyState` of a socket on which one can send. */
const OPEN = 1;

const FIRST_PAUSE_MS = 250;
const LONGEST_PAUSE_MS = 4000;
/** An open socket is not a live peer: a pulled cable gives no close event. */
const SILENCE_MS = 5000;

/** Pause before attempt number `attempt` (0 is the first retry). */
export function retryPauseMs(attempt: number): number {
  return Math.min(LONGEST_PAUSE_MS, FIRST_PAUSE_MS * 2 ** attempt);
}

/** Opens the stream and keeps it open. */
export function openStream(url: string, handlers: StreamHandlers): Stream {
  let socket: WebSocket | null = null;
  let timer: ReturnType<typeof setTimeout> | undefined;
  let attempt = 0;

  const connect = (): void => {
    handlers.onPhase("connecting");
    const opening = new WebSocket(url);
    opening.binaryType = "arraybuffer";
    socket = opening;
    watch();
    opening.onopen = () => handlers.onPhase("open");
    opening.onmessage = (event: MessageEvent<ArrayBuffer | string>) => {
      attempt = 0;
      watch();
      if (typeof event.data === "string") handlers.onText(event.data);
      else handlers.onBinary(event.data);
    };
    opening.onclose = (event: CloseEvent) => {
      if (event.code !== SESSION_ENDED) return lose();
      drop();
      handlers.onSessionEnded();
    };
  };

  const watch = (): void => {
    clearTimeout(timer);
    timer = setTimeout(lose, SILENCE_MS);
  };

  const lose = (): void => {
    drop();
    handlers.onPhase("lost");
    timer = setTimeout(connect, retryPauseMs(attempt));
    attempt += 1;
  };

  const drop = (): void => {
    clearTimeout(timer);
    if (socket === null) return;
    socket.onopen = socket.onmessage = socket.onclose = null;
    socket.close();
    socket = null;
  };

  const stop = (): void => {
    if (socket?.readyState === OPEN) socket.send("stop");
  };

  connect();
  return { stop, close: drop };
}

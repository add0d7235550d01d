import { useCallback, useEffect, useRef, useState } from "react";
import type { Outcome } from "../api/client";
import { type Notice, noticeOfProblem } from "./notice";

/** When an answer came that is asked for again and again; null before the first. */
export interface Asked {
  readonly answeredAtMs: number | null;
  readonly everyMs: number;
}

export interface Polled<Value> {
  readonly value: Value | null;
  readonly asked: Asked;
  /** Why the newest question has no answer. */
  readonly notice: Notice | null;
  /** Asks at once. */
  readonly refresh: () => Promise<void>;
}

/** Asks the app every `everyMs` while the panel is there. `ask` must be the same function in every rendering. */
export function usePolled<Value>(ask: () => Promise<Outcome<Value>>, everyMs: number): Polled<Value> {
  const [value, setValue] = useState<Value | null>(null);
  const [answeredAtMs, setAnsweredAtMs] = useState<number | null>(null);
  const [notice, setNotice] = useState<Notice | null>(null);
  const newest = useRef(0);

  const refresh = useCallback(async (): Promise<void> => {
    newest.current += 1;
    const number = newest.current;
    const outcome = await ask();
    if (number !== newest.current) return;
    setNotice(outcome.ok ? null : noticeOfProblem(outcome.problem));
    if (!outcome.ok) return;
    setValue(outcome.value);
    setAnsweredAtMs(performance.now());
  }, [ask]);

  useEffect(() => {
    let timer: ReturnType<typeof setTimeout> | undefined;
    let gone = false;
    const askOn = async (): Promise<void> => {
      await refresh();
      if (!gone) timer = setTimeout(() => void askOn(), everyMs);
    };
    void askOn();
    return () => {
      gone = true;
      newest.current += 1;
      clearTimeout(timer);
    };
  }, [refresh, everyMs]);

  return { value, asked: { answeredAtMs, everyMs }, notice, refresh };
}

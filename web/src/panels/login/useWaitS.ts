import { useEffect, useState } from "react";
import type { Problem } from "../../api/client";

/** Whole seconds until another attempt makes sense, counted down; 0 when it does now. */
export function useWaitS(problem: Problem | null): number {
  const [leftS, setLeftS] = useState(0);
  useEffect(() => {
    const endMs = performance.now() + 1000 * (problem?.retryAfterS ?? 0);
    const count = (): void => setLeftS(Math.max(0, Math.ceil((endMs - performance.now()) / 1000)));
    count();
    if (problem?.retryAfterS === undefined) return;
    const timer = setInterval(count, 200);
    return () => clearInterval(timer);
  }, [problem]);
  return leftS;
}

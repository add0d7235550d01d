import { useEffect, useState } from "react";
import { api } from "../../api/client";
import { type Notice, noticeOfProblem } from "../../state/notice";
import type { Asked } from "../../state/usePolled";
import { type Rows, withAnswer } from "./rows";

/** Ten times a second is as smooth as a plot of many seconds gets. */
const EVERY_MS = 100;

export interface History {
  readonly rows: Rows | null;
  readonly asked: Asked;
  readonly notice: Notice | null;
}

/**
 * The history of all axes, for as long as the page is there and can be seen; what was missed is fetched then.
 * Nothing is shown before the last answer of several is there: a file saved in between would end early.
 */
export function useHistory(): History {
  const [history, setHistory] = useState<Omit<History, "asked"> & { readonly answeredAtMs: number | null }>({
    rows: null,
    notice: null,
    answeredAtMs: null,
  });
  useEffect(() => {
    let rows: Rows | null = null;
    let timer: ReturnType<typeof setTimeout> | undefined;
    let gone = false;
    let asking = false;
    const ask = async (): Promise<void> => {
      if (asking) return;
      asking = true;
      const answer = await api.history(rows?.newest ?? 0);
      asking = false;
      if (gone) return;
      if (answer.ok) {
        rows = withAnswer(rows, answer.value);
        if (!answer.value.more) setHistory({ rows, notice: null, answeredAtMs: performance.now() });
      } else {
        const notice = noticeOfProblem(answer.problem);
        setHistory((former) => ({ ...former, notice }));
      }
      const atOnce = answer.ok && answer.value.more;
      if (!document.hidden) timer = setTimeout(() => void ask(), atOnce ? 0 : EVERY_MS);
    };
    const onVisibility = (): void => {
      clearTimeout(timer);
      if (!document.hidden) void ask();
    };
    document.addEventListener("visibilitychange", onVisibility);
    void ask();
    return () => {
      gone = true;
      clearTimeout(timer);
      document.removeEventListener("visibilitychange", onVisibility);
    };
  }, []);
  const { rows, notice, answeredAtMs } = history;
  return { rows, notice, asked: { answeredAtMs, everyMs: EVERY_MS } };
}

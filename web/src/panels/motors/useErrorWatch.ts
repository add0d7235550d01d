import { useEffect } from "react";
import { api } from "../../api/client";
import { useErrorMarks, withRows } from "../../state/errorMarks";

const EVERY_MS = 200;

/** Keeps the marks of the following error for as long as the page is there and can be seen; the app remembers two minutes. */
export function useErrorWatch(): void {
  useEffect(() => {
    let gone = false;
    let timer: ReturnType<typeof setTimeout> | undefined;
    const look = async (): Promise<void> => {
      const answer = document.hidden ? null : await api.history(useErrorMarks.getState().newest);
      if (gone) return;
      if (answer?.ok) useErrorMarks.setState((marks) => withRows(marks, answer.value), true);
      timer = setTimeout(() => void look(), answer?.ok && answer.value.more ? 0 : EVERY_MS);
    };
    void look();
    return () => {
      gone = true;
      clearTimeout(timer);
    };
  }, []);
}

import { useState } from "react";
import { keep, kept } from "./shelf";
import { useConsole } from "./store";

/** A text that a user typed or chose, kept until the browser's tab is closed: it survives a look at another page. */
export function useKept(name: string, initial: string): [string, (text: string) => void] {
  const user = useConsole((state) => (state.login.phase === "in" ? state.login.user.name : ""));
  const key = `interlock.${name}.${user}`;
  const [text, setText] = useState(() => kept(sessionStorage, key) ?? initial);
  return [
    text,
    (wanted) => {
      keep(sessionStorage, key, wanted);
      setText(wanted);
    },
  ];
}

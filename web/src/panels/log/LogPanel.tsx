import { useEffect, useRef, useState } from "react";
import { api, type LogLevel, type LogLine } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import { atLeast, levels, matching } from "../../state/log";
import { type Notice, noticeOfProblem } from "../../state/notice";
import { useConsole } from "../../state/store";
import { useReason } from "../../state/useReason";
import { localTime } from "../../units/time";
import "./log.css";

const shapes: Record<LogLevel, string> = { debug: "·", info: "i", warning: "▲", error: "✕", critical: "⬣" };

/** What the app says of itself, newest at the end. */
export function LogPanel() {
  const lines = useConsole((state) => state.log);
  const [least, setLeast] = useState<LogLevel>("info");
  const [paused, setPaused] = useState<readonly LogLine[] | null>(null);
  const [words, setWords] = useState("");
  const shown = matching(atLeast(paused ?? lines, least), words);
  const newer = paused === null ? 0 : newerThan(paused, lines);
  return (
    <Panel
      title="Log"
      className="log-panel"
      tools={
        <>
          <label>
            Show from{" "}
            <select value={least} onChange={(event) => setLeast(event.target.value as LogLevel)}>
              {levels.map((level) => (
                <option key={level}>{level}</option>
              ))}
            </select>
          </label>
          <button
            type="button"
            className="button"
            aria-pressed={paused !== null}
            onClick={() => setPaused(paused === null ? lines : null)}
          >
            {paused === null ? "Pause" : `Paused · ${newer} newer`}
          </button>
          <LevelSetting />
        </>
      }
    >
      <div className="log-tools">
        <input
          type="search"
          className="text"
          placeholder="search"
          aria-label="Search the log"
          autoComplete="off"
          spellCheck={false}
          value={words}
          onChange={(event) => setWords(event.target.value)}
        />
      </div>
      <Tail
        lines={shown}
        following={paused === null}
        emptyWords={words.trim() === "" ? "No line of this level yet." : "No line has these words."}
      />
    </Panel>
  );
}

function newerThan(paused: readonly LogLine[], lines: readonly LogLine[]): number {
  const last = paused.at(-1)?.sequence ?? -1;
  return lines.filter((line) => line.sequence > last).length;
}

interface TailProps {
  readonly lines: readonly LogLine[];
  readonly following: boolean;
  readonly emptyWords: string;
}

/** Stays at the newest line while it follows. */
function Tail({ lines, following, emptyWords }: TailProps) {
  const list = useRef<HTMLOListElement>(null);
  const last = lines.at(-1)?.sequence;
  useEffect(() => {
    if (following && last !== undefined) list.current?.scrollTo({ top: list.current.scrollHeight });
  }, [following, last]);
  return (
    // biome-ignore lint/a11y/noNoninteractiveTabindex: a list that scrolls has to be reached by the keyboard.
    <ol ref={list} className="log" aria-label="Log lines" tabIndex={0}>
      {lines.length === 0 && <li className="log-empty">{emptyWords}</li>}
      {lines.map((line) => (
        <li key={line.sequence} data-level={line.level}>
          <time dateTime={line.time}>{localTime(line.time)}</time>
          <span className="level">
            <i aria-hidden="true">{shapes[line.level]}</i> {line.level}
          </span>
          <span>{line.text}</span>
        </li>
      ))}
    </ol>
  );
}

/** From which level on the app logs; an administrator's choice. */
function LevelSetting() {
  const level = useConsole((state) => state.logLevel);
  const reason = useReason("admin");
  const [chosen, setChosen] = useState<LogLevel | null>(null);
  const [notice, setNotice] = useState<Notice | null>(null);
  const wanted = chosen ?? level;
  if (level === null || wanted === null) return null;
  const change = async (): Promise<void> => {
    const outcome = await api.setLogLevel(wanted);
    setNotice(outcome.ok ? null : noticeOfProblem(outcome.problem));
    if (outcome.ok) useConsole.setState({ logLevel: outcome.value.level });
    setChosen(null);
  };
  return (
    <>
      <label>
        App logs from{" "}
        <select
          value={wanted}
          disabled={reason !== null}
          title={reason ?? undefined}
          onChange={(event) => setChosen(event.target.value as LogLevel)}
        >
          {levels.map((each) => (
            <option key={each}>{each}</option>
          ))}
        </select>
      </label>
      {wanted !== level && (
        <CommandButton need="admin" label="Set the level of the app's log" onCommand={change}>
          Set
        </CommandButton>
      )}
      {notice !== null && (
        <span className="tool-notice" role="alert">
          <NoticeText lead="Refused:" notice={notice} />
        </span>
      )}
    </>
  );
}

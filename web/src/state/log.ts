/** The newest lines of the app's log, as the console keeps them. */
import type { LogLevel, LogLine } from "../api/client";

export const MOST_LINES = 500;

/** By rising weight. */
export const levels: readonly LogLevel[] = ["debug", "info", "warning", "error", "critical"];

/** Both lists by rising sequence, each line once; the newest stay. */
export function mergeLines(known: readonly LogLine[], more: readonly LogLine[]): readonly LogLine[] {
  const bySequence = new Map([...known, ...more].map((line) => [line.sequence, line]));
  return [...bySequence.values()].sort((a, b) => a.sequence - b.sequence).slice(-MOST_LINES);
}

/** The lines of at least that level. */
export function atLeast(lines: readonly LogLine[], level: LogLevel): readonly LogLine[] {
  const least = levels.indexOf(level);
  return lines.filter((line) => levels.indexOf(line.level) >= least);
}

/** The lines whose text or level has all of the words, in any order; all lines without a word. */
export function matching(lines: readonly LogLine[], words: string): readonly LogLine[] {
  const wanted = words
    .toLowerCase()
    .split(/\s+/)
    .filter((word) => word !== "");
  if (wanted.length === 0) return lines;
  return lines.filter((line) => {
    const said = `${line.level} ${line.text}`.toLowerCase();
    return wanted.every((word) => said.includes(word));
  });
}

/** What is wrong in a trajectory file, shown where it stands. */
import type { Problem } from "../../api/client";

export interface WrongCell {
  readonly column: string;
  readonly text: string;
  readonly wrong: boolean;
}

export interface WrongRow {
  /** The header is 1. */
  readonly line: number;
  /** The cells of that line, each under its column; those around the wrong one when there are many. */
  readonly cells: readonly WrongCell[];
  readonly whole: boolean;
}

/** An axis would go beyond its rates; slowed down it would not. */
export function isTooFast({ code }: Problem): boolean {
  return code === "TOO_FAST" || code === "TOO_MUCH_ACCELERATION" || code === "TOO_MUCH_JERK";
}

const MOST_CELLS = 24;
const MOST_CELL_LETTERS = 40;

/** The line of the file that the app named; null when it named none that the file has. */
export function wrongRow(text: string, { line, field }: Problem): WrongRow | null {
  const lines = text.replace(/^\ufeff/, "").split(/\r?\n/, line);
  const found = line === undefined ? undefined : lines[line - 1];
  if (line === undefined || found === undefined || (found === "" && line === lines.length && line > 1))
    return null;
  const columns = cut(lines[0] ?? "");
  const values = cut(found);
  const wrong = field === undefined ? -1 : placeOf(field, line === 1 ? values : columns);
  const count = Math.max(values.length, wrong + 1);
  const first = Math.max(0, Math.min(wrong - MOST_CELLS / 2, count - MOST_CELLS));
  const cells = Array.from({ length: Math.min(count, MOST_CELLS) }, (_, index) => {
    const place = first + index;
    return {
      column: shortened(columns[place] ?? `column ${place + 1}`),
      text: shortened(values[place] ?? ""),
      wrong: place === wrong,
    };
  });
  return { line, cells, whole: wrong < 0 };
}

function cut(line: string): string[] {
  return line.split(",").map((field) => field.trim());
}

/** A column is named by its head, or by its number where it has none. */
function placeOf(field: string, columns: readonly string[]): number {
  const number = /^column (\d+)$/.exec(field)?.[1];
  return number === undefined ? columns.indexOf(field) : Number(number) - 1;
}

function shortened(text: string): string {
  return text.length > MOST_CELL_LETTERS ? `${text.slice(0, MOST_CELL_LETTERS)}…` : text;
}

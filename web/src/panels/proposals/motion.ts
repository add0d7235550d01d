/** Motions that are typed: what each field means, what is wrong in it, and what is sent. */
import type { Motor, ProposalDraft } from "../../api/client";
import type { AxisFrame } from "../../stream/decode";
import { formatCounts, parseEntry } from "../../units/units";
import { numberIn } from "../targeting/numbers";

/** As spec/openapi.yaml has them. */
export const LONGEST_S = 3600;
export const MOST_STEPS = 200;

/** An axis and where its setpoints may lie, in counts. */
export interface Ranged {
  readonly motor: Motor;
  readonly low: number;
  readonly high: number;
}

/** What the kernel accepts of a homed axis now; the soft limits of one that is not, as it has to be homed first. */
export function ranged(motor: Motor, axis: AxisFrame | undefined): Ranged {
  return axis?.homed
    ? { motor, low: axis.minCounts, high: axis.maxCounts }
    : { motor, low: motor.soft_min_counts, high: motor.soft_max_counts };
}

export function rangeWords({ motor, low, high }: Ranged): string {
  return `${formatCounts(motor, low)} to ${formatCounts(motor, high)}`;
}

/** What is wrong, by the name of its field. */
export type Problems = ReadonlyMap<string, string>;

export type Draft =
  | { readonly ok: true; readonly draft: ProposalDraft }
  | { readonly ok: false; readonly problems: Problems };

/** Texts of the form, by field. */
export interface AblationRow {
  /** By which a row is found again when it is moved. */
  readonly id: number;
  readonly rotation: string;
  readonly depth: string;
  readonly dwell: string;
}

type Field = keyof Omit<AblationRow, "id">;

/** By which a field of a row is named. */
export function fieldOf(row: Pick<AblationRow, "id">, field: Field): string {
  return `${row.id}.${field}`;
}

/** Name of the field in which the shortest duration is typed. */
export const DURATION = "duration";

/** `texts`: by the name of the axis; an axis whose text is empty stays where it is. */
export function coordinatedDraft(
  axes: readonly Ranged[],
  texts: Readonly<Record<string, string>>,
  duration: string,
): Draft {
  const problems = new Map<string, string>();
  const targets: Record<string, number> = {};
  const named = axes.filter(({ motor }) => (texts[motor.name] ?? "").trim() !== "");
  for (const axis of named) {
    const { name, title } = axis.motor;
    const read = position(axis, texts[name] ?? "");
    if (typeof read === "number") targets[name] = read;
    else problems.set(name, `${title}: ${read}`);
  }
  if (named.length === 0) problems.set("", "No axis has a target: write one for each axis that is to move.");
  const least = duration.trim() === "" ? 0 : seconds(duration);
  if (typeof least === "string") problems.set(DURATION, `Shortest duration: ${least}`);
  if (problems.size > 0 || typeof least === "string") return { ok: false, problems };
  return { ok: true, draft: { kind: "coordinated", targets, ...(least > 0 ? { duration_s: least } : {}) } };
}

export function ablationDraft(rotation: Ranged, depth: Ranged, rows: readonly AblationRow[]): Draft {
  const problems = new Map<string, string>();
  const read = (row: AblationRow, place: number, field: Field, title: string, value: number | string) => {
    if (typeof value === "number") return value;
    problems.set(fieldOf(row, field), `Step ${place + 1}, ${title}: ${value}`);
    return Number.NaN;
  };
  const steps = rows.map((row, place) => ({
    probe_rotation: read(row, place, "rotation", "rotation", position(rotation, row.rotation)),
    insertion: read(row, place, "depth", "depth", position(depth, row.depth)),
    dwell_s: read(row, place, "dwell", "rest", seconds(row.dwell)),
  }));
  if (rows.length === 0) problems.set("", "There is no step: add one.");
  return problems.size > 0 ? { ok: false, problems } : { ok: true, draft: { kind: "ablation", steps } };
}

/** The list with the row one place earlier (-1) or later (+1); as it is where there is no such place. */
export function movedRow(rows: readonly AblationRow[], at: number, by: -1 | 1): readonly AblationRow[] {
  const [row, other] = [rows[at], rows[at + by]];
  if (row === undefined || other === undefined) return rows;
  return rows.map((each) => (each === row ? other : each === other ? row : each));
}

/** A position in the unit of the interface, or what is wrong with the text. */
function position(axis: Ranged, text: string): number | string {
  const { motor, low, high } = axis;
  const expected = `expected ${rangeWords(axis)}.`;
  if (text.trim() === "") return `it is empty; ${expected}`;
  const entered = parseEntry(motor, text);
  if (!entered.ok) return `“${text.trim()}” is no number; ${expected}`;
  const counts = Math.round(entered.value * motor.counts_per_unit);
  if (counts >= low && counts <= high) return entered.value;
  return `${text.trim()} is outside its range; ${expected}`;
}

function seconds(text: string): number | string {
  const expected = `expected 0 to ${LONGEST_S} s.`;
  if (text.trim() === "") return `it is empty; ${expected}`;
  const value = numberIn(text);
  if (value === null) return `“${text.trim()}” is no number; ${expected}`;
  return value >= 0 && value <= LONGEST_S ? value : `${text.trim()} s is outside its range; ${expected}`;
}

/** Numbers as people type them and as they are shown. */

const NUMBER = /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i;
const MOST_DECIMALS = 6;

/** What is typed; null unless it is one finite number. Comma and point both work, and so does a typographic minus. */
export function numberIn(text: string): number | null {
  const plain = text.trim().replace("−", "-").replace(",", ".");
  if (!NUMBER.test(plain)) return null;
  const value = Number(plain);
  return Number.isFinite(value) ? value : null;
}

/** A value to be edited: at most six decimals, none that are zero; empty where nothing is set. */
export function editable(value: number | null): string {
  return value === null ? "" : plain(Number(value.toFixed(MOST_DECIMALS)));
}

/** A value to be read, with as many decimals as its neighbours. */
export function fixed(value: number, decimals: number): string {
  const text = value.toFixed(decimals);
  return Number(text) === 0 ? text.replace("-", "") : text;
}

/** Numbers apart by commas. */
export function list(values: readonly number[], decimals: number): string {
  return values.map((value) => fixed(value, decimals)).join(", ");
}

/** Never `-0`, never `1e-7`. */
function plain(value: number): string {
  return value === 0 ? "0" : String(value);
}

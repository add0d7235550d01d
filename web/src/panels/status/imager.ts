/** The words of an imager, as they are shown. */
import type { Imager } from "../../api/client";

/** The code by which OpenIGTLink says that all is well. */
const WELL = 1;

export function statusWords({ code, name, text }: NonNullable<Imager["status"]>): string {
  if (code === null) return text;
  const state = code === WELL ? "well" : `code ${code}`;
  return [state, name, text].filter((part) => part !== "").join(" · ");
}

/** Where the tip is, its direction left out: three numbers are read at a glance. */
export function tipWords({ scanner_from_tip: pose }: NonNullable<Imager["tip"]>): string {
  const [x, y, z] = [3, 7, 11].map((place) => (pose[place] ?? Number.NaN).toFixed(1));
  return `R ${x}, A ${y}, S ${z} mm`;
}

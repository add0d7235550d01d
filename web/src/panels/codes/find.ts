/** Finding a code by what an operator remembers of it. */
import type { CatalogEntry } from "../../generated/catalog";

/** Whether each word that is sought is somewhere in name, meaning, cause or next step. */
export function isFound(code: CatalogEntry, sought: string): boolean {
  const text = `${code.name} ${code.meaning} ${code.cause} ${code.next_step}`.toLowerCase();
  return sought
    .toLowerCase()
    .split(/\s+/)
    .every((word) => text.includes(word));
}

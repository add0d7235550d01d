/** The audit's records as they are read: newest first, page by page. */
import type { AuditRecord } from "../../api/client";

/** All records by falling number, each once. */
export function mergeRecords(
  known: readonly AuditRecord[],
  more: readonly AuditRecord[],
): readonly AuditRecord[] {
  const byNumber = new Map([...known, ...more].map((record) => [record.number, record]));
  return [...byNumber.values()].sort((a, b) => b.number - a.number);
}

/** A record's detail in one line: `role viewer, enabled true`. */
export function detailText(detail: Readonly<Record<string, unknown>>): string {
  return Object.entries(detail)
    .map(([name, value]) => `${name} ${typeof value === "string" ? value : JSON.stringify(value)}`)
    .join(", ");
}

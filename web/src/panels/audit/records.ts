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

const COLUMNS = ["number", "time", "tick", "actor", "session", "kind", "detail", "hash"] as const;

/** Oldest first, for other programs: a header, then a row a record, its detail as JSON (RFC 4180). */
export function recordsCsv(records: readonly AuditRecord[]): string {
  const field = (value: unknown): string => {
    const text = typeof value === "object" && value !== null ? JSON.stringify(value) : `${value ?? ""}`;
    return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  const rows = [...records].reverse().map((record) => COLUMNS.map((name) => field(record[name])).join(","));
  return [COLUMNS.join(","), ...rows, ""].join("\r\n");
}

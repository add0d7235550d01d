/** How late the computer is on which a simulated robot runs: simulated time waits for it. */
import type { Status } from "../api/client";
import { formatAge } from "./freshness";

export type HostLate = NonNullable<Status["host_late"]>;

export function hostLateWords(late: HostLate): string {
  return late.now_ms < 1 ? "host on time" : `host late by ${formatAge(late.now_ms)}`;
}

export function hostLateHelp(late: HostLate): string {
  const waits = `${formatAge(late.now_ms)} in the last second, at worst ${formatAge(late.worst_ms)}, in all ${formatAge(late.total_ms)}`;
  return `Simulated time waits for a busy machine: ${waits}.`;
}

import type { ReactNode } from "react";
import type { AlarmPriority } from "../state/alarms";
import "./alarm.css";

interface AlarmSignProps {
  /** Null: the sign stands still. */
  readonly priority: AlarmPriority | null;
  readonly children: ReactNode;
}

/** The sign of a condition, beside its words; it flashes as fast as its alarm is urgent. */
export function AlarmSign({ priority, children }: AlarmSignProps) {
  return (
    <i className="alarm-sign" aria-hidden="true" data-priority={priority ?? undefined}>
      {children}
    </i>
  );
}

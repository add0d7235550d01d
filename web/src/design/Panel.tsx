import type { ReactNode } from "react";
import { formatAge } from "../state/freshness";
import { useConsole } from "../state/store";
import "./panel.css";

interface PanelProps {
  readonly title: string;
  readonly className?: string;
  readonly children: ReactNode;
}

/** A titled part of the page with the dot in its corner that tells whether its data live. */
export function Panel({ title, className, children }: PanelProps) {
  return (
    <section className={`panel ${className ?? ""}`} aria-label={title}>
      <header className="panel-head">
        <h2>{title}</h2>
        <LifeDot />
      </header>
      {children}
    </section>
  );
}

function LifeDot() {
  const live = useConsole((state) => state.freshness.level === "live");
  const age = useConsole((state) =>
    state.freshness.level === "live" ? "" : formatAge(state.freshness.ageMs),
  );
  return (
    <span className={`life-dot ${live ? "live" : "stale"}`}>
      <i aria-hidden="true" />
      {live ? "live" : `stale · ${age}`}
    </span>
  );
}

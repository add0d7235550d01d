import { type ReactNode, useContext } from "react";
import { formatAge } from "../state/freshness";
import { type ConsoleState, useConsole } from "../state/store";
import type { Asked } from "../state/usePolled";
import { PlaceContext, PlaceTools } from "./PanelPlace";
import "./panel.css";

interface PanelProps {
  readonly title: string;
  readonly className?: string;
  /** The question that the panel's data answer; those of the other panels come by the stream. */
  readonly asked?: Asked;
  /** Beside the title. */
  readonly tools?: ReactNode;
  readonly children: ReactNode;
}

/** A titled part of the page with the dot in its corner that tells whether its data live. */
export function Panel({ title, className, asked, tools, children }: PanelProps) {
  const folded = useContext(PlaceContext)?.folded ?? false;
  const late = useConsole((state) => asked !== undefined && askedAge(state.nowMs, asked) !== null);
  return (
    <section
      className={`panel ${className ?? ""} ${folded ? "folded" : ""}`}
      aria-label={title}
      data-late={late || undefined}
    >
      <header className="panel-head">
        <h2>{title}</h2>
        {tools !== undefined && !folded && <div className="panel-tools">{tools}</div>}
        <PlaceTools title={title} />
        <LifeDot asked={asked} />
      </header>
      {!folded && children}
    </section>
  );
}

function LifeDot({ asked }: { readonly asked: Asked | undefined }) {
  const age = useConsole((state) => (asked === undefined ? streamAge(state) : askedAge(state.nowMs, asked)));
  return (
    <span className={`life-dot ${age === null ? "live" : "stale"}`}>
      <i aria-hidden="true" />
      {age === null ? "live" : `stale · ${age}`}
    </span>
  );
}

function streamAge({ freshness }: ConsoleState): string | null {
  return freshness.level === "live" ? null : formatAge(freshness.ageMs);
}

/** An answer may take a moment before its absence is news. */
const ANSWER_MAY_TAKE_MS = 1000;

function askedAge(nowMs: number, { answeredAtMs, everyMs }: Asked): string | null {
  if (answeredAtMs === null) return "none";
  const ageMs = nowMs - answeredAtMs;
  return ageMs <= everyMs + ANSWER_MAY_TAKE_MS ? null : formatAge(ageMs);
}

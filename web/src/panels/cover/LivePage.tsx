import type { ReactNode } from "react";
import { useConsole } from "../../state/store";
import { Cover } from "./Cover";

interface LivePageProps {
  /** Of the page, for its own grid. */
  readonly className?: string;
  readonly children: ReactNode;
}

/** The panels of a page that shows the robot: greyed, then covered and out of reach while their data are old. */
export function LivePage({ className = "", children }: LivePageProps) {
  const level = useConsole((state) => state.freshness.level);
  return (
    <main className="stage" data-level={level}>
      <div className={`panels ${className}`} inert={level === "covered"}>
        {children}
      </div>
      <Cover />
    </main>
  );
}

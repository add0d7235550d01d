/** Where the documents tell what a code rests on, when they were built and the app serves them. */
import { useEffect, useState } from "react";

const page = "/docs/report/trace.html";

/** The page of a property: the requirements that it formalises, their code, and every result. */
export function evidencePlace(property: string): string {
  return `${page}#${property}`;
}

/** Whether the app serves the report. */
export function useHasEvidence(): boolean {
  const [has, setHas] = useState(false);
  useEffect(() => {
    const asked = new AbortController();
    fetch(page, { method: "HEAD", signal: asked.signal }).then(
      ({ ok }) => setHas(ok),
      () => setHas(false),
    );
    return () => asked.abort();
  }, []);
  return has;
}

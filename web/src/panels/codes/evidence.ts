/** Where the documents tell what a code rests on. An app that has none answers how to bring them. */

/** The page of a property: the requirements that it formalises, their code, and every result. */
export function evidencePlace(property: string): string {
  return `/docs/report/trace.html#${property}`;
}

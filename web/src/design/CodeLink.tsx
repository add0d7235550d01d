import { entry, type Family } from "../generated/catalog";
import { codeHash } from "../state/route";

interface CodeLinkProps {
  readonly family: Family;
  readonly code: string;
}

/** A code's name, leading to its place in the catalog. */
export function CodeLink({ family, code }: CodeLinkProps) {
  return (
    <a className="code-link" href={codeHash(family, code)} title={entry(family, code).meaning}>
      {code}
    </a>
  );
}

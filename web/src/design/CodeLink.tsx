import { entry, type Family } from "../generated/catalog";
import { codeHash } from "../state/route";
import { useConsole } from "../state/store";

interface CodeLinkProps {
  readonly family: Family;
  readonly code: string;
}

/** A code's name; it leads to its place in the catalog whoever is logged in, as nobody else sees that page. */
export function CodeLink({ family, code }: CodeLinkProps) {
  const loggedIn = useConsole((state) => state.login.phase === "in");
  if (!loggedIn) return code;
  return (
    <a className="code-link" href={codeHash(family, code)} title={entry(family, code).meaning}>
      {code}
    </a>
  );
}

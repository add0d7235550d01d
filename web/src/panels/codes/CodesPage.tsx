import { useEffect, useState } from "react";
import { Panel } from "../../design/Panel";
import { type CatalogEntry, catalog, type Family } from "../../generated/catalog";
import { codeHash, useCodePlace } from "../../state/route";
import { evidencePlace } from "./evidence";
import { isFound } from "./find";
import "./codes.css";

/** The families that operators meet, those that answer a question first. */
const shown: readonly { readonly family: Family; readonly title: string; readonly words: string }[] = [
  {
    family: "gate",
    title: "Gates",
    words: "What stands between a wish and a driven axis, in the order of checking.",
  },
  { family: "verdict", title: "Verdicts", words: "The kernel's one answer to a request." },
  { family: "fault", title: "Faults", words: "Why an axis is FAULTED." },
  { family: "cause", title: "Causes", words: "Why the system is LOCKED." },
  { family: "mode", title: "Modes", words: "What the system may do." },
  { family: "axis_state", title: "Axis states", words: "What an axis may do." },
];

/** Every code that an operator meets: what it means, what probably caused it, what to do next. */
export function CodesPage() {
  const [sought, setSought] = useState("");
  return (
    <Panel title="Codes" className="page-panel codes">
      <p className="page-words">
        <label>
          Find{" "}
          <input
            className="text"
            type="search"
            value={sought}
            onChange={({ target }) => setSought(target.value)}
          />
        </label>
      </p>
      {shown.map(({ family, title, words }) => {
        const codes = catalog[family].filter((code) => isFound(code, sought));
        return codes.length === 0 ? null : (
          <section key={family} aria-label={title}>
            <h3>{title}</h3>
            <p className="page-words">{words}</p>
            {codes.map((code) => (
              <Code key={code.name} family={family} code={code} />
            ))}
          </section>
        );
      })}
    </Panel>
  );
}

function Code({ family, code }: { readonly family: Family; readonly code: CatalogEntry }) {
  const place = useCodePlace();
  const meant = place?.family === family && place.code === code.name;
  const id = `${family}-${code.name}`;
  useEffect(() => {
    if (meant) document.getElementById(id)?.scrollIntoView({ block: "center" });
  }, [meant, id]);
  return (
    <article id={id} className="code" aria-label={code.name} aria-current={meant ? "location" : undefined}>
      <h4>
        <a href={codeHash(family, code.name)}>{code.name}</a> <small>{code.number}</small>
      </h4>
      <p>{code.meaning}</p>
      <dl>
        <dt>Likely cause</dt>
        <dd>{code.cause}</dd>
        <dt>Next step</dt>
        <dd>{code.next_step}</dd>
        <dt>Clears when</dt>
        <dd>{code.clears}</dd>
        {code.properties.length > 0 && (
          <>
            <dt>Evidence</dt>
            <dd>
              {code.properties.map((property) => (
                <a key={property} href={evidencePlace(property)} target="_blank" rel="noreferrer">
                  {property}
                </a>
              ))}
            </dd>
          </>
        )}
      </dl>
    </article>
  );
}

import { api, type Imager } from "../../api/client";
import { usePolled } from "../../state/usePolled";
import { formatHeardAge } from "../navigation/figures";
import { statusWords, tipWords } from "./imager";

const ASK_EVERY_MS = 1000;

/** What imagers said last by OpenIGTLink, and how long ago. */
export function ImagerFacts() {
  const { value } = usePolled(api.imager, ASK_EVERY_MS);
  return (
    <section aria-label="Imager">
      <dl className="facts">
        <dt>Imager</dt>
        <dd>
          <Word word={value?.status ?? null} say={statusWords} none="no status heard" />
        </dd>
        <dt>Needle tip</dt>
        <dd>
          <Word word={value?.tip ?? null} say={tipWords} none="no pose heard" />
        </dd>
      </dl>
    </section>
  );
}

type Heard = NonNullable<Imager["status"] | Imager["tip"]>;

interface WordProps<Said extends Heard> {
  readonly word: Said | null;
  readonly say: (word: Said) => string;
  readonly none: string;
}

function Word<Said extends Heard>({ word, say, none }: WordProps<Said>) {
  if (word === null) return none;
  return (
    <>
      <strong>{say(word)}</strong>{" "}
      <span className="next-step">
        {formatHeardAge(word.age_s)} ago, from {word.client}
      </span>
    </>
  );
}

import { useId, useState } from "react";
import { type AuditCheck, api } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { NoticeText } from "../../design/NoticeText";
import { type Notice, noticeOfProblem } from "../../state/notice";
import { localDate } from "../../units/time";

type Checked =
  | { readonly phase: "never" }
  | { readonly phase: "answered"; readonly check: AuditCheck; readonly noted: string }
  | { readonly phase: "refused"; readonly notice: Notice };

/** Has the app go over the chain of hashes, and shows what it found. */
export function ChainCheck() {
  const [checked, setChecked] = useState<Checked>({ phase: "never" });
  const [noted, setNoted] = useState("");
  const notedId = useId();
  const verify = async (): Promise<void> => {
    const wanted = noted.trim();
    const outcome = await api.verifyAudit(wanted === "" ? undefined : wanted);
    setChecked(
      outcome.ok
        ? { phase: "answered", check: outcome.value, noted: wanted }
        : { phase: "refused", notice: noticeOfProblem(outcome.problem) },
    );
  };
  return (
    <section className="chain-check" aria-label="Check of the chain">
      <p className="page-words">
        Each record carries the hash of the one before. The check goes over all of them; only heads that were
        noted elsewhere, by the recorder or by you, show that records were cut off or written anew.
      </p>
      <label htmlFor={notedId}>Hash noted earlier</label>
      <input
        id={notedId}
        className="text"
        placeholder="none"
        autoComplete="off"
        spellCheck={false}
        value={noted}
        onChange={(event) => setNoted(event.target.value)}
      />
      <CommandButton need="admin" onCommand={verify}>
        Check the chain
      </CommandButton>
      <div role="status" aria-label="Result of the check">
        <Result checked={checked} />
      </div>
    </section>
  );
}

function Result({ checked }: { readonly checked: Checked }) {
  if (checked.phase === "never") return "Not checked yet.";
  if (checked.phase === "refused") return <NoticeText lead="No answer:" notice={checked.notice} />;
  const { head, broken, proven, noted_heads: heads } = checked.check;
  const when = localDate(checked.check.checked);
  if (broken !== null) {
    return (
      <strong className="bad">
        ✕ BROKEN: record {broken.number} {broken.problem}. Checked {when}. Keep the store, and compare it with
        a backup.
      </strong>
    );
  }
  return (
    <>
      {proven ? <strong>✓ Unbroken</strong> : <strong className="bad">✕ NOT PROVEN: unbroken</strong>} up to
      record {head?.number}, checked {when}
      {checked.noted !== "" && ", with the hash noted earlier among them"}; {heads?.summary}.
      {!proven && " See that somebody did this, and compare with a backup or the files of retired records."}{" "}
      Head to note: <code>{head?.hash}</code>
    </>
  );
}

import { useState } from "react";
import { api, type PositionsFile } from "../../api/client";
import { NoticeText } from "../../design/NoticeText";
import { type Notice, noticeOfProblem } from "../../state/notice";
import { fileName } from "./file";

/** Writes the present positions to a file of the operator's computer. */
export function SaveButton() {
  const [notice, setNotice] = useState<Notice | null>(null);
  const save = async (): Promise<void> => {
    const outcome = await api.positions();
    setNotice(outcome.ok ? null : noticeOfProblem(outcome.problem));
    if (outcome.ok) download(outcome.value);
  };
  return (
    <>
      {notice !== null && (
        <span className="tool-notice" role="alert">
          <NoticeText lead="Not saved:" notice={notice} />
        </span>
      )}
      <button
        type="button"
        className="button"
        aria-label="Save positions"
        title="Download the present positions as a file"
        onClick={() => void save()}
      >
        Save
      </button>
    </>
  );
}

function download(file: PositionsFile): void {
  const url = URL.createObjectURL(
    new Blob([`${JSON.stringify(file, null, 2)}\n`], { type: "application/json" }),
  );
  const link = document.createElement("a");
  link.href = url;
  link.download = fileName(file);
  link.click();
  // The browser reads it after this handler has ended.
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

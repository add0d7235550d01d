import { useState } from "react";
import { api } from "../../api/client";
import { download } from "../../design/download";
import { NoticeText } from "../../design/NoticeText";
import { type Notice, noticeOfProblem } from "../../state/notice";
import { fileName } from "./file";

/** Writes the present positions to a file of the operator's computer. */
export function SaveButton() {
  const [notice, setNotice] = useState<Notice | null>(null);
  const save = async (): Promise<void> => {
    const outcome = await api.positions();
    setNotice(outcome.ok ? null : noticeOfProblem(outcome.problem));
    if (!outcome.ok) return;
    download(fileName(outcome.value), "application/json", `${JSON.stringify(outcome.value, null, 2)}\n`);
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

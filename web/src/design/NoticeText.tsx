import type { Notice } from "../state/notice";

/** A refusal in words: its name, what it means, what to do next. */
export function NoticeText({ lead, notice }: { readonly lead: string; readonly notice: Notice }) {
  return (
    <span className="notice">
      {lead} <strong>{notice.code}</strong>: {notice.meaning}{" "}
      {notice.nextStep !== "" && <span className="next-step">{notice.nextStep}</span>}
    </span>
  );
}

import { isVerdict, type Notice } from "../state/notice";
import { CodeLink } from "./CodeLink";

/** A refusal in words: its name, what it means, what to do next. */
export function NoticeText({ lead, notice }: { readonly lead: string; readonly notice: Notice }) {
  return (
    <span className="notice">
      {lead}{" "}
      <strong>
        {isVerdict(notice.code) ? <CodeLink family="verdict" code={notice.code} /> : notice.code}
      </strong>
      : {notice.meaning} {notice.nextStep !== "" && <span className="next-step">{notice.nextStep}</span>}
    </span>
  );
}

import { dismissNotice } from "../state/commands";
import type { Notice } from "../state/notice";
import type { Place } from "../state/store";
import { NoticeText } from "./NoticeText";

interface RefusalProps {
  readonly place: Place;
  readonly notice: Notice;
  readonly dismissLabel: string;
}

/** What was refused at a place, until it is dismissed. */
export function Refusal({ place, notice, dismissLabel }: RefusalProps) {
  return (
    <div className="refusal" role="alert">
      <NoticeText lead="Refused:" notice={notice} />
      <button
        type="button"
        className="button quiet"
        aria-label={dismissLabel}
        onClick={() => dismissNotice(place)}
      >
        ✕
      </button>
    </div>
  );
}

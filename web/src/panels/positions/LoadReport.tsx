import { NoticeText } from "../../design/NoticeText";
import { VerdictList } from "../../design/VerdictList";
import { ComparisonTable } from "./ComparisonTable";
import type { Loading } from "./useLoad";

/** What became of a file that was loaded. */
export function LoadReport({ load, restore, close }: Loading) {
  switch (load.phase) {
    case "idle":
      return null;
    case "refused":
      return (
        <div className="refusal" role="alert">
          <NoticeText lead="Not loaded:" notice={load.notice} />
          <button
            type="button"
            className="button quiet"
            aria-label="Dismiss the refusal of the file"
            onClick={close}
          >
            ✕
          </button>
        </div>
      );
    case "compared":
      return (
        <ComparisonTable
          key={load.comparison.saved}
          name={load.name}
          comparison={load.comparison}
          onConfirm={restore}
          onCancel={close}
        />
      );
    case "answered":
      return (
        <VerdictList title="Load positions" answer={{ ok: true, value: load.verdicts }} onClose={close} />
      );
  }
}

import { api } from "../../api/client";
import { NoticeText } from "../../design/NoticeText";
import { usePolled } from "../../state/usePolled";
import { LivePage } from "../cover/LivePage";
import { AimPanel } from "./AimPanel";
import { AlignmentPanel } from "./AlignmentPanel";
import { HistoryPanel } from "./HistoryPanel";
import { PosesPanel } from "./PosesPanel";
import { RegistrationPanel } from "./RegistrationPanel";
import "./targeting.css";

const TARGETING_EVERY_MS = 500;
const ALIGNMENT_EVERY_MS = 250;
const HISTORY_EVERY_MS = 1000;

/** Where the robot is in the scanner, where it is to go, what that asks of it, and who said so. */
export default function TargetingPage() {
  return (
    <LivePage className="targeting-page">
      <Panels />
    </LivePage>
  );
}

function Panels() {
  const targeting = usePolled(api.targeting, TARGETING_EVERY_MS);
  const view = usePolled(api.alignment, ALIGNMENT_EVERY_MS);
  const history = usePolled(api.targetingHistory, HISTORY_EVERY_MS);
  const notice = targeting.notice ?? view.notice ?? history.notice;
  const refresh = async (): Promise<void> => {
    await Promise.all([targeting.refresh(), view.refresh(), history.refresh()]);
  };
  return (
    <>
      {notice !== null && (
        <p className="panel-notice targeting-notice" role="alert">
          <NoticeText lead="No newer values:" notice={notice} />
        </p>
      )}
      {targeting.value !== null && (
        <>
          <RegistrationPanel
            targeting={targeting.value}
            history={history.value}
            asked={targeting.asked}
            onSet={refresh}
          />
          <AimPanel
            targeting={targeting.value}
            history={history.value}
            asked={targeting.asked}
            onSet={refresh}
          />
          <AlignmentPanel view={view.value} asked={view.asked} />
          <PosesPanel
            view={view.value}
            reported={targeting.value.reported_position}
            history={history.value}
            asked={view.asked}
          />
          <HistoryPanel history={history.value} asked={history.asked} />
        </>
      )}
    </>
  );
}

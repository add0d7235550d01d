import { Fragment } from "react";
import { NoticeText } from "../../design/NoticeText";
import { LivePage } from "../cover/LivePage";
import { AimPanel } from "./AimPanel";
import { AlignmentPanel } from "./AlignmentPanel";
import { CasePanel } from "./CasePanel";
import { HistoryPanel } from "./HistoryPanel";
import { PosesPanel } from "./PosesPanel";
import { RegistrationPanel } from "./RegistrationPanel";
import { useTargeting } from "./useTargeting";
import "./targeting.css";

/** To which case all belongs, where the robot is in the scanner, where it is to go, what that asks of it, and who said so. */
export default function TargetingPage() {
  return (
    <LivePage className="targeting-page">
      <Panels />
    </LivePage>
  );
}

function Panels() {
  const { cases, targeting, view, history, notice, off, refresh } = useTargeting();
  const form = { history: history.value, asked: targeting.asked, off, onSet: refresh };
  return (
    <>
      {notice !== null && (
        <p className="panel-notice targeting-notice" role="alert">
          <NoticeText lead="No newer values:" notice={notice} />
        </p>
      )}
      {cases.value !== null && targeting.value !== null && (
        <>
          <CasePanel
            cases={cases.value}
            now={history.value?.now ?? null}
            asked={cases.asked}
            onChanged={refresh}
          />
          {/* What was edited in one case must not reach another. */}
          <Fragment key={targeting.value.case}>
            <RegistrationPanel targeting={targeting.value} {...form} />
            <AimPanel targeting={targeting.value} {...form} />
            <AlignmentPanel view={view.value} asked={view.asked} />
            <PosesPanel
              view={view.value}
              reported={targeting.value.reported_position}
              history={history.value}
              asked={view.asked}
            />
            <HistoryPanel history={history.value} asked={history.asked} />
          </Fragment>
        </>
      )}
    </>
  );
}

import { Fragment } from "react";
import { api } from "../../api/client";
import { NoticeText } from "../../design/NoticeText";
import { useConsole } from "../../state/store";
import { usePolled } from "../../state/usePolled";
import { LivePage } from "../cover/LivePage";
import { AimPanel } from "./AimPanel";
import { AlignmentPanel } from "./AlignmentPanel";
import { CasePanel } from "./CasePanel";
import { reasonOfCase } from "./case";
import { HistoryPanel } from "./HistoryPanel";
import { PosesPanel } from "./PosesPanel";
import { RegistrationPanel } from "./RegistrationPanel";
import "./targeting.css";

const CASES_EVERY_MS = 1000;
const TARGETING_EVERY_MS = 500;
const ALIGNMENT_EVERY_MS = 250;
const HISTORY_EVERY_MS = 1000;

/** To which case all belongs, where the robot is in the scanner, where it is to go, what that asks of it, and who said so. */
export default function TargetingPage() {
  return (
    <LivePage className="targeting-page">
      <Panels />
    </LivePage>
  );
}

function Panels() {
  const robot = useConsole((state) => state.robot?.name ?? null);
  const cases = usePolled(api.listCases, CASES_EVERY_MS);
  const targeting = usePolled(api.targeting, TARGETING_EVERY_MS);
  const view = usePolled(api.alignment, ALIGNMENT_EVERY_MS);
  const history = usePolled(api.targetingHistory, HISTORY_EVERY_MS);
  const notice = cases.notice ?? targeting.notice ?? view.notice ?? history.notice;
  const refresh = async (): Promise<void> => {
    await Promise.all([cases.refresh(), targeting.refresh(), view.refresh(), history.refresh()]);
  };
  const off = cases.value === null ? null : reasonOfCase(cases.value, robot);
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
            <RegistrationPanel
              targeting={targeting.value}
              history={history.value}
              asked={targeting.asked}
              off={off}
              onSet={refresh}
            />
            <AimPanel
              targeting={targeting.value}
              history={history.value}
              asked={targeting.asked}
              off={off}
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
          </Fragment>
        </>
      )}
    </>
  );
}

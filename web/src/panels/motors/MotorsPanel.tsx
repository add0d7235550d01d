import { Panel } from "../../design/Panel";
import { ReasonLine } from "../../design/ReasonLine";
import { Refusal } from "../../design/Refusal";
import { reasonOfMode } from "../../state/permission";
import { homingPart, openHoming } from "../../state/proposals";
import { useConsole } from "../../state/store";
import { LoadButton } from "../positions/LoadButton";
import { LoadReport } from "../positions/LoadReport";
import { SaveButton } from "../positions/SaveButton";
import { UndoLine } from "../positions/UndoLine";
import { useLoad } from "../positions/useLoad";
import { AxisRow } from "./AxisRow";
import { HomeBar } from "./HomeBar";
import { HomingProgress } from "./HomingProgress";
import "./motors.css";
import { useErrorWatch } from "./useErrorWatch";

/** The robot's axes in the order of its file. */
export function MotorsPanel() {
  const motors = useConsole((state) => state.motors);
  const robot = useConsole((state) => state.robot);
  const homing = useConsole((state) => openHoming(state.proposals));
  const notice = useConsole((state) => state.notices.robot);
  const loading = useLoad();
  useErrorWatch();
  const tools = (
    <>
      <SaveButton />
      <LoadButton onFile={(file) => void loading.take(file)} />
    </>
  );
  return (
    <Panel title="Motors" className="motors-panel" tools={tools}>
      <ReasonLine need="holder" />
      <ModeLine />
      <LoadReport {...loading} />
      <HomeBar />
      <UndoLine />
      {homing !== undefined && <HomingProgress homing={homing} />}
      {notice !== undefined && (
        <Refusal place="robot" notice={notice} dismissLabel="Dismiss the refusal of the robot" />
      )}
      <ul className="axes">
        {motors.map((motor) => (
          <AxisRow key={motor.slot} motor={motor} homing={homingPart(homing, robot, motor)} />
        ))}
      </ul>
      <p className="legend">
        <svg width="16" height="16" viewBox="-8 -8 16 16" aria-hidden="true">
          <path className="legend-measured" d="M0-6 6 0 0 6-6 0z" />
        </svg>
        measured
        <svg width="16" height="16" viewBox="-8 -8 16 16" aria-hidden="true">
          <circle className="legend-setpoint" r="6" />
        </svg>
        setpoint: drag to preview, release to propose, hold the pedal to move
      </p>
    </Panel>
  );
}

/** Says once, for all sliders, which mode drives the setpoints in the operator's place. */
function ModeLine() {
  const reason = useConsole((state) => reasonOfMode(state.mode?.mode ?? null));
  if (reason === null) return null;
  return (
    <p className="reason-line" role="status">
      Sliders, entries and jogging are locked. {reason}
    </p>
  );
}

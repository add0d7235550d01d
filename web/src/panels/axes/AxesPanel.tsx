import { Panel } from "../../design/Panel";
import { useConsole } from "../../state/store";
import { AxisRow } from "./AxisRow";
import "./axes.css";

/** The robot's axes in the order of its file. */
export function AxesPanel() {
  const motors = useConsole((state) => state.motors);
  return (
    <Panel title="Axes" className="axes-panel">
      <ul className="axes">
        {motors.map((motor) => (
          <AxisRow key={motor.slot} motor={motor} />
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

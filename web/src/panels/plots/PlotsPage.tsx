import { useState } from "react";
import type { Motor } from "../../api/client";
import { useConsole } from "../../state/store";
import { LivePage } from "../cover/LivePage";
import { AxisPlots } from "./AxisPlots";
import { CapturePanel } from "./CapturePanel";
import { LoopTimePanel } from "./LoopTimePanel";
import "./plots.css";
import { useHistory } from "./useHistory";

/** What has been: the axes over time, single ticks around an event, and how long the kernel's loop takes. */
export default function PlotsPage() {
  const motors = useConsole((state) => state.motors);
  const history = useHistory();
  const [slot, setSlot] = useState<number | null>(null);
  const motor = motors.find((each) => each.slot === slot) ?? motors[0];
  return (
    <LivePage className="plots-page">
      {motor !== undefined && (
        <>
          <div className="main-column">
            <AxisPlots
              key={motor.slot}
              motor={motor}
              history={history}
              chooser={<AxisChooser motors={motors} chosen={motor} onChoose={setSlot} />}
            />
          </div>
          <div className="side">
            <CapturePanel key={motor.slot} motor={motor} rows={history.rows} />
            <LoopTimePanel periodUs={history.rows?.periodUs} />
          </div>
        </>
      )}
    </LivePage>
  );
}

interface AxisChooserProps {
  readonly motors: readonly Motor[];
  readonly chosen: Motor;
  readonly onChoose: (slot: number) => void;
}

function AxisChooser({ motors, chosen, onChoose }: AxisChooserProps) {
  return (
    <label>
      Axis{" "}
      <select value={chosen.slot} onChange={({ target }) => onChoose(Number(target.value))}>
        {motors.map(({ slot, title }) => (
          <option key={slot} value={slot}>
            {title}
          </option>
        ))}
      </select>
    </label>
  );
}

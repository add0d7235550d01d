import { useState } from "react";
import type { Motor } from "../../api/client";
import { CodeLink } from "../../design/CodeLink";
import { Panel } from "../../design/Panel";
import { useConsole } from "../../state/store";
import type { AxisFrame, Frame } from "../../stream/decode";
import { GateList } from "../motors/GateList";
import { gateLines } from "../motors/gates";
import { askedSlot } from "./askedSlot";
import "./why.css";

/** Why an axis does not move: the gate that blocks, the next step, and every other gate that is closed. */
export function WhyPanel() {
  const motors = useConsole((state) => state.motors);
  const proposals = useConsole((state) => state.proposals);
  const frame = useConsole((state) => state.frame);
  const [chosen, setChosen] = useState<number | null>(null);
  const motor = motors.find(({ slot }) => slot === askedSlot(chosen, proposals, motors));
  const axis = motor === undefined ? undefined : frame?.axes[motor.slot];
  const tools = (
    <label className="why-axis">
      Axis{" "}
      <select
        value={chosen ?? ""}
        onChange={({ target }) => setChosen(target.value === "" ? null : Number(target.value))}
      >
        <option value="">
          {motor === undefined || chosen !== null ? "of the newest proposal" : `newest: ${motor.title}`}
        </option>
        {motors.map(({ slot, title }) => (
          <option key={slot} value={slot}>
            {title}
          </option>
        ))}
      </select>
    </label>
  );
  return (
    <Panel title="Why not moving?" className="why-panel" tools={tools}>
      {motor !== undefined && axis !== undefined && frame !== null && (
        <>
          <Answer frame={frame} motor={motor} axis={axis} />
          <GateList motor={motor} axis={axis} />
        </>
      )}
    </Panel>
  );
}

interface AnswerProps {
  readonly frame: Frame;
  readonly motor: Motor;
  readonly axis: AxisFrame;
}

function Answer({ frame, motor, axis }: AnswerProps) {
  const blocking = gateLines(frame, axis, null).find(({ stand }) => stand === "blocks");
  if (blocking === undefined) {
    return (
      <p className="why-answer" data-driven="true">
        <strong>▶ {motor.title} is driven.</strong> Every gate is open.
      </p>
    );
  }
  return (
    <p className="why-answer" data-driven="false">
      <strong>
        ■ {motor.title}: <CodeLink family="gate" code={blocking.name} />
      </strong>{" "}
      {blocking.meaning} <span className="next-step">{blocking.next_step}</span>
    </p>
  );
}

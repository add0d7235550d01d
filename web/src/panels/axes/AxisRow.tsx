import { useState } from "react";
import type { AxisAction, Motor } from "../../api/client";
import { NoticeText } from "../../design/NoticeText";
import { entry } from "../../generated/catalog";
import { act, dismissNotice } from "../../state/commands";
import type { Notice } from "../../state/notice";
import { useConsole } from "../../state/store";
import type { AxisFrame } from "../../stream/decode";
import { formatCounts } from "../../units/units";
import { explainDrive, explainFault, type FaultStory } from "./explain";
import { TargetEntry } from "./TargetEntry";
import { Track } from "./Track";

/** One axis: what it is, where it stands, what it may do, and why it does not move. */
export function AxisRow({ motor }: { readonly motor: Motor }) {
  const axis = useConsole((state) => state.frame?.axes[motor.slot]);
  const notice = useConsole((state) => state.notices[motor.slot]);
  if (axis === undefined) return null;
  const fault = explainFault(axis);
  return (
    <li className="axis-row" data-state={axis.state} aria-label={`Axis ${motor.title}`}>
      <Identity motor={motor} axis={axis} />
      <div className="track-area">
        <SwitchLamp motor={motor} axis={axis} side="LOWER" />
        <Track motor={motor} axis={axis} />
        <SwitchLamp motor={motor} axis={axis} side="UPPER" />
      </div>
      <output
        className="measured-value"
        aria-live="off"
        aria-label={`${motor.title} position`}
        title={`${axis.positionCounts} counts`}
      >
        {formatCounts(motor, axis.positionCounts)}
        <small>{axis.positionCounts} counts</small>
      </output>
      <TargetEntry motor={motor} />
      <Actions motor={motor} axis={axis} />
      <div className="axis-words">
        {fault === null ? (
          <DriveWords motor={motor} axis={axis} />
        ) : (
          <FaultWords motor={motor} fault={fault} />
        )}
        {notice !== undefined && <Refusal motor={motor} notice={notice} />}
      </div>
    </li>
  );
}

const stateTone: Record<string, string> = {
  ENABLED: "calm",
  MOVING: "wish",
  HOMING: "wish",
  FAULTED: "medium",
};
const stateShape: Record<string, string> = {
  DISABLED: "○",
  ENABLED: "●",
  MOVING: "▶",
  HOMING: "⌂",
  FAULTED: "▲",
};

interface AxisProps {
  readonly motor: Motor;
  readonly axis: AxisFrame;
}

function Identity({ motor, axis }: AxisProps) {
  return (
    <div className="identity">
      <h3>
        {motor.title} <small className="slot">slot {motor.slot}</small>
      </h3>
      <span className={`chip ${stateTone[axis.state] ?? ""}`} title={entry("axis_state", axis.state).meaning}>
        <i aria-hidden="true">{stateShape[axis.state] ?? "?"}</i>
        <span>{axis.state}</span>
      </span>
      {!axis.homed && (
        <span
          className="chip unhomed"
          title="No reference: slow and short moves only. Home the axis for its full range."
        >
          UNHOMED
        </span>
      )}
      {!axis.cardValid && (
        <span className="chip medium" title={entry("gate", "CARD").meaning}>
          NO CARD
        </span>
      )}
    </div>
  );
}

function SwitchLamp({ motor, axis, side }: AxisProps & { readonly side: "LOWER" | "UPPER" }) {
  if (motor.limit_side !== side) return <span className="switch-lamp absent" />;
  const triggered = axis.switchTriggered;
  const end = side === "LOWER" ? "lower" : "upper";
  return (
    <span
      className={`switch-lamp ${triggered ? "triggered" : "open"}`}
      role="img"
      aria-label={`${end} switch ${triggered ? "triggered" : "open"}`}
      title={`Limit switch at the ${end} end: ${triggered ? "triggered" : "open"}`}
    >
      <i />
      {triggered ? "at switch" : "switch"}
    </span>
  );
}

function Actions({ motor, axis }: AxisProps) {
  const disabled = axis.state === "DISABLED";
  const faulted = axis.state === "FAULTED";
  return (
    <div className="axis-actions">
      <ActionButton motor={motor} action="enable" label="Enable" off={!disabled} />
      <ActionButton motor={motor} action="disable" label="Disable" off={disabled || faulted} />
      <ActionButton motor={motor} action="home" label="Home" off={motor.limit_side === "NONE"} />
      <ActionButton motor={motor} action="set-home" label="Set Home" off={false} />
    </div>
  );
}

interface ActionButtonProps {
  readonly motor: Motor;
  readonly action: AxisAction;
  readonly label: string;
  readonly off: boolean;
}

/** Waits for its answer before it can be pressed again, so that a double click asks once. */
function ActionButton({ motor, action, label, off }: ActionButtonProps) {
  const [waiting, setWaiting] = useState(false);
  const onClick = async (): Promise<void> => {
    setWaiting(true);
    await act(motor.slot, action);
    setWaiting(false);
  };
  return (
    <button
      type="button"
      className="button"
      disabled={off || waiting}
      aria-label={`${label} ${motor.title}`}
      onClick={() => void onClick()}
    >
      {label}
    </button>
  );
}

function DriveWords({ motor, axis }: AxisProps) {
  const story = explainDrive(motor, axis);
  return (
    <p className="drive-words" title={`${story.text} ${story.nextStep}`}>
      {!story.driven && (
        <>
          Not driven: <strong>{story.gate}</strong> ·{" "}
        </>
      )}
      {story.text} {story.nextStep !== "" && <span className="next-step">{story.nextStep}</span>}
    </p>
  );
}

function FaultWords({ motor, fault }: { readonly motor: Motor; readonly fault: FaultStory }) {
  return (
    <div className="fault-words" role="alert">
      <p title={fault.evidence}>
        <strong>▲ {fault.name}</strong> {fault.meaning} <em>Likely: {fault.cause}</em>{" "}
        <span className="next-step">{fault.nextStep}</span>
      </p>
      <ActionButton motor={motor} action="clear-fault" label="Clear" off={false} />
    </div>
  );
}

function Refusal({ motor, notice }: { readonly motor: Motor; readonly notice: Notice }) {
  return (
    <div className="refusal" role="alert">
      <NoticeText lead="Refused:" notice={notice} />
      <button
        type="button"
        className="button quiet"
        aria-label={`Dismiss the refusal of ${motor.title}`}
        onClick={() => dismissNotice(motor.slot)}
      >
        ✕
      </button>
    </div>
  );
}

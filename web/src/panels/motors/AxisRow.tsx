import { useCallback, useState } from "react";
import type { Motor } from "../../api/client";
import { AlarmSign } from "../../design/AlarmSign";
import { CodeLink } from "../../design/CodeLink";
import { Refusal } from "../../design/Refusal";
import { entry } from "../../generated/catalog";
import { KernelButton } from "../../kernel/KernelButton";
import { WishForetelling } from "../../kernel/WishForetelling";
import { act } from "../../state/commands";
import type { HomingPart } from "../../state/proposals";
import { useConsole } from "../../state/store";
import type { AxisFrame } from "../../stream/decode";
import { formatCounts } from "../../units/units";
import { AxisActions } from "./AxisActions";
import { ErrorLine } from "./ErrorLine";
import { explainDrive, explainFault, type FaultStory } from "./explain";
import { GateList } from "./GateList";
import { JogPad } from "./JogPad";
import { SetHomeQuestion } from "./SetHomeQuestion";
import { SwitchLamp } from "./SwitchLamp";
import { TargetEntry } from "./TargetEntry";
import { Track } from "./Track";
import { usePreview } from "./usePreview";

interface AxisRowProps {
  readonly motor: Motor;
  readonly homing: HomingPart | null;
}

/** One axis: what it is, where it stands, what it may do, and why it does not move. */
export function AxisRow({ motor, homing }: AxisRowProps) {
  const axis = useConsole((state) => state.frame?.axes[motor.slot]);
  const notice = useConsole((state) => state.notices[motor.slot]);
  const [asksHome, setAsksHome] = useState(false);
  const [preview, setPreview] = usePreview();
  const [typed, setTyped] = useState<number | null>(null);
  const leaveHome = useCallback(() => setAsksHome(false), []);
  if (axis === undefined) return null;
  const fault = explainFault(axis);
  const wished = preview?.counts ?? typed;
  return (
    <li
      className="axis-row"
      data-state={axis.state}
      data-homed={axis.homed}
      aria-label={`Axis ${motor.title}`}
    >
      <Identity motor={motor} axis={axis} />
      <div className="track-area">
        <SwitchLamp motor={motor} axis={axis} side="LOWER" />
        <Track motor={motor} axis={axis} preview={preview} onPreview={setPreview} />
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
        <small title="Farthest travel from the last reading that allowed drive until rest">
          stops ≤ {formatCounts(motor, motor.coast_counts)}
        </small>
      </output>
      <TargetEntry motor={motor} onTyped={setTyped} />
      <AxisActions motor={motor} axis={axis} homing={homing} onAskHome={() => setAsksHome(true)} />
      <div className="axis-words">
        {asksHome && <SetHomeQuestion motor={motor} onClose={leaveHome} />}
        {wished !== null && (
          <WishForetelling wishes={[{ motor, wish: { kind: "MOVE", targetCounts: wished } }]} />
        )}
        {fault === null ? (
          <DriveWords motor={motor} axis={axis} />
        ) : (
          <FaultWords motor={motor} fault={fault} />
        )}
        <ErrorLine motor={motor} />
        {notice !== undefined && (
          <Refusal
            place={motor.slot}
            notice={notice}
            dismissLabel={`Dismiss the refusal of ${motor.title}`}
          />
        )}
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
      {axis.homed ? (
        <small className="homed-by" title={homedHelp(axis)}>
          {homedWords(motor, axis)}
        </small>
      ) : (
        <span
          className="chip unhomed"
          title={`No reference: what is shown is no place. Slow, and at most ${travelLeft(motor, axis)} farther until the pedal is pressed anew or the axis is homed.`}
        >
          <i aria-hidden="true">◌</i> UNHOMED · ≤ {travelLeft(motor, axis)}
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

/** What this press of the pedal, or the next one, leaves an axis that is not homed. */
function travelLeft(motor: Motor, axis: AxisFrame): string {
  return formatCounts(motor, axis.maxCounts - axis.positionCounts);
}

function homedWords(motor: Motor, axis: AxisFrame): string {
  if (axis.homedByHand) return "homed by hand";
  const moved = axis.homeDifferenceCounts;
  return moved === 0 ? "homed at switch" : `homed at switch, Δ ${formatCounts(motor, moved)}`;
}

function homedHelp(axis: AxisFrame): string {
  return axis.homedByHand
    ? "By Set Home, a person's word: no switch is compared with the position."
    : `At the slow approach to its switch, ${axis.homeDifferenceCounts} counts from the home before. The kernel compares switch and position.`;
}

function DriveWords({ motor, axis }: AxisProps) {
  const [asked, setAsked] = useState(false);
  const frame = useConsole((state) => state.frame);
  if (frame === null) return null;
  const story = explainDrive(frame, motor, axis);
  return (
    <>
      <div className="drive-line">
        <p className="drive-words" title={`${story.text} ${story.nextStep}`}>
          {!story.driven && (
            <>
              Not driven:{" "}
              <strong>
                <CodeLink family="gate" code={story.gate} />
              </strong>{" "}
              ·{" "}
            </>
          )}
          {story.text} {story.nextStep !== "" && <span className="next-step">{story.nextStep}</span>}
        </p>
        {axis.state !== "DISABLED" && <JogPad motor={motor} axis={axis} />}
        <button
          type="button"
          className="button quiet why"
          aria-expanded={asked}
          aria-label={`${asked ? "Close" : "Why not moving?"} ${motor.title}`}
          onClick={() => setAsked(!asked)}
        >
          {asked ? "Close" : "Why not moving?"}
        </button>
      </div>
      {asked && <GateList motor={motor} axis={axis} />}
    </>
  );
}

function FaultWords({ motor, fault }: { readonly motor: Motor; readonly fault: FaultStory }) {
  return (
    <div className="fault-words" role="alert">
      <p title={fault.evidence}>
        <strong>
          <AlarmSign priority="medium">▲</AlarmSign> <CodeLink family="fault" code={fault.name} />
        </strong>{" "}
        {fault.meaning} <em>Likely: {fault.cause}</em> <span className="next-step">{fault.nextStep}</span>
      </p>
      <KernelButton
        request="CLEAR_FAULT"
        slot={motor.slot}
        need="holder"
        label={`Clear ${motor.title}`}
        onCommand={() => act(motor.slot, "clear-fault")}
      >
        Clear
      </KernelButton>
    </div>
  );
}

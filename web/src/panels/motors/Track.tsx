import { type KeyboardEvent, type PointerEvent, useRef } from "react";
import type { Motor } from "../../api/client";
import { propose } from "../../state/commands";
import { useReason } from "../../state/useReason";
import type { AxisFrame } from "../../stream/decode";
import { formatCounts } from "../../units/units";
import { countsAt, fractionOf, isAllowed, previewAfterKey, trackDomain } from "./geometry";
import { TrackDrawing } from "./TrackDrawing";
import type { Preview } from "./usePreview";

/** Only a grip on the circle starts a drag: a click elsewhere on the track proposes nothing. */
const GRIP_PX = 16;

interface TrackProps {
  readonly motor: Motor;
  readonly axis: AxisFrame;
  readonly preview: Preview | null;
  readonly onPreview: (preview: Preview | null) => void;
}

interface Grip {
  readonly startCounts: number;
  /** From the pointer to the circle's centre, kept while dragging. */
  readonly offsetPx: number;
}

/**
 * Measured position (diamond), setpoint (circle) and range of an axis. Dragging the circle, or arrow keys,
 * preview; releasing the drag, or Enter, proposes. The kernel judges the proposal: the track refuses nothing.
 */
export function Track({ motor, axis, preview, onPreview: setPreview }: TrackProps) {
  const reason = useReason("setpoint");
  const grip = useRef<Grip | null>(null);
  const domain = trackDomain(motor, axis);
  const wishCounts = axis.setpointCounts ?? axis.positionCounts;
  const shownCounts = preview?.counts ?? wishCounts;

  const send = async (counts: number): Promise<void> => {
    setPreview({ counts, sent: true });
    await propose({ kind: "move", slot: motor.slot, target_counts: counts });
    setPreview(null);
  };

  const onPointerDown = (event: PointerEvent<HTMLDivElement>): void => {
    const box = event.currentTarget.getBoundingClientRect();
    const offsetPx = fractionOf(domain, shownCounts) * box.width - (event.clientX - box.left);
    if (reason !== null || event.button !== 0 || Math.abs(offsetPx) > GRIP_PX) return;
    event.currentTarget.setPointerCapture(event.pointerId);
    grip.current = { startCounts: shownCounts, offsetPx };
    setPreview({ counts: shownCounts, sent: false });
  };

  const onPointerMove = (event: PointerEvent<HTMLDivElement>): void => {
    if (grip.current === null || preview === null) return;
    const box = event.currentTarget.getBoundingClientRect();
    const fraction = (event.clientX - box.left + grip.current.offsetPx) / box.width;
    setPreview({ counts: countsAt(domain, fraction), sent: false });
  };

  const onPointerUp = (): void => {
    const held = grip.current;
    grip.current = null;
    if (held === null || preview === null) return;
    if (preview.counts === held.startCounts) setPreview(null);
    else void send(preview.counts);
  };

  const cancel = (): void => {
    grip.current = null;
    if (preview?.sent === false) setPreview(null);
  };

  const onKeyDown = (event: KeyboardEvent<HTMLDivElement>): void => {
    if (reason !== null || event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.key === "Enter" && preview?.sent === false) {
      void send(preview.counts);
      return;
    }
    const next = previewAfterKey(motor, axis, shownCounts, event.key);
    if (next === null) return;
    event.preventDefault();
    setPreview({ counts: next, sent: false });
  };

  const allowed = preview === null || isAllowed(axis, preview.counts);
  return (
    // Not a range input: that would move on a click anywhere and take arrow keys for the final word.
    <div
      role="slider"
      tabIndex={0}
      className="track"
      data-preview={preview !== null}
      aria-disabled={reason !== null}
      title={reason ?? undefined}
      aria-label={`${motor.title} target`}
      aria-valuemin={Math.ceil(domain.min)}
      aria-valuemax={Math.floor(domain.max)}
      aria-valuenow={shownCounts}
      aria-valuetext={describeValue(motor, axis, preview?.counts ?? null, allowed)}
      onPointerDown={onPointerDown}
      onPointerMove={onPointerMove}
      onPointerUp={onPointerUp}
      onPointerCancel={cancel}
      onKeyDown={onKeyDown}
      onBlur={cancel}
    >
      <TrackDrawing motor={motor} axis={axis} domain={domain} previewCounts={preview?.counts ?? null} />
    </div>
  );
}

function describeValue(
  motor: Motor,
  axis: AxisFrame,
  previewCounts: number | null,
  allowed: boolean,
): string {
  const measured = `measured ${formatCounts(motor, axis.positionCounts)}`;
  if (previewCounts === null) {
    return axis.setpointCounts === null
      ? measured
      : `setpoint ${formatCounts(motor, axis.setpointCounts)}, ${measured}`;
  }
  const range = allowed ? "" : ", outside the allowed range";
  return `preview ${formatCounts(motor, previewCounts)}${range}; Enter proposes, ${measured}`;
}

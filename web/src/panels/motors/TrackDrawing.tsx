import { useId } from "react";
import type { Motor } from "../../api/client";
import type { AxisFrame } from "../../stream/decode";
import { formatCounts } from "../../units/units";
import { type Domain, fractionOf, isAllowed, stoppingRange } from "./geometry";

interface TrackDrawingProps {
  readonly motor: Motor;
  readonly axis: AxisFrame;
  readonly domain: Domain;
  readonly previewCounts: number | null;
}

const RAIL_Y = 22;

/** Places along the track are percentages, so that the drawing follows any width. */
export function TrackDrawing({ motor, axis, domain, previewCounts }: TrackDrawingProps) {
  const hatchId = useId();
  const at = (counts: number): string => `${(100 * fractionOf(domain, counts)).toFixed(3)}%`;
  const span = (from: number, to: number): string =>
    `${(100 * (fractionOf(domain, to) - fractionOf(domain, from))).toFixed(3)}%`;
  const soft = { min: motor.soft_min_counts, max: motor.soft_max_counts };
  const outside = previewCounts !== null && !isAllowed(axis, previewCounts);

  return (
    <svg className="track-drawing" width="100%" height="46" aria-hidden="true">
      <pattern id={hatchId} width="6" height="6" patternUnits="userSpaceOnUse" patternTransform="rotate(-45)">
        <rect className="hatch" width="2.5" height="6" />
      </pattern>

      <line className="rail" x1="0" x2="100%" y1={RAIL_Y} y2={RAIL_Y} />
      <rect
        className={axis.homed ? "soft-range" : "soft-range-unhomed"}
        x={at(soft.min)}
        width={span(soft.min, soft.max)}
        y={RAIL_Y - 5}
        height="10"
        fill={`url(#${hatchId})`}
      />
      {axis.maxCounts > axis.minCounts && (
        <rect
          className="allowed-range"
          x={at(axis.minCounts)}
          width={span(axis.minCounts, axis.maxCounts)}
          y={RAIL_Y - 3}
          height="6"
          rx="3"
        />
      )}
      <SoftLimit end="start" x={at(soft.min)} label={axis.homed ? formatCounts(motor, soft.min) : null} />
      <SoftLimit end="end" x={at(soft.max)} label={axis.homed ? formatCounts(motor, soft.max) : null} />

      {axis.setpointCounts !== null && (
        <line
          className="to-setpoint"
          x1={at(axis.positionCounts)}
          x2={at(axis.setpointCounts)}
          y1={RAIL_Y}
          y2={RAIL_Y}
        />
      )}
      {previewCounts !== null && (
        <line
          className="to-preview"
          x1={at(axis.positionCounts)}
          x2={at(previewCounts)}
          y1={RAIL_Y}
          y2={RAIL_Y}
        />
      )}
      <StoppingGhost motor={motor} axis={axis} at={at} span={span} />
      <svg aria-hidden="true" className="measured" x={at(axis.positionCounts)} y={RAIL_Y} overflow="visible">
        <path d="M0-7.5 7.5 0 0 7.5-7.5 0z" />
      </svg>
      <circle
        className={axis.setpointCounts === null ? "setpoint idle" : "setpoint"}
        cx={at(axis.setpointCounts ?? axis.positionCounts)}
        cy={RAIL_Y}
        r="9"
      />
      {previewCounts !== null && (
        <g className={outside ? "preview outside" : "preview"}>
          <circle cx={at(previewCounts)} cy={RAIL_Y} r="9" />
          <text x={at(previewCounts)} y="10" textAnchor={anchor(fractionOf(domain, previewCounts))}>
            {formatCounts(motor, previewCounts)}
            {outside ? " outside the allowed range" : ""}
          </text>
        </g>
      )}
    </svg>
  );
}

interface StoppingGhostProps {
  readonly motor: Motor;
  readonly axis: AxisFrame;
  readonly at: (counts: number) => string;
  readonly span: (from: number, to: number) => string;
}

/** Where a driven axis comes to rest at the latest when its drive is taken away now. */
function StoppingGhost({ motor, axis, at, span }: StoppingGhostProps) {
  const ghost = stoppingRange(motor, axis);
  if (ghost === null) return null;
  return (
    <rect
      className="stopping"
      x={at(ghost.min)}
      width={span(ghost.min, ghost.max)}
      y={RAIL_Y - 6}
      height="12"
    />
  );
}

interface SoftLimitProps {
  readonly x: string;
  /** Null while the axis is not homed: then nobody knows where the limit is. */
  readonly label: string | null;
  readonly end: "start" | "end";
}

function SoftLimit({ x, label, end }: SoftLimitProps) {
  return (
    <g className="soft-limit">
      {label !== null && <line x1={x} x2={x} y1={RAIL_Y - 8} y2={RAIL_Y + 8} />}
      <text x={x} y="43" textAnchor={end}>
        {label ?? "unknown"}
      </text>
    </g>
  );
}

function anchor(fraction: number): "start" | "middle" | "end" {
  if (fraction < 0.2) return "start";
  return fraction > 0.8 ? "end" : "middle";
}

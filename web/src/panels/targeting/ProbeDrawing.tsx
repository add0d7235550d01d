/** Where the four offsets of the probe are measured; not to scale. */
import { type OffsetName, offsetTitles } from "./aim";

interface ProbeDrawingProps {
  /** As they are written, in mm. */
  readonly textOf: (name: OffsetName) => string;
}

/** Places along the probe in the drawing's own units. */
const ROBOT = 66;
const ENTRY = 148;
const CANNULA = 236;
const TREATMENT = 304;
const TIP = 376;
const AXIS = 66;
const ABOVE = 26;
const BELOW = 116;

const spans: readonly {
  readonly name: OffsetName;
  readonly from: number;
  readonly to: number;
  readonly at: number;
}[] = [
  { name: "robot_to_entry_offset", from: ROBOT, to: ENTRY, at: ABOVE },
  { name: "cannula_to_treatment_offset", from: CANNULA, to: TREATMENT, at: ABOVE },
  { name: "treatment_to_tip_offset", from: TREATMENT, to: TIP, at: ABOVE },
  { name: "treatment_to_robot_at_home", from: ROBOT, to: TREATMENT, at: BELOW },
];

export function ProbeDrawing({ textOf }: ProbeDrawingProps) {
  const words = spans.map(({ name }) => {
    const { letter, way } = offsetTitles[name];
    return `${letter}, ${way}: ${textOf(name)} mm`;
  });
  return (
    <svg
      className="probe-drawing"
      viewBox="0 0 392 124"
      role="img"
      aria-label={`The probe at home, not to scale. From the robot: entry, end of the cannula, treatment point, tip. ${words.join("; ")}.`}
    >
      <g>
        <rect className="tissue" x={ENTRY} y={AXIS - 30} width={392 - ENTRY} height={60} />
        <line className="skin" x1={ENTRY} y1={AXIS - 30} x2={ENTRY} y2={AXIS + 30} />
        {[ROBOT, CANNULA, TREATMENT, TIP].map((x) => (
          <line
            key={x}
            className="guide"
            x1={x}
            x2={x}
            y1={ABOVE}
            y2={x === ROBOT || x === TREATMENT ? BELOW : AXIS}
          />
        ))}
        <line className="guide" x1={ENTRY} x2={ENTRY} y1={ABOVE} y2={AXIS - 30} />
        <rect className="robot" x={4} y={AXIS - 20} width={ROBOT - 4} height={40} rx={3} />
        <text x={ROBOT / 2 + 2} y={AXIS + 4}>
          robot
        </text>
        <rect className="cannula" x={ROBOT} y={AXIS - 6} width={CANNULA - ROBOT} height={12} />
        <path
          className="probe"
          d={`M${ROBOT} ${AXIS - 2.5}H${TIP - 8}L${TIP} ${AXIS}L${TIP - 8} ${AXIS + 2.5}H${ROBOT}Z`}
        />
        <circle className="treatment" cx={TREATMENT} cy={AXIS} r={6} />
        <text x={ENTRY + 4} y={AXIS + 26} className="begins">
          entry
        </text>
        <text x={CANNULA - 30} y={AXIS + 20}>
          cannula
        </text>
        <text x={TREATMENT + 4} y={AXIS + 20} className="begins">
          treatment
        </text>
        <text x={TIP + 6} y={AXIS + 20} className="ends">
          tip
        </text>
        {spans.map((span) => (
          <Span key={span.name} {...span} text={textOf(span.name)} />
        ))}
      </g>
    </svg>
  );
}

function Span({ name, from, to, at, text }: (typeof spans)[number] & { readonly text: string }) {
  return (
    <g className="span">
      <path
        d={`M${from} ${at}H${to}M${from + 5} ${at - 3}L${from} ${at}L${from + 5} ${at + 3}M${to - 5} ${at - 3}L${to} ${at}L${to - 5} ${at + 3}`}
      />
      <text x={(from + to) / 2} y={at - 5}>
        <tspan className="letter">{offsetTitles[name].letter}</tspan> {text === "" ? "–" : text} mm
      </text>
    </g>
  );
}

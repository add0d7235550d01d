import { Panel } from "../../design/Panel";
import { useConsole } from "../../state/store";
import {
  blamed,
  bucketEndUs,
  figuresOf,
  filledRange,
  formatUs,
  phaseMeaning,
  phases,
  type Timing,
} from "./loopTime";

const STATUS_EVERY_MS = 1000;
const US_PER_MS = 1000;

/** How long each phase of the kernel's tick took since its start, and which one took most. */
export function LoopTimePanel({ periodUs }: { readonly periodUs: number | undefined }) {
  const answeredAtMs = useConsole((state) => state.statusAtMs);
  const timing = useConsole((state) => state.status?.timing);
  const overruns = useConsole((state) => state.frame?.overruns ?? 0);
  const simulatedClock = useConsole((state) => state.frame?.simulatedClock ?? false);
  if (timing === undefined || periodUs === undefined) return null;
  const figures = figuresOf(timing, periodUs);
  const worst = blamed(figures);
  return (
    <Panel title="Loop time" className="loop-panel" asked={{ answeredAtMs, everyMs: STATUS_EVERY_MS }}>
      <p className="loop-words">
        {worst === null ? (
          "No tick was measured yet."
        ) : (
          <>
            Longest since the kernel's start: <strong>{worst.phase}</strong>, {formatUs(worst.maxUs)} of a
            period of {formatUs(periodUs)}. {overruns === 0 ? "No overrun." : `${overruns} overruns.`}
          </>
        )}
        {simulatedClock && ` The clock is simulated: no deadline, so no wake time.`}
      </p>
      <table className="table" aria-label="Loop time by phase">
        <thead>
          <tr>
            <th scope="col">Phase</th>
            <th scope="col" className="number" title="Upper end of the bucket">
              Half ≤
            </th>
            <th scope="col" className="number" title="Upper end of the bucket">
              99.9 % ≤
            </th>
            <th scope="col" className="number">
              Longest
            </th>
          </tr>
        </thead>
        <tbody>
          {figures.map((figure) => (
            <tr key={figure.phase} data-worst={figure === worst}>
              <th scope="row" title={phaseMeaning[figure.phase]}>
                {figure === worst && <span aria-hidden="true">▲ </span>}
                {figure.phase}
              </th>
              <td className="number">{formatUs(figure.medianUs)}</td>
              <td className="number">{formatUs(figure.p999Us)}</td>
              <td className={`number ${figure.ofPeriod > 1 ? "warn" : ""}`}>
                {figure.ticks === 0 ? "–" : formatUs(figure.maxUs)}
              </td>
            </tr>
          ))}
        </tbody>
      </table>
      <Histogram timing={timing} />
    </Panel>
  );
}

const BAR_PX = 14;
const ROW_PX = 26;

/** A row a phase, a column a bucket; the height is the logarithm of the ticks, so that one in a million shows. */
function Histogram({ timing }: { readonly timing: Timing }) {
  const range = filledRange(timing);
  if (range === null) return null;
  const buckets = Array.from({ length: range.last - range.first + 1 }, (_, index) => range.first + index);
  const width = buckets.length * BAR_PX;
  const most = Math.max(...phases.flatMap((phase) => timing[phase].buckets));
  const heightOf = (count: number): number =>
    count === 0 ? 0 : 2 + (ROW_PX - 5) * (Math.log10(count + 1) / Math.log10(most + 1));
  return (
    <figure className="histogram">
      <svg
        viewBox={`-48 0 ${width + 52} ${phases.length * ROW_PX + 14}`}
        role="img"
        aria-label={histogramWords(range)}
      >
        {phases.map((phase, row) => (
          <g key={phase} transform={`translate(0 ${row * ROW_PX})`}>
            <text className="histogram-label" x="-4" y={ROW_PX - 3} textAnchor="end">
              {phase}
            </text>
            <line className="histogram-ground" x1="0" x2={width} y1={ROW_PX - 1} y2={ROW_PX - 1} />
            {buckets.map((bucket, column) => {
              const count = timing[phase].buckets[bucket] ?? 0;
              const height = heightOf(count);
              return (
                <rect
                  key={bucket}
                  className="histogram-bar"
                  x={column * BAR_PX + 1}
                  width={BAR_PX - 2}
                  y={ROW_PX - 1 - height}
                  height={height}
                >
                  <title>{`${phase}: ${count} ticks up to ${formatUs(bucketEndUs(bucket))}`}</title>
                </rect>
              );
            })}
          </g>
        ))}
        <text className="histogram-label" x="0" y={phases.length * ROW_PX + 11}>
          {formatUs(bucketEndUs(range.first - 1))}
        </text>
        <text className="histogram-label" x={width} y={phases.length * ROW_PX + 11} textAnchor="end">
          {formatUs(bucketEndUs(range.last))}
        </text>
      </svg>
      <figcaption>Ticks by time, both by powers</figcaption>
    </figure>
  );
}

function histogramWords({ first, last }: { readonly first: number; readonly last: number }): string {
  const longest = bucketEndUs(last);
  const shown = longest > US_PER_MS ? `${(longest / US_PER_MS).toFixed(1)} ms` : formatUs(longest);
  return `Histogram of each phase, from ${formatUs(bucketEndUs(first - 1))} to ${shown}`;
}

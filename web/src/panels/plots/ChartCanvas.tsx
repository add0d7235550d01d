import { type KeyboardEvent, useEffect, useRef, useState } from "react";
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import type { Chart, Line } from "./charts";

export interface Span {
  readonly fromS: number;
  readonly toS: number;
}

interface ChartCanvasProps {
  readonly chart: Chart;
  readonly timeS: number[];
  /** The times that are shown. */
  readonly span: Span;
  /** The charts of one sheet share their cursor. */
  readonly sheet: string;
  /** Only the lowest chart says what the times are. */
  readonly lowest: boolean;
  readonly height: number;
  readonly onZoom: (span: Span) => void;
  readonly onReset: () => void;
}

/** A chart on a canvas, the values at its cursor beside its title. Drag, or + and -, zoom; the arrows move the cursor. */
export function ChartCanvas(props: ChartCanvasProps) {
  const { chart, timeS, span, sheet, lowest, height, onZoom, onReset } = props;
  const host = useRef<HTMLDivElement>(null);
  const plot = useRef<uPlot | null>(null);
  const [cursor, setCursor] = useState<number | null>(null);
  const calls = useRef({ onZoom, onReset });
  calls.current = { onZoom, onReset };
  const shape = [chart.title, chart.unit, ...chart.lines.map(({ label }) => label)].join("|");
  const newest = useRef({ chart, timeS, span });
  newest.current = { chart, timeS, span };

  // biome-ignore lint/correctness/useExhaustiveDependencies: data come by the effect below; `shape` tells when the chart is another one.
  useEffect(() => {
    const element = host.current;
    if (element === null) return;
    const made = new uPlot(
      optionsOf(newest.current.chart, element, sheet, lowest, height, {
        onCursor: setCursor,
        onZoom: (zoomed) => calls.current.onZoom(zoomed),
        onReset: () => calls.current.onReset(),
      }),
      dataOf(newest.current.chart, newest.current.timeS),
      element,
    );
    plot.current = made;
    const watch = new ResizeObserver(() => made.setSize({ width: element.clientWidth, height }));
    watch.observe(element);
    const repaint = (): void => made.redraw(false);
    const theme = new MutationObserver(repaint);
    theme.observe(document.documentElement, { attributeFilter: ["data-theme"] });
    const system = matchMedia("(prefers-color-scheme: dark)");
    system.addEventListener("change", repaint);
    return () => {
      watch.disconnect();
      theme.disconnect();
      system.removeEventListener("change", repaint);
      made.destroy();
      plot.current = null;
    };
  }, [shape, sheet, lowest, height]);

  // biome-ignore lint/correctness/useExhaustiveDependencies: a chart of another shape was made anew and has no data yet.
  useEffect(() => {
    const made = plot.current;
    if (made === null) return;
    made.batch(() => {
      made.setData(dataOf(chart, timeS), false);
      made.setScale("x", { min: span.fromS, max: span.toS });
    });
  }, [chart, timeS, span, shape]);

  const onKeyDown = (event: KeyboardEvent): void => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const next = afterKey(event.key, span, timeS, cursor);
    if (next === null) return;
    event.preventDefault();
    if ("row" in next) moveCursor(plot.current, next.row);
    else onZoom(next.span);
  };

  const shown = cursor ?? lastWithin(timeS, span);
  const values = chart.lines.map((line) => ({ line, text: valueText(line, shown, chart.decimals) }));
  const words = values.map(({ line, text }) => `${line.label} ${text} ${chart.unit}`).join(", ");
  return (
    <figure className="chart" aria-label={chart.title}>
      <figcaption className="chart-head">
        <strong>{chart.title}</strong>
        <span className="chart-unit">{chart.unit}</span>
        {values.map(({ line, text }) => (
          <span key={line.label} className="chart-value" data-ink={line.ink}>
            <i aria-hidden="true">{isDashed(line) ? "╌" : "—"}</i> {line.label} <b>{text}</b>
          </span>
        ))}
      </figcaption>
      <div
        ref={host}
        className="chart-canvas"
        role="img"
        // biome-ignore lint/a11y/noNoninteractiveTabindex: the arrows move the cursor, + and - zoom.
        tabIndex={0}
        aria-label={`${chart.title}: ${words}`}
        onKeyDown={onKeyDown}
      >
        {samples.map((name) => (
          <i key={name} className={`ink ink-${name}`} />
        ))}
      </div>
    </figure>
  );
}

/** What the style sheet says of the colours on the canvas. */
const samples = [
  ...(["measured", "measured-band", "wish", "wish-band", "other", "other-band"] as const),
  ...(["other-wish", "other-wish-band", "grid", "words"] as const),
] as const;
type Sample = (typeof samples)[number];

/** What was wished is dashed, so that it is told from what was measured without its colour. */
function isDashed({ ink }: Line): boolean {
  return ink === "wish" || ink === "other-wish";
}

interface Calls {
  readonly onCursor: (row: number | null) => void;
  readonly onZoom: (span: Span) => void;
  readonly onReset: () => void;
}

const LEFT_AXIS_PX = 58;
const LEAST_ZOOM_PX = 4;

function optionsOf(
  chart: Chart,
  host: HTMLElement,
  sheet: string,
  lowest: boolean,
  height: number,
  calls: Calls,
): uPlot.Options {
  const ink = (name: Sample): string => {
    const sample = host.querySelector(`.ink-${name}`);
    return sample === null ? "" : getComputedStyle(sample).color;
  };
  const grid = { stroke: () => ink("grid"), width: 1 };
  const ticks = { ...grid, size: 4 };
  const words = { stroke: () => ink("words"), font: "11px Inter, sans-serif" };
  const series = chart.lines.flatMap((line): uPlot.Series[] => {
    const stroke = (): string => ink(line.ink);
    const look = {
      stroke,
      width: 1.25,
      points: { show: false },
      ...(isDashed(line) ? { dash: [5, 4] } : {}),
    };
    return [look, look];
  });
  return {
    width: host.clientWidth,
    height,
    ms: 1,
    legend: { show: false },
    scales: {
      x: { time: false, auto: false },
      y: { range: (_, low, high) => rangeOf(low, high, chart.leastSpan) },
    },
    axes: [
      lowest
        ? { ...words, grid, ticks, size: 26, values: (_, times) => times.map((time) => `${round(time)} s`) }
        : { grid, ticks: { show: false }, size: 6, values: (_, times) => times.map(() => "") },
      { ...words, grid, ticks, size: LEFT_AXIS_PX, space: 24 },
    ],
    series: [{}, ...series],
    bands: chart.lines.map((line, index) => ({
      series: [2 * index + 1, 2 * index + 2],
      fill: () => ink(`${line.ink}-band`),
    })),
    cursor: {
      y: false,
      sync: { key: sheet, setSeries: false },
      points: { show: false },
      drag: { x: true, y: false, setScale: false },
      bind: {
        dblclick: () => () => {
          calls.onReset();
          return null;
        },
      },
    },
    hooks: {
      setCursor: [(plot) => calls.onCursor(plot.cursor.idx ?? null)],
      setSelect: [
        (plot) => {
          const { left, width } = plot.select;
          if (width < LEAST_ZOOM_PX) return;
          calls.onZoom({ fromS: plot.posToVal(left, "x"), toS: plot.posToVal(left + width, "x") });
          plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
        },
      ],
    },
  };
}

/** Least and greatest of each line, in the order of the bands. */
function dataOf(chart: Chart, timeS: number[]): uPlot.AlignedData {
  return [timeS, ...chart.lines.flatMap(({ greatest, least }) => [greatest, least])];
}

/** Both ends with a little air, and never less than the least span. */
function rangeOf(low: number | null, high: number | null, leastSpan: number): uPlot.Range.MinMax {
  if (low === null || high === null) return [-leastSpan / 2, leastSpan / 2];
  const half = Math.max(high - low, leastSpan) * 0.54;
  const middle = (low + high) / 2;
  return [middle - half, middle + half];
}

function round(value: number): string {
  return String(Number(value.toFixed(3)));
}

type AfterKey = { readonly row: number } | { readonly span: Span } | null;

const ZOOM = 0.5;

function afterKey(key: string, span: Span, timeS: readonly number[], cursor: number | null): AfterKey {
  const row = cursor ?? lastWithin(timeS, span);
  const middle = (row === null ? undefined : timeS[row]) ?? span.toS;
  const half = (span.toS - span.fromS) / 2;
  switch (key) {
    case "ArrowLeft":
      return row === null ? null : { row: Math.max(0, row - 1) };
    case "ArrowRight":
      return row === null ? null : { row: Math.min(timeS.length - 1, row + 1) };
    case "+":
      return { span: { fromS: middle - half * ZOOM, toS: middle + half * ZOOM } };
    case "-":
      return { span: { fromS: middle - half / ZOOM, toS: middle + half / ZOOM } };
    default:
      return null;
  }
}

function moveCursor(plot: uPlot | null, row: number): void {
  const time = plot?.data[0][row];
  if (plot === null || time === undefined) return;
  plot.setCursor({ left: plot.valToPos(time, "x"), top: 1 });
}

/** The newest row within the span. */
function lastWithin(timeS: readonly number[], span: Span): number | null {
  const row = timeS.findLastIndex((time) => time <= span.toS);
  return row === -1 ? null : row;
}

function valueText({ least, greatest }: Line, row: number | null, decimals: number): string {
  const low = row === null ? null : (least[row] ?? null);
  const high = row === null ? null : (greatest[row] ?? null);
  if (low === null || high === null) return "–";
  const from = low.toFixed(decimals);
  const to = high.toFixed(decimals);
  return from === to ? to : `${from} … ${to}`;
}

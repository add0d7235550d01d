/** What is drawn of an axis, in the operator's unit: charts below each other, over one time. */
import type { Capture, Motor } from "../../api/client";
import { shownPerCount, unitName } from "../../units/units";
import type { Column, Quantity, Rows } from "./rows";

/** The operator's wish is blue wherever it appears; what was measured has the colour of the text. `other`: of another run. */
export type Ink = "measured" | "wish" | "other" | "other-wish";

export interface Line {
  readonly label: string;
  readonly ink: Ink;
  readonly least: Column;
  /** The same column as `least` where a row is a single tick. */
  readonly greatest: Column;
}

export interface Chart {
  readonly title: string;
  readonly unit: string;
  readonly decimals: number;
  /** The vertical axis covers at least this much, so that noise does not look like motion. */
  readonly leastSpan: number;
  readonly lines: readonly Line[];
}

export interface Sheet {
  /** Seconds of kernel time: tick by period. */
  readonly timeS: number[];
  readonly tick: readonly number[];
  readonly charts: readonly Chart[];
}

const US_PER_S = 1e6;

/** The history of an axis; nothing when the app tells none of it. */
export function historySheet(rows: Rows, motor: Motor): Sheet | null {
  const axis = rows.axes.get(motor.slot);
  if (axis === undefined) return null;
  const perCount = shownPerCount(motor);
  const unit = unitName(motor);
  const line = (label: string, ink: Ink, quantity: Quantity, scale: number): Line => ({
    label,
    ink,
    ...scaled(quantity, scale),
  });
  const charts: Chart[] = [
    {
      ...lengths("Position", unit, perCount),
      lines: [
        line("setpoint", "wish", axis.setpoint_counts, perCount),
        line("measured", "measured", axis.position_counts, perCount),
      ],
    },
    {
      ...lengths("Error", unit, perCount),
      lines: [line("setpoint less measured", "measured", axis.error_counts, perCount)],
    },
    {
      ...speeds(unit, perCount),
      lines: [line("measured", "measured", axis.velocity_counts_per_s, perCount)],
    },
    { ...drives, lines: [line("sent", "measured", axis.drive, 1)] },
  ];
  if (rows.forces !== null) {
    charts.push({
      ...forces,
      lines: [
        line("hand", "wish", rows.forces.hand_n, 1),
        line("needle", "measured", rows.forces.needle_n, 1),
      ],
    });
  }
  return { timeS: rows.tick.map((tick) => (tick * rows.periodUs) / US_PER_S), tick: rows.tick, charts };
}

/** What the black box holds of an axis, tick by tick. */
export function captureSheet(capture: Capture, motor: Motor): Sheet {
  const perCount = shownPerCount(motor);
  const unit = unitName(motor);
  const single = (label: string, ink: Ink, column: Column): Line => ({
    label,
    ink,
    least: column,
    greatest: column,
  });
  const times = (column: Column): Column => column.map((value) => scaledValue(value, perCount));
  const position = times(capture.position_counts);
  const setpoint = times(capture.setpoint_counts);
  return {
    timeS: capture.tick.map((tick) => (tick * capture.period_us) / US_PER_S),
    tick: capture.tick,
    charts: [
      {
        ...lengths("Position", unit, perCount),
        lines: [single("setpoint", "wish", setpoint), single("measured", "measured", position)],
      },
      {
        ...lengths("Error", unit, perCount),
        lines: [single("setpoint less measured", "measured", differences(setpoint, position))],
      },
      {
        ...speeds(unit, perCount),
        lines: [single("of 20 ms", "measured", times(capture.velocity_counts_per_s))],
      },
      { ...drives, lines: [single("sent", "measured", capture.drive)] },
      ...forceCharts(capture.forces, single),
      {
        title: "Since the tick before",
        unit: "µs",
        decimals: 0,
        leastSpan: capture.period_us / 10,
        lines: [single("real time", "measured", intervals(capture))],
      },
    ],
  };
}

/** Force of a robot with a needle; no chart of another one. */
function forceCharts(
  captured: Capture["forces"],
  single: (label: string, ink: Ink, column: Column) => Line,
): Chart[] {
  if (captured === null) return [];
  return [
    {
      ...forces,
      lines: [single("hand", "wish", captured.hand_n), single("needle", "measured", captured.needle_n)],
    },
  ];
}

function lengths(title: string, unit: string, perCount: number): Omit<Chart, "lines"> {
  return { title, unit, decimals: 3, leastSpan: 10 * Math.abs(perCount) };
}

function speeds(unit: string, perCount: number): Omit<Chart, "lines"> {
  return { title: "Velocity", unit: `${unit}/s`, decimals: 2, leastSpan: 200 * Math.abs(perCount) };
}

const drives: Omit<Chart, "lines"> = { title: "Drive", unit: "words", decimals: 0, leastSpan: 10 };
const forces: Omit<Chart, "lines"> = { title: "Force", unit: "N", decimals: 2, leastSpan: 0.5 };

/** A negative scale changes which of the two is the lesser. */
function scaled({ least, greatest }: Quantity, scale: number): Quantity {
  const times = (column: Column): Column => column.map((value) => scaledValue(value, scale));
  return scale < 0
    ? { least: times(greatest), greatest: times(least) }
    : { least: times(least), greatest: times(greatest) };
}

function scaledValue(value: number | null, scale: number): number | null {
  return value === null ? null : value * scale;
}

function differences(minuend: Column, subtrahend: Column): Column {
  return minuend.map((value, index) => {
    const other = subtrahend[index] ?? null;
    return value === null || other === null ? null : value - other;
  });
}

/** Real time between the beginnings of ticks that follow each other. */
function intervals({ tick, begun_us }: Capture): Column {
  return tick.map((number, index) => {
    const follows = index > 0 && tick[index - 1] === number - 1;
    return follows ? (begun_us[index] ?? 0) - (begun_us[index - 1] ?? 0) : null;
  });
}

/** The part of a sheet between two times, both included. */
export function between(sheet: Sheet, fromS: number, toS: number): Sheet {
  const first = sheet.timeS.findIndex((time) => time >= fromS);
  const from = first === -1 ? sheet.timeS.length : first;
  const end = sheet.timeS.findLastIndex((time) => time <= toS) + 1;
  const cut = <Value>(column: readonly Value[]): Value[] => column.slice(from, end);
  return {
    timeS: cut(sheet.timeS),
    tick: cut(sheet.tick),
    charts: sheet.charts.map((chart) => ({
      ...chart,
      lines: chart.lines.map((line) => {
        const least = cut(line.least);
        return { ...line, least, greatest: line.least === line.greatest ? least : cut(line.greatest) };
      }),
    })),
  };
}

/** A table for other programs: a column for each line, two where a row covers several ticks. */
export function csvOf(sheet: Sheet): string {
  const columns: { readonly name: string; readonly values: readonly (number | null)[] }[] = [
    { name: "tick", values: sheet.tick },
    { name: "time (s)", values: sheet.timeS },
  ];
  for (const { title, unit, lines } of sheet.charts) {
    for (const { label, least, greatest } of lines) {
      const name = `${title}: ${label} (${unit})`;
      if (least === greatest) columns.push({ name, values: least });
      else {
        columns.push(
          { name: `${name} least`, values: least },
          { name: `${name} greatest`, values: greatest },
        );
      }
    }
  }
  const lines = sheet.tick.map((_, row) =>
    columns.map(({ values }) => csvNumber(values[row] ?? null)).join(","),
  );
  return `${[columns.map(({ name }) => name).join(","), ...lines].join("\n")}\n`;
}

/** Without the last digits, which are of the arithmetic and not of the robot. */
function csvNumber(value: number | null): string {
  return value === null ? "" : String(Number(value.toPrecision(12)));
}

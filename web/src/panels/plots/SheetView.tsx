import { ChartCanvas, type Span } from "./ChartCanvas";
import type { Sheet } from "./charts";

interface SheetViewProps {
  readonly name: string;
  readonly sheet: Sheet;
  readonly span: Span;
  readonly height: number;
  readonly onZoom: (span: Span) => void;
  readonly onReset: () => void;
}

const TIMES_PX = 20;

/** The charts of a sheet below each other, over the same time. */
export function SheetView({ name, sheet, span, height, onZoom, onReset }: SheetViewProps) {
  return (
    <div className="chart-sheet">
      {sheet.charts.map((chart, index) => {
        const lowest = index === sheet.charts.length - 1;
        return (
          <ChartCanvas
            key={chart.title}
            chart={chart}
            timeS={sheet.timeS}
            span={span}
            sheet={name}
            lowest={lowest}
            height={lowest ? height + TIMES_PX : height}
            onZoom={onZoom}
            onReset={onReset}
          />
        );
      })}
    </div>
  );
}

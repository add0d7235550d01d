import { useEffect, useMemo, useState } from "react";
import { api, type Capture, type Motor } from "../../api/client";
import { download } from "../../design/download";
import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import { type Notice, noticeOfProblem } from "../../state/notice";
import { useConsole } from "../../state/store";
import { unitName } from "../../units/units";
import type { Span } from "./ChartCanvas";
import { between, captureSheet, csvOf, type Sheet } from "./charts";
import type { AxisQuantity, Rows } from "./rows";
import { SheetView } from "./SheetView";
import { type Armed, type Edge, firedAt, lastTickOf, type Trigger, triggerQuantities } from "./trigger";

const lengthsS = [1, 2, 4, 10] as const;
const CHART_PX = 74;

interface CapturePanelProps {
  readonly motor: Motor;
  readonly rows: Rows | null;
}

/** Every single tick of an axis, from the kernel's black box: now, or around what a trigger waits for. */
export function CapturePanel({ motor, rows }: CapturePanelProps) {
  const [seconds, setSeconds] = useState<number>(2);
  const [capture, setCapture] = useState<Capture | null>(null);
  const [notice, setNotice] = useState<Notice | null>(null);
  const [armed, setArmed] = useState<Armed | null>(null);
  const take = async (until?: number, length = seconds): Promise<void> => {
    const answer = await api.capture(motor.slot, length, until);
    setNotice(answer.ok ? null : noticeOfProblem(answer.problem));
    if (answer.ok) setCapture(answer.value);
  };
  const fired = useFired(armed, rows, motor);
  const due =
    armed !== null && fired !== null && rows !== null ? lastTickOf(armed, fired, rows.periodUs) : null;
  const newest = rows?.tick.at(-1) ?? null;
  const ripe = due !== null && newest !== null && newest >= due;
  // biome-ignore lint/correctness/useExhaustiveDependencies: once for each trigger that is ripe.
  useEffect(() => {
    if (!ripe || armed === null || due === null) return;
    setArmed(null);
    void take(due, armed.seconds);
  }, [ripe]);

  return (
    <Panel title="Capture" className="capture-panel">
      <div className="capture-form">
        <label>
          Length{" "}
          <select value={seconds} onChange={({ target }) => setSeconds(Number(target.value))}>
            {lengthsS.map((length) => (
              <option key={length} value={length}>
                {length} s
              </option>
            ))}
          </select>
        </label>
        <button type="button" className="button" onClick={() => void take()}>
          Capture now
        </button>
      </div>
      <TriggerForm
        motor={motor}
        armed={armed !== null}
        onArm={(trigger) => setArmed(newest === null ? null : { trigger, sinceTick: newest, seconds })}
        onDisarm={() => setArmed(null)}
      />
      <output className="capture-state" aria-label="Capture state">
        {stateWords(armed, fired, capture, motor)}
      </output>
      {notice !== null && (
        <p className="panel-notice" role="alert">
          <NoticeText lead="Not captured:" notice={notice} />
        </p>
      )}
      {capture !== null && capture.tick.length > 0 && <Captured capture={capture} motor={motor} />}
    </Panel>
  );
}

/** The tick at which the trigger fired, kept until it is armed anew. */
function useFired(armed: Armed | null, rows: Rows | null, motor: Motor): number | null {
  const axis = useConsole((state) => state.frame?.axes[motor.slot]);
  const [fired, setFired] = useState<{ readonly armed: Armed; readonly tick: number } | null>(null);
  const known = fired !== null && fired.armed === armed ? fired.tick : null;
  const now = armed === null || rows === null || known !== null ? null : firedAt(armed, rows, motor, axis);
  useEffect(() => {
    if (armed !== null && now !== null) setFired({ armed, tick: now });
  }, [armed, now]);
  return known ?? now;
}

function stateWords(
  armed: Armed | null,
  fired: number | null,
  capture: Capture | null,
  motor: Motor,
): string {
  if (fired !== null) return `▲ Triggered at tick ${fired}; waiting for the ticks after it.`;
  if (armed !== null) return `◷ Armed since tick ${armed.sinceTick}.`;
  if (capture === null) return "Nothing captured yet.";
  const [first, last] = [capture.tick[0], capture.tick.at(-1)];
  if (first === undefined || last === undefined) return "The black box does not hold these ticks.";
  const missing = last - first + 1 - capture.tick.length;
  return `${motor.title}: ${capture.tick.length} ticks, ${first} to ${last}${missing === 0 ? "" : `, ${missing} missing`}.`;
}

function Captured({ capture, motor }: { readonly capture: Capture; readonly motor: Motor }) {
  const sheet = useMemo((): Sheet => captureSheet(capture, motor), [capture, motor]);
  const whole = useMemo((): Span => ({ fromS: sheet.timeS[0] ?? 0, toS: sheet.timeS.at(-1) ?? 0 }), [sheet]);
  const [zoomed, setZoomed] = useState<{ readonly sheet: Sheet; readonly span: Span } | null>(null);
  const span = zoomed?.sheet === sheet ? zoomed.span : whole;
  return (
    <>
      <SheetView
        name="capture"
        sheet={sheet}
        span={span}
        height={CHART_PX}
        onZoom={(wanted) => setZoomed({ sheet, span: wanted })}
        onReset={() => setZoomed(null)}
      />
      <div className="capture-form">
        <button
          type="button"
          className="button"
          aria-label="CSV of the capture"
          onClick={() =>
            download(
              `${motor.name}-capture-${capture.tick[0] ?? 0}.csv`,
              "text/csv",
              csvOf(between(sheet, span.fromS, span.toS)),
            )
          }
        >
          CSV
        </button>
        {zoomed?.sheet === sheet && (
          <button type="button" className="button" onClick={() => setZoomed(null)}>
            Show all
          </button>
        )}
      </div>
    </>
  );
}

interface TriggerFormProps {
  readonly motor: Motor;
  readonly armed: boolean;
  readonly onArm: (trigger: Trigger) => void;
  readonly onDisarm: () => void;
}

function TriggerForm({ motor, armed, onArm, onDisarm }: TriggerFormProps) {
  const [on, setOn] = useState<AxisQuantity | "fault">("fault");
  const [edge, setEdge] = useState<Edge>("above");
  const [level, setLevel] = useState("0");
  const value = Number(level.replace(",", ".").replace("−", "-"));
  const usable = on === "fault" || (level.trim() !== "" && Number.isFinite(value));
  return (
    <form
      className="capture-form"
      aria-label="Trigger"
      onSubmit={(event) => {
        event.preventDefault();
        if (armed) onDisarm();
        else if (usable) onArm(on === "fault" ? { on } : { on: "level", quantity: on, edge, level: value });
      }}
    >
      <fieldset className="capture-form" disabled={armed}>
        <label>
          Trigger{" "}
          <select value={on} onChange={({ target }) => setOn(target.value as AxisQuantity | "fault")}>
            <option value="fault">Fault</option>
            {triggerQuantities.map(({ name, title }) => (
              <option key={name} value={name}>
                {title}
              </option>
            ))}
          </select>
        </label>
        {on !== "fault" && (
          <>
            <select
              aria-label="Trigger when"
              value={edge}
              onChange={({ target }) => setEdge(target.value as Edge)}
            >
              <option value="above">above</option>
              <option value="below">below</option>
            </select>
            <input
              className="text capture-level"
              inputMode="decimal"
              aria-label={`Trigger level, ${levelUnit(on, motor)}`}
              aria-invalid={!usable}
              value={level}
              onChange={({ target }) => setLevel(target.value)}
            />
            {levelUnit(on, motor)}
          </>
        )}
      </fieldset>
      <button type="submit" className="button" disabled={!armed && !usable} aria-pressed={armed}>
        {armed ? "Disarm" : "Arm"}
      </button>
    </form>
  );
}

function levelUnit(quantity: AxisQuantity, motor: Motor): string {
  if (quantity === "drive") return "words";
  return quantity === "velocity_counts_per_s" ? `${unitName(motor)}/s` : unitName(motor);
}

import { type FormEvent, useEffect, useId, useRef, useState } from "react";
import { flushSync } from "react-dom";
import type { Motor } from "../../api/client";
import { Panel } from "../../design/Panel";
import { ReasonLine } from "../../design/ReasonLine";
import { propose } from "../../state/commands";
import { type MotionKind, useMotionPlace } from "../../state/route";
import { useConsole } from "../../state/store";
import { useReason } from "../../state/useReason";
import { unitName, unitWord } from "../../units/units";
import {
  type AblationRow,
  ablationDraft,
  coordinatedDraft,
  type Draft,
  DURATION,
  fieldOf,
  MOST_STEPS,
  movedRow,
  type Problems,
  type Ranged,
  ranged,
  rangeWords,
} from "./motion";
import "./motion.css";

const titles: Readonly<Record<MotionKind, string>> = {
  coordinated: "Several axes together",
  ablation: "Ablation in steps",
};

/** A motion of several axes that is typed. `only`: the one kind that the page is about; else the user chooses. */
export function MotionPanel({ only }: { readonly only?: MotionKind }) {
  const place = useMotionPlace();
  const [chosen, setChosen] = useState(place);
  const kindId = useId();
  const motors = useConsole((state) => state.motors);
  const modes = useConsole((state) => state.robot?.modes);
  const kinds = (Object.keys(titles) as MotionKind[]).filter((kind) => modes?.includes(kind) ?? false);
  const kind = kinds.find((each) => each === (only ?? chosen)) ?? kinds[0];
  useEffect(() => {
    if (place !== null) setChosen(place);
  }, [place]);
  const of = (name: string): Motor | undefined => motors.find((motor) => motor.name === name);
  const [rotation, depth] = [of("probe_rotation"), of("insertion")];
  return (
    <Panel title="Propose a motion" className="motion-panel">
      <ReasonLine need="holder" />
      {kind === undefined && <p className="panel-words">This robot has no motion of several axes.</p>}
      {only === undefined && kind !== undefined && (
        <p className="motion-line">
          <label htmlFor={kindId}>Kind</label>
          <select id={kindId} value={kind} onChange={({ target }) => setChosen(target.value as MotionKind)}>
            {kinds.map((each) => (
              <option key={each} value={each}>
                {titles[each]}
              </option>
            ))}
          </select>
        </p>
      )}
      {/* What is typed in one form outlives a look at the other. */}
      <div hidden={kind !== "coordinated"}>{only === undefined && <Coordinated motors={motors} />}</div>
      <div hidden={kind !== "ablation"}>
        {rotation === undefined || depth === undefined ? (
          <p className="panel-words">Its axes are not called probe_rotation and insertion.</p>
        ) : (
          <Ablation rotation={rotation} depth={depth} />
        )}
      </div>
    </Panel>
  );
}

/** Where an axis may be sent now; the same object until that changes. */
function useRanged(motor: Motor): Ranged {
  const low = useConsole(({ frame }) => ranged(motor, frame?.axes[motor.slot]).low);
  const high = useConsole(({ frame }) => ranged(motor, frame?.axes[motor.slot]).high);
  return { motor, low, high };
}

/** Sends what was read, or remembers that somebody tried, so that from then on it is said what is wrong. */
function useSending(read: () => Draft) {
  const [tried, setTried] = useState(false);
  const found = tried ? read() : null;
  const onSubmit = (event: FormEvent): void => {
    event.preventDefault();
    const now = read();
    setTried(!now.ok);
    if (now.ok) void propose(now.draft);
  };
  return { problems: found === null || found.ok ? null : found.problems, onSubmit };
}

function Coordinated({ motors }: { readonly motors: readonly Motor[] }) {
  const [texts, setTexts] = useState<Readonly<Record<string, string>>>({});
  const [duration, setDuration] = useState("");
  const wrongId = useId();
  const readOnly = useReason("holder") !== null;
  const rangedNow = (): Ranged[] => {
    const { frame } = useConsole.getState();
    return motors.map((motor) => ranged(motor, frame?.axes[motor.slot]));
  };
  const { problems, onSubmit } = useSending(() => coordinatedDraft(rangedNow(), texts, duration));
  const shared = { readOnly, wrongId };
  return (
    <form className="motion-form" aria-label={titles.coordinated} noValidate onSubmit={onSubmit}>
      <p className="muted">An axis without a target stays where it is. All arrive together.</p>
      {motors.map((motor) => (
        <AxisField
          key={motor.slot}
          motor={motor}
          text={texts[motor.name] ?? ""}
          wrong={problems?.has(motor.name) ?? false}
          onText={(text) => setTexts((known) => ({ ...known, [motor.name]: text }))}
          {...shared}
        />
      ))}
      <div className="motion-field">
        <span>Shortest duration</span>
        <NumberInput
          name="Shortest duration, s"
          text={duration}
          wrong={problems?.has(DURATION) ?? false}
          onText={setDuration}
          {...shared}
        />
        <span>s</span>
        <small className="muted">empty: as fast as the axes allow</small>
      </div>
      <Wrong id={wrongId} problems={problems} />
      <Send readOnly={readOnly} />
    </form>
  );
}

interface AxisFieldProps extends Omit<NumberInputProps, "name"> {
  readonly motor: Motor;
}

function AxisField({ motor, ...input }: AxisFieldProps) {
  const axis = useRanged(motor);
  return (
    <div className="motion-field">
      <span>{motor.title}</span>
      <NumberInput name={`${motor.title} target, ${unitWord(motor)}, ${rangeWords(axis)}`} {...input} />
      <span>{unitName(motor)}</span>
      <small className="muted">{rangeWords(axis)}</small>
    </div>
  );
}

interface AblationProps {
  readonly rotation: Motor;
  readonly depth: Motor;
}

function Ablation(motors: AblationProps) {
  const [rows, setRows] = useState<readonly AblationRow[]>([{ id: 0, rotation: "", depth: "", dwell: "" }]);
  const nextId = useRef(1);
  const added = useRef<string | null>(null);
  const wrongId = useId();
  const base = useId();
  const readOnly = useReason("holder") !== null;
  const [rotation, depth] = [useRanged(motors.rotation), useRanged(motors.depth)];
  const { problems, onSubmit } = useSending(() => ablationDraft(rotation, depth, rows));
  const idOf = (row: Pick<AblationRow, "id">, part: string): string => `${base}-${row.id}-${part}`;

  // Whoever adds a step writes it next.
  useEffect(() => {
    if (added.current !== null && rows.length > 0) document.getElementById(added.current)?.focus();
    added.current = null;
  }, [rows]);

  const add = (): void => {
    const row = { id: nextId.current, rotation: "", depth: "", dwell: rows.at(-1)?.dwell ?? "" };
    nextId.current += 1;
    added.current = idOf(row, "rotation");
    setRows([...rows, row]);
  };
  const change = (row: AblationRow, part: Partial<AblationRow>): void =>
    setRows(rows.map((each) => (each === row ? { ...each, ...part } : each)));
  const move = (at: number, by: -1 | 1, button: string): void => {
    // The browser takes the focus from what it moves.
    flushSync(() => setRows(movedRow(rows, at, by)));
    document.getElementById(button)?.focus();
  };
  const remove = (at: number): void => {
    flushSync(() => setRows(rows.filter((_, place) => place !== at)));
    document.getElementById(`${base}-add`)?.focus();
  };
  const fields = [
    { field: "rotation", words: `rotation, degrees, ${rangeWords(rotation)}` },
    { field: "depth", words: `depth, millimetres, ${rangeWords(depth)}` },
    { field: "dwell", words: "rest, s" },
  ] as const;
  return (
    <form className="motion-form" aria-label={titles.ablation} noValidate onSubmit={onSubmit}>
      <p className="muted">
        One step after the other: the probe turns ({rangeWords(rotation)}) and goes to its depth (
        {rangeWords(depth)}), then rests.
      </p>
      <table className="table motion-steps">
        <thead>
          <tr>
            <th scope="col">Step</th>
            <th scope="col">Rotation, °</th>
            <th scope="col">Depth, mm</th>
            <th scope="col">Rest, s</th>
            <th scope="col">
              <span className="visually-hidden">Move, remove</span>
            </th>
          </tr>
        </thead>
        <tbody>
          {rows.map((row, at) => (
            <tr key={row.id}>
              <th scope="row">{at + 1}</th>
              {fields.map(({ field, words }) => (
                <td key={field}>
                  <NumberInput
                    id={idOf(row, field)}
                    name={`Step ${at + 1} ${words}`}
                    text={row[field]}
                    wrong={problems?.has(fieldOf(row, field)) ?? false}
                    readOnly={readOnly}
                    wrongId={wrongId}
                    onText={(text) => change(row, { [field]: text })}
                  />
                </td>
              ))}
              <td>
                <RowButton
                  id={idOf(row, "earlier")}
                  name={`Move step ${at + 1} up`}
                  off={readOnly || at === 0}
                  onPress={() => move(at, -1, idOf(row, "earlier"))}
                >
                  ↑
                </RowButton>
                <RowButton
                  id={idOf(row, "later")}
                  name={`Move step ${at + 1} down`}
                  off={readOnly || at === rows.length - 1}
                  onPress={() => move(at, 1, idOf(row, "later"))}
                >
                  ↓
                </RowButton>
                <RowButton
                  id={idOf(row, "remove")}
                  name={`Remove step ${at + 1}`}
                  off={readOnly}
                  onPress={() => remove(at)}
                >
                  ✕
                </RowButton>
              </td>
            </tr>
          ))}
        </tbody>
      </table>
      <span>
        <button
          id={`${base}-add`}
          type="button"
          className="button"
          aria-disabled={readOnly || rows.length >= MOST_STEPS}
          title={rows.length >= MOST_STEPS ? `${MOST_STEPS} steps are the most` : undefined}
          onClick={() => {
            if (!readOnly && rows.length < MOST_STEPS) add();
          }}
        >
          Add step
        </button>
      </span>
      <Wrong id={wrongId} problems={problems} />
      <Send readOnly={readOnly} />
    </form>
  );
}

interface RowButtonProps {
  readonly id: string;
  readonly name: string;
  readonly off: boolean;
  readonly onPress: () => void;
  readonly children: string;
}

/** Keeps the focus where it can do nothing, which a disabled button would lose. */
function RowButton({ id, name, off, onPress, children }: RowButtonProps) {
  return (
    <button
      id={id}
      type="button"
      className="button small"
      aria-label={name}
      aria-disabled={off}
      onClick={() => {
        if (!off) onPress();
      }}
    >
      <i aria-hidden="true">{children}</i>
    </button>
  );
}

interface NumberInputProps {
  readonly id?: string;
  /** With its unit, for whoever does not see where it stands. */
  readonly name: string;
  readonly text: string;
  readonly wrong: boolean;
  readonly readOnly: boolean;
  readonly wrongId: string;
  readonly onText: (text: string) => void;
}

function NumberInput({ id, name, text, wrong, readOnly, wrongId, onText }: NumberInputProps) {
  return (
    <input
      id={id}
      className="text"
      value={text}
      readOnly={readOnly}
      inputMode="decimal"
      autoComplete="off"
      aria-label={name}
      aria-invalid={wrong}
      aria-describedby={wrongId}
      onChange={({ target }) => onText(target.value)}
    />
  );
}

/** What was not sent, and why: one sentence for each field. */
function Wrong({ id, problems }: { readonly id: string; readonly problems: Problems | null }) {
  return (
    <div id={id} role="alert">
      {problems !== null && (
        <ul className="motion-wrong">
          <li>Not sent:</li>
          {[...problems].map(([field, words]) => (
            <li key={field}>
              <i aria-hidden="true">✕</i> {words}
            </li>
          ))}
        </ul>
      )}
    </div>
  );
}

function Send({ readOnly }: { readonly readOnly: boolean }) {
  return (
    <span>
      <button type="submit" className="button primary" disabled={readOnly}>
        Propose motion
      </button>
    </span>
  );
}

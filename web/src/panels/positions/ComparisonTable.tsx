import { useState } from "react";
import type { Motor, PositionsComparison } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { Confirm } from "../../design/Confirm";
import { propose } from "../../state/commands";
import { type ConsoleState, useConsole } from "../../state/store";
import { useReason } from "../../state/useReason";
import { localDate } from "../../units/time";
import { formatCounts, formatDifference } from "../../units/units";
import { axesThatDiffer, motionTo } from "./choice";
import { WhatBecomesInvalid } from "./DeclaredShift";
import "./positions.css";

type Row = PositionsComparison["axes"][number];

interface ComparisonTableProps {
  readonly name: string;
  readonly comparison: PositionsComparison;
  readonly onConfirm: (axes: string[]) => Promise<void>;
  readonly onCancel: () => void;
}

/** Old and new position of each axis. Only positions are set; setpoint and enabled are what they were when saved. */
export function ComparisonTable({ name, comparison, onConfirm, onCancel }: ComparisonTableProps) {
  const motors = useConsole((state) => state.motors);
  const reason = useReason("holder");
  const [chosen, setChosen] = useState<ReadonlySet<string>>(() => axesThatDiffer(comparison.axes, motors));
  const choose = (axis: string, wanted: boolean): void => {
    const others = [...chosen].filter((each) => each !== axis);
    setChosen(new Set(wanted ? [...others, axis] : others));
  };
  return (
    <Confirm
      title={`Positions of ${name}`}
      action={`Set ${chosen.size} ${chosen.size === 1 ? "position" : "positions"}`}
      off={chosen.size === 0 || reason !== null}
      other={<GoThere comparison={comparison} chosen={chosen} onProposed={onCancel} />}
      onConfirm={() => onConfirm([...chosen])}
      onCancel={onCancel}
    >
      <p>
        Saved {localDate(comparison.saved)}. <em>Set</em>: nothing moves; the chosen axes take the saved
        position for where they stand, and are not homed afterwards. <em>Propose to go there</em>: the chosen
        axes, which are homed, move there together once somebody approves it.
      </p>
      <table className="table comparison">
        <thead>
          <tr>
            <th scope="col">Set</th>
            <th scope="col">Axis</th>
            <th scope="col" className="number">
              Now
            </th>
            <th scope="col" className="number">
              Saved
            </th>
            <th scope="col" className="number">
              Difference
            </th>
            <th scope="col" className="number">
              Setpoint then
            </th>
            <th scope="col">Then</th>
          </tr>
        </thead>
        <tbody>
          {comparison.axes.map((row) => (
            <AxisLine
              key={row.slot}
              row={row}
              motor={motors.find((motor) => motor.slot === row.slot)}
              chosen={chosen.has(row.axis)}
              onChoose={(wanted) => choose(row.axis, wanted)}
            />
          ))}
        </tbody>
      </table>
      <WhatBecomesInvalid />
    </Confirm>
  );
}

interface GoThereProps {
  readonly comparison: PositionsComparison;
  readonly chosen: ReadonlySet<string>;
  readonly onProposed: () => void;
}

/** The saved position as a motion, which waits for its approval. */
function GoThere({ comparison, chosen, onProposed }: GoThereProps) {
  const motors = useConsole((state) => state.motors);
  const motionNow = ({ frame }: ConsoleState) =>
    motionTo(comparison.axes, chosen, motors, (slot) => frame?.axes[slot]?.homed ?? false);
  const off = useConsole((state) => motionNow(state).off);
  const onCommand = async (): Promise<void> => {
    const motion = motionNow(useConsole.getState());
    if (motion.off !== null) return;
    await propose(motion.draft);
    onProposed();
  };
  return (
    <CommandButton need="holder" off={off} onCommand={onCommand}>
      Propose to go there
    </CommandButton>
  );
}

interface AxisLineProps {
  readonly row: Row;
  readonly motor: Motor | undefined;
  readonly chosen: boolean;
  readonly onChoose: (wanted: boolean) => void;
}

function AxisLine({ row, motor, chosen, onChoose }: AxisLineProps) {
  const shown = (counts: number): string =>
    motor === undefined ? `${counts} counts` : formatCounts(motor, counts);
  const title = motor?.title ?? row.axis;
  const difference = row.saved_counts - row.now_counts;
  return (
    <tr>
      <td>
        {row.restorable ? (
          <input
            type="checkbox"
            aria-label={`Set ${title}`}
            checked={chosen}
            onChange={(event) => onChoose(event.target.checked)}
          />
        ) : (
          <span title="The saved position is outside the soft limits.">outside limits</span>
        )}
      </td>
      <th scope="row">{title}</th>
      <td className="number">{shown(row.now_counts)}</td>
      <td className="number">{shown(row.saved_counts)}</td>
      <td className="number difference" data-differs={difference !== 0}>
        {motor === undefined ? shown(difference) : formatDifference(motor, difference)}
      </td>
      <td className="number muted">{row.setpoint_counts === null ? "none" : shown(row.setpoint_counts)}</td>
      <td className="muted">
        {row.enabled ? "enabled" : "disabled"}, {row.homed ? "homed" : "not homed"}
      </td>
    </tr>
  );
}

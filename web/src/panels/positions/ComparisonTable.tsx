import { useState } from "react";
import type { Motor, PositionsComparison } from "../../api/client";
import { Confirm } from "../../design/Confirm";
import { useConsole } from "../../state/store";
import { useReason } from "../../state/useReason";
import { localDate } from "../../units/time";
import { formatCounts } from "../../units/units";
import { axesThatDiffer } from "./choice";
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
      onConfirm={() => onConfirm([...chosen])}
      onCancel={onCancel}
    >
      <p>
        Saved {localDate(comparison.saved)}. Nothing moves; the chosen axes take the saved position for where
        they stand, and are not homed afterwards.
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
    </Confirm>
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
        {difference > 0 ? "+" : ""}
        {shown(difference)}
      </td>
      <td className="number muted">{row.setpoint_counts === null ? "none" : shown(row.setpoint_counts)}</td>
      <td className="muted">
        {row.enabled ? "enabled" : "disabled"}, {row.homed ? "homed" : "not homed"}
      </td>
    </tr>
  );
}

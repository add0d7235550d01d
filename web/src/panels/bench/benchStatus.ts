/** What the plant says of its faults; see `status` in models/plant/README.md. What it does not say is taken for sound. */

export interface PlantAxis {
  readonly slot: number;
  readonly jammed: boolean;
  readonly reversed: boolean;
  readonly runawayCountsPerTick: number;
  readonly encoder: string;
  readonly switchState: string;
  readonly hasSwitch: boolean;
  /** How motor, gear and encoder are simulated, by the names of the plant file. */
  readonly parameters: Readonly<Record<string, number>>;
  /** Whether one of them is not as in the plant file. */
  readonly parametersChanged: boolean;
}

/** A connected input of a sensor card. */
export interface PlantInput {
  readonly slot: number;
  readonly adc: number;
  readonly name: string;
  readonly forceCounts: number;
}

export interface PlantStatus {
  readonly pedalNo: string;
  readonly pedalNc: string;
  readonly estopPulled: boolean;
  /** By rising slot. */
  readonly axes: readonly PlantAxis[];
  readonly inputs: readonly PlantInput[];
  /** Slots whose card is without power. */
  readonly unpowered: ReadonlySet<number>;
}

type Fields = Readonly<Record<string, unknown>>;

export function plantStatus(answer: unknown): PlantStatus {
  const status = fieldsOf(answer);
  const pedal = fieldsOf(status.pedal);
  const cards = listOf(status.cards).filter((card) => card.powered === false);
  return {
    pedalNo: textOf(pedal.no, "free"),
    pedalNc: textOf(pedal.nc, "free"),
    estopPulled: fieldsOf(status.estop).pulled === true,
    axes: listOf(status.axes).map(plantAxis),
    inputs: listOf(status.sensors).flatMap(plantInputs),
    unpowered: new Set(cards.map((card) => numberOf(card.slot))),
  };
}

function plantAxis(axis: Fields): PlantAxis {
  return {
    slot: numberOf(axis.slot),
    jammed: axis.jammed === true,
    reversed: axis.reversed === true,
    runawayCountsPerTick: numberOf(axis.counts_per_tick),
    encoder: textOf(axis.encoder, "normal"),
    switchState: textOf(axis.switch, "normal"),
    hasSwitch: axis.has_switch === true,
    parameters: Object.fromEntries(
      Object.entries(fieldsOf(axis.parameters)).map(([name, value]) => [name, numberOf(value)]),
    ),
    parametersChanged: axis.parameters_changed === true,
  };
}

function plantInputs(sensor: Fields): PlantInput[] {
  const inputs = Array.isArray(sensor.inputs) ? sensor.inputs.map(fieldsOf) : [];
  return inputs.map((input) => ({
    slot: numberOf(sensor.slot),
    adc: numberOf(input.adc),
    name: textOf(sensor.name, "sensor"),
    forceCounts: numberOf(input.force_counts),
  }));
}

function fieldsOf(value: unknown): Fields {
  return typeof value === "object" && value !== null ? (value as Fields) : {};
}

/** The members that have a slot. */
function listOf(value: unknown): Fields[] {
  const members = Array.isArray(value) ? value.map(fieldsOf) : [];
  return members.filter((member) => typeof member.slot === "number");
}

function textOf(value: unknown, fallback: string): string {
  return typeof value === "string" ? value : fallback;
}

function numberOf(value: unknown): number {
  return typeof value === "number" ? value : 0;
}

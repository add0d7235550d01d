/** The steps of a case: what the data say of each, and which is to be done now. They claim nothing that the data do not say. */
import type { AlignmentView, Case, Imager, Motor, Proposal, Robot, Targeting } from "../../api/client";
import { isOpen } from "../../state/proposals";
import type { Asked } from "../../state/usePolled";
import type { AxisFrame } from "../../stream/decode";
import { formatCounts } from "../../units/units";
import { formatHeardAge } from "../navigation/figures";
import { caseInHand, isOfOtherRobot } from "../targeting/case";
import { fixed } from "../targeting/numbers";
import { registrationAdvice } from "../targeting/registration";

export const stepTitles = {
  case: "Open a case",
  home: "Home the robot",
  register: "Registration",
  image: "Image",
  target: "Entry and target",
  review: "Review the motion",
  align: "Align the robot",
  confirm: "Confirm by an image",
  insert: "Insert",
  treat: "Ablate",
  retract: "Retract",
  end: "Next target, or close the case",
} as const;
export type StepName = keyof typeof stepTitles;

/** What the main button of a step does: `ready` unlocks and enables, `panel` and `proposal` lead to what is shown beside the steps. */
export type Act =
  | "open"
  | "case"
  | "ready"
  | "motors"
  | "home"
  | "panel"
  | "proposal"
  | "insert"
  | "biopsy"
  | "retract"
  | "close";

export interface Step {
  readonly name: StepName;
  readonly title: string;
  readonly state: "done" | "now" | "waits";
  /** What is so, or what it waits for. */
  readonly words: string;
  readonly act: Act | null;
}

/** What a person ticked, and what it was about: it holds for no other case, registration, target or place of the probe. */
export interface Tick {
  readonly about: string;
  /** Positions of the axes, in the order of the motors. */
  readonly counts: readonly number[];
}

export type TickName = "confirm" | "treat";
export type Ticks = Readonly<Record<TickName, Tick | null>>;

export type AxisNow = Pick<AxisFrame, "state" | "homed" | "homedByHand" | "positionCounts" | "minCounts">;

export interface Situation {
  readonly robot: Robot;
  readonly motors: readonly Motor[];
  /** In the order of the motors. */
  readonly axes: readonly AxisNow[];
  /** Of the kernel. */
  readonly mode: string;
  readonly cases: readonly Case[];
  readonly targeting: Targeting;
  readonly view: AlignmentView;
  /** Null where it cannot be known. */
  readonly imager: Imager | null;
  /** Newest first. */
  readonly proposals: readonly Proposal[];
  readonly ticks: Ticks;
}

const INSERTION = "insertion";
/** Axes that move the probe along or about its own line, and leave the line where it is. */
const alongProbe: ReadonlySet<string> = new Set([INSERTION, "probe_rotation", "rotation"]);
/** A biopsy ends at the depth that it estimates, of a needle that bends: docs/biopsy.md. */
const BIOPSY_WITHIN_MM = 2;
const SAME_MM = 1e-6;

/** What the steps ask of the data, answered once. */
function factsOf(now: Situation) {
  const { motors, axes, robot, cases, targeting, view, proposals, ticks } = now;
  const inHand = caseInHand(cases);
  const open = inHand?.state === "open" && !isOfOtherRobot(inHand, robot.name) ? inHand : undefined;
  const alignment = open === undefined ? null : view.alignment;
  const setpoint = (motor: Motor): number | undefined => alignment?.setpoints[motor.name]?.counts;
  const isAt = (at: number, counts: number, within = slack(motors[at])): boolean =>
    axes[at]?.homed === true && Math.abs(axes[at].positionCounts - counts) <= within;
  const placing = motors.flatMap((motor, at) => {
    const counts = alongProbe.has(motor.name) ? undefined : setpoint(motor);
    return counts === undefined ? [] : [{ motor, isThere: isAt(at, counts) }];
  });
  const away = placing.filter(({ isThere }) => !isThere).map(({ motor }) => motor.title);
  const probeAt = motors.findIndex(({ name }) => name === INSERTION);
  const [probe, probeAxis] = [motors[probeAt], axes[probeAt]];
  const isOut = probeAxis !== undefined && isAt(probeAt, probeAxis.minCounts);
  const depth = probe === undefined ? undefined : setpoint(probe);
  const takesBiopsies = robot.modes.includes("cooperative_biopsy");
  const within =
    takesBiopsies && probe !== undefined ? BIOPSY_WITHIN_MM * Math.abs(probe.counts_per_unit) : undefined;
  const isAligned = placing.length > 0 && away.length === 0;
  const isTicked = (name: TickName): boolean => ticks[name] !== null;
  return {
    inHand,
    open,
    alignment,
    away,
    probe,
    probeAxis,
    depth,
    isOut,
    isAligned,
    isInserted: isAligned && depth !== undefined && !isOut && isAt(probeAt, depth, within),
    takesBiopsies,
    ablates: robot.modes.includes("ablation"),
    unhomed: motors.filter((_, at) => axes[at]?.homed !== true),
    byHand: axes.filter(({ homedByHand }) => homedByHand).length,
    isRegistered: open !== undefined && targeting.registration_state === "valid",
    isAimed: open !== undefined && targeting.entry_point !== null && targeting.target_point !== null,
    running: proposals.find(isOpen),
    /** The motion to where entry and target ask, as they are now. */
    toTarget: proposals.find(
      (each) =>
        alignment !== null &&
        each.aim !== null &&
        (each.state === "done" || (each.state !== "drafted" && isOpen(each))) &&
        each.aim.desired.every(
          (value, at) => Math.abs(value - (alignment.desired[at] ?? Number.NaN)) <= SAME_MM,
        ),
    ),
    isConfirmed: isTicked("confirm"),
    isTreated: isTicked("treat"),
  };
}

type Facts = ReturnType<typeof factsOf>;

/** Within so many counts of its setpoint an axis rests at it; its encoder trembles by one. */
function slack(motor: Motor | undefined): number {
  return (motor?.deadband_counts ?? 1) + 1;
}

/** Which step an open proposal belongs to; null when to none. */
function stepOf(proposal: Proposal, facts: Facts): StepName | null {
  if (proposal.kind === "home") return "home";
  if (proposal.kind === "biopsy") return "insert";
  if (proposal.kind !== "path") return null;
  if (proposal.mode === "ablation") return "treat";
  if (proposal.aim !== null) {
    if (!facts.isAligned) return "align";
    return proposal.wants_confirmation && !facts.isConfirmed ? "confirm" : "insert";
  }
  return isRetraction(proposal, facts) ? "retract" : null;
}

function isRetraction({ axes, ends = [] }: Proposal, { probe, probeAxis }: Facts): boolean {
  const end = ends[0]?.target_counts;
  const probeAlone = axes.length === 1 && axes[0] === probe?.name;
  return probeAlone && end !== undefined && probeAxis !== undefined && end <= probeAxis.minCounts;
}

/** The steps in their order. Exactly one is to be done now. */
export function stepsOf(now: Situation): Step[] {
  const facts = factsOf(now);
  const done = donesOf(facts, now);
  const first = (...names: StepName[]): StepName | undefined => names.find((name) => !done[name]);
  const current =
    (facts.running === undefined ? null : stepOf(facts.running, facts)) ??
    first("case", "home", "register", "target") ??
    (facts.isTreated ? first("retract") : first("review", "align", "confirm", "insert", "treat")) ??
    "end";
  return (Object.keys(stepTitles) as StepName[]).map((name) => ({
    name,
    title: titleOf(name, facts),
    state: name === current ? "now" : done[name] ? "done" : "waits",
    ...writers[name](facts, now, name === current),
  }));
}

function titleOf(name: StepName, { takesBiopsies, ablates }: Facts): string {
  if (name === "treat" && !ablates) return takesBiopsies ? "Biopsy" : "Treatment";
  return stepTitles[name];
}

function donesOf(facts: Facts, { imager }: Situation): Readonly<Record<StepName, boolean>> {
  const { open, alignment, isAligned, isTreated, isOut } = facts;
  return {
    case: open !== undefined,
    home: facts.unhomed.length === 0 && facts.running?.kind !== "home",
    register: facts.isRegistered,
    image: heardIn(open, imager) !== null,
    target: facts.isAimed,
    review: facts.toTarget !== undefined || (isAligned && alignment?.within_tolerance === true),
    align: isAligned,
    confirm: isAligned && facts.isConfirmed,
    insert: facts.isInserted,
    treat: isTreated,
    retract: isTreated && isOut,
    end: false,
  };
}

/** What an imager said last, of what it said since the case was opened. */
function heardIn(
  open: Case | undefined,
  imager: Imager | null,
): NonNullable<Imager["status" | "tip"]> | null {
  const heard = [imager?.status, imager?.tip].filter(
    (each) => each != null && open !== undefined && Date.parse(each.received) >= Date.parse(open.opened.time),
  );
  return heard.reduce<NonNullable<Imager["status" | "tip"]> | null>(
    (newest, each) =>
      each != null && each.age_s < (newest?.age_s ?? Number.POSITIVE_INFINITY) ? each : newest,
    null,
  );
}

type Written = Pick<Step, "words" | "act">;
type Writer = (facts: Facts, now: Situation, isNow: boolean) => Written;

const writers: Readonly<Record<StepName, Writer>> = {
  case({ inHand, open }, { robot }) {
    if (open !== undefined) return { words: `Case ${open.number}: ${open.label} is open.`, act: null };
    if (inHand === undefined)
      return { words: "No case is open. Registration, entry and target belong to one.", act: "open" };
    const words = isOfOtherRobot(inHand, robot.name)
      ? `Case ${inHand.number} belongs to the robot ${inHand.robot}: close it.`
      : `Case ${inHand.number} is suspended: look at what it would put in force, and resume it.`;
    return { words, act: "case" };
  },

  home(facts, now, isNow) {
    const { unhomed, byHand } = facts;
    if (unhomed.length === 0 && !isNow) {
      const hand = byHand === 0 ? "" : `, ${byHand} of them by hand`;
      return { words: `All ${now.motors.length} axes are homed${hand}.`, act: null };
    }
    const running = runningWords(facts, "home");
    if (running !== null && isNow) return { words: running, act: "proposal" };
    const hindered = obstacleOf(now);
    if (hindered !== null) return isNow ? hindered : { ...hindered, act: null };
    const { byPerson, bySwitch } = toHome(now);
    const person =
      byPerson.length === 0
        ? ""
        : ` ${titlesOf(byPerson)}: no switch. Bring to the home position, then press the button, which declares that.`;
    const switches = bySwitch.length === 0 ? "" : ` ${titlesOf(bySwitch)}: homed at the switch.`;
    return { words: `${unhomed.length} axes are not homed.${person}${switches}`, act: isNow ? "home" : null };
  },

  register({ open, isRegistered }, { targeting }) {
    const { registration_doubt, override_reason, registration_problem, registration_state } = targeting;
    if (open === undefined) return { words: "It waits for an open case.", act: "panel" };
    if (isRegistered) {
      const doubt =
        registration_doubt === null ? "" : ` ${registration_doubt} Set all the same: ${override_reason}`;
      return { words: `The registration is valid.${doubt}`, act: "panel" };
    }
    return {
      words: `${registration_problem ?? "It is not valid."} ${registrationAdvice[registration_state]}`.trim(),
      act: "panel",
    };
  },

  image({ open }, { imager }) {
    const heard = heardIn(open, imager);
    const words =
      heard === null
        ? "No imager was heard in this case. The next steps do not need one: points can be typed."
        : `An imager was heard ${formatHeardAge(heard.age_s)} ago. Whether its image is the right one is yours to check.`;
    return { words, act: null };
  },

  target({ open, isAimed }, { targeting }) {
    if (open === undefined) return { words: "It waits for an open case.", act: "panel" };
    if (isAimed) return { words: "Entry and target are set.", act: "panel" };
    const missing = [
      ...(targeting.entry_point === null ? ["Entry"] : []),
      ...(targeting.target_point === null ? ["Target"] : []),
    ];
    return { words: `${missing.join(" and ")} ${missing.length > 1 ? "are" : "is"} not set.`, act: "panel" };
  },

  review({ open, alignment, toTarget }, { view }) {
    if (alignment === null)
      return { words: waitsFor(open, view) ?? "It waits for entry and target.", act: "panel" };
    const { distance_mm, angle_deg } = alignment.deviation;
    const miss = `${fixed(distance_mm, 2)} mm and ${fixed(angle_deg, 2)}°`;
    if (toTarget !== undefined) {
      return {
        words: `Proposal ${toTarget.id} passed its checks. It misses the target by ${miss}.`,
        act: "panel",
      };
    }
    const words = alignment.within_tolerance
      ? `The axes reach the target within ${miss}. Propose the motion; nothing moves yet.`
      : `The axes miss the target by ${miss}, more than the robot's file allows. Set another target, or accept that.`;
    return { words, act: "panel" };
  },

  align(facts, now, isNow) {
    const { open, alignment, away, isAligned } = facts;
    if (alignment === null)
      return { words: waitsFor(open, now.view) ?? "It waits for entry and target.", act: null };
    const miss = alignment.within_tolerance
      ? ""
      : " They miss the target by more than the robot's file allows.";
    if (isAligned) return { words: `Each axis that places the probe is at its setpoint.${miss}`, act: null };
    const running = isNow ? runningWords(facts, "align") : null;
    if (running !== null) return { words: running, act: "proposal" };
    const hindered = isNow ? obstacleOf(now) : null;
    return hindered ?? { words: `Not at the setpoint: ${away.join(", ")}.`, act: isNow ? "panel" : null };
  },

  confirm({ isAligned, isConfirmed }) {
    if (!isAligned) return { words: "It waits until the robot is aligned.", act: null };
    const words = isConfirmed
      ? "You have ticked it, and nothing has moved since."
      : "Take an image, compare it with the target, and tick this. It is cleared when anything moves or is set.";
    return { words, act: null };
  },

  insert(facts, now, isNow) {
    const { probe, probeAxis, depth, isAligned, isInserted, isOut, takesBiopsies } = facts;
    const running = isNow ? runningWords(facts, "insert") : null;
    if (running !== null) return { words: running, act: "proposal" };
    if (probe === undefined || probeAxis === undefined)
      return { words: "No axis is called insertion: see its position in Motors.", act: null };
    if (isInserted) {
      const how = takesBiopsies ? `within ${BIOPSY_WITHIN_MM} mm of` : "at";
      return { words: `The axis ${probe.title} is ${how} the depth that the target asks.`, act: null };
    }
    if (!isAligned || depth === undefined)
      return { words: "It waits until the robot is aligned.", act: null };
    const hindered = isNow ? obstacleOf(now) : null;
    if (hindered !== null) return hindered;
    const left = formatCounts(probe, Math.abs(depth - probeAxis.positionCounts));
    const words = `${isOut ? "The probe is out" : "The probe is between"}: ${left} to the depth that the target asks.`;
    return { words, act: isNow ? (takesBiopsies ? "biopsy" : "insert") : null };
  },

  treat(facts, _, isNow) {
    const { isTreated, isOut, isAligned, ablates } = facts;
    if (isTreated) return { words: "You have ticked that it is done.", act: null };
    const running = isNow ? runningWords(facts, "treat") : null;
    if (running !== null) return { words: running, act: "proposal" };
    const act = ablates ? ("panel" as const) : null;
    if (!isAligned || isOut) return { words: "It waits until the probe is in.", act };
    return { words: "Tick this when it is done: the data do not say so.", act };
  },

  retract(facts, _, isNow) {
    const { probe, probeAxis, isOut } = facts;
    const running = isNow ? runningWords(facts, "retract") : null;
    if (running !== null) return { words: running, act: "retract" };
    if (probe === undefined || probeAxis === undefined)
      return { words: "No axis is called insertion: see its position in Motors.", act: "retract" };
    if (!probeAxis.homed)
      return { words: "Where the probe is, is not known: it is not homed.", act: "retract" };
    if (isOut) return { words: "The probe is out.", act: "retract" };
    const left = formatCounts(probe, Math.abs(probeAxis.positionCounts - probeAxis.minCounts));
    return { words: `The probe is in: ${left} to the outer end.`, act: "retract" };
  },

  end({ inHand }) {
    return inHand === undefined
      ? { words: "No case is open.", act: null }
      : { words: "Set another entry and target above, or close the case.", act: "close" };
  },
};

/** Why there is no alignment; null when that is not known. */
function waitsFor(open: Case | undefined, { alignment_problem }: AlignmentView): string | null {
  return open === undefined ? "It waits for an open case." : (alignment_problem?.text ?? null);
}

/** What the open proposal of that step waits for; null without one. */
function runningWords(facts: Facts, name: StepName): string | null {
  const { running } = facts;
  if (running === undefined || stepOf(running, facts) !== name) return null;
  const { id, state } = running;
  if (running.wants_confirmation === true)
    return `Proposal ${id} waits: confirm its insertion, then press the pedal.`;
  if (state === "checked" || state === "drafted") return `Proposal ${id} waits: look at it, and approve it.`;
  if (state === "executing") return `Proposal ${id} runs while the pedal is held.`;
  return `Proposal ${id} is ${state}: press the pedal and hold it.`;
}

/** Why no axis can be moved now. */
function obstacleOf({ mode, motors, axes }: Situation): Written | null {
  const inState = (state: string): readonly Motor[] => motors.filter((_, at) => axes[at]?.state === state);
  const faulted = inState("FAULTED");
  if (faulted.length > 0)
    return { words: `Faulted: ${titlesOf(faulted)}. Remove the cause, and clear the fault.`, act: "motors" };
  if (mode === "LOCKED" || mode === "INIT")
    return { words: "The system is locked: unlock it when its cause is gone.", act: "ready" };
  const disabled = inState("DISABLED");
  return disabled.length === 0 ? null : { words: `Not enabled: ${titlesOf(disabled)}.`, act: "ready" };
}

/** Axes that are not homed: those that a person brings home, and those that find it at their switch. */
export function toHome({ motors, axes }: Pick<Situation, "motors" | "axes">) {
  const unhomed = motors.filter((_, at) => axes[at]?.homed !== true);
  return {
    byPerson: unhomed.filter(({ has_switch }) => !has_switch),
    bySwitch: unhomed.filter(({ has_switch }) => has_switch),
  };
}

function titlesOf(motors: readonly Motor[]): string {
  return motors.map(({ title }) => title).join(", ");
}

/** Why a tick cannot be made now; null when it can. */
export function reasonAgainstTick(now: Situation, name: TickName): string | null {
  const { isAligned, isOut, probe } = factsOf(now);
  if (!isAligned) return "The robot is not aligned with the target.";
  return name === "treat" && probe !== undefined && isOut ? "The probe is out." : null;
}

/** What is ticked now. */
export function tickOf({ targeting, axes }: Pick<Situation, "targeting" | "axes">): Tick {
  const { case: number, registration, registration_state, ignore_registration_rotation } = targeting;
  const { entry_point, target_point } = targeting;
  return {
    about: JSON.stringify([
      ...[number, registration, registration_state, ignore_registration_rotation],
      ...[entry_point, target_point],
    ]),
    counts: axes.map(({ positionCounts }) => positionCounts),
  };
}

/**
 * The ticks that still hold. Any motion ends that an image was confirmed; that a treatment is done is ended by whatever brings
 * the probe elsewhere: taking it out does not.
 */
export function heldTicks(ticks: Ticks, motors: readonly Motor[], now: Tick): Ticks {
  const holds = (tick: Tick | null, isFree: (motor: Motor) => boolean): boolean =>
    tick !== null &&
    tick.about === now.about &&
    motors.every(
      (motor, at) =>
        isFree(motor) || Math.abs((now.counts[at] ?? 0) - (tick.counts[at] ?? 0)) <= slack(motor),
    );
  const confirm = holds(ticks.confirm, () => false) ? ticks.confirm : null;
  const treat = holds(ticks.treat, ({ name }) => alongProbe.has(name)) ? ticks.treat : null;
  return confirm === ticks.confirm && treat === ticks.treat ? ticks : { confirm, treat };
}

/** Of several questions, the one whose answer is the oldest: no step is newer than that. */
export function oldest(asked: readonly Asked[]): Asked | undefined {
  const age = ({ answeredAtMs, everyMs }: Asked): number =>
    answeredAtMs === null ? Number.NEGATIVE_INFINITY : answeredAtMs + everyMs;
  return [...asked].sort((one, other) => age(one) - age(other))[0];
}

import { describe, expect, it } from "vitest";
import type { Case, Motor, Proposal, Robot, Targeting } from "../../api/client";
import {
  type AxisNow,
  heldTicks,
  oldest,
  reasonAgainstTick,
  type Situation,
  type Step,
  type StepName,
  stepsOf,
  type Ticks,
  tickOf,
} from "./workflow";

const motor = (name: string, has_switch = true): Motor =>
  ({ name, title: name, unit: "mm", counts_per_unit: 10, deadband_counts: 1, has_switch }) as Motor;
const motors = [motor("yaw"), motor("probe_rotation", false), motor("insertion")];
const axis = (positionCounts: number, more: Partial<AxisNow> = {}): AxisNow => ({
  ...{ state: "ENABLED", homed: true, homedByHand: false, positionCounts, minCounts: 0 },
  ...more,
});
const at = (yaw: number, insertion: number): AxisNow[] => [axis(yaw), axis(0), axis(insertion)];

const pose = (x: number): number[] => [1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
const deviation = { offset_mm: [0, 0, 0], distance_mm: 0.02, angle_deg: 0.01 };
const noBudget = { error_budget: null, error_budget_problem: null };
const alignment = {
  ...noBudget,
  ...{ desired: pose(1), reachable: pose(1), reachable_tip: [0, 0, 0], clamped: [], cannula_length_mm: null },
  setpoints: {
    yaw: { counts: -50, position: -5 },
    probe_rotation: { counts: 700, position: 70 },
    insertion: { counts: 200, position: 20 },
  },
  ...{ deviation, within_tolerance: true },
};
const open = {
  ...{ number: 3, label: "phantom", state: "open", robot: "neuro" },
  opened: { time: "2026-01-01T10:00:00Z", user: "ann" },
} as Case;
const targeting = {
  ...{ case: 3, registration: pose(0), registration_state: "valid", ignore_registration_rotation: false },
  ...{ registration_problem: null, registration_doubt: null, override_reason: null },
  ...{ entry_point: [0, 0, 0], target_point: [0, 0, 9] },
} as unknown as Targeting;
const none: Ticks = { confirm: null, treat: null };
const imager = (received: string): Situation["imager"] => ({
  status: { code: 1, name: "", text: "", client: "a:1", received, age_s: 4 },
  tip: null,
});

/** A robot that is homed and away from its target, in an open case with everything set. */
const ready: Situation = {
  robot: { name: "neuro", modes: ["manual", "home", "coordinated", "ablation"] } as unknown as Robot,
  ...{ motors, axes: at(0, 0), mode: "READY", cases: [open], targeting },
  view: { alignment, alignment_problem: null } as unknown as Situation["view"],
  ...{ imager: null, proposals: [], ticks: none },
};
const withAxes = (axes: AxisNow[], more: Partial<Situation> = {}): Situation => ({ ...ready, axes, ...more });
const ticked = (now: Situation, ...names: (keyof Ticks)[]): Situation => ({
  ...now,
  ticks: { ...none, ...Object.fromEntries(names.map((name) => [name, tickOf(now)])) },
});
const proposal = (more: Partial<Proposal>): Proposal =>
  ({
    ...{ id: 9, kind: "path", mode: "coordinated", state: "checked", aim: null, axes: ["yaw"], ends: [] },
    ...more,
  }) as Proposal;
const toTarget = (state: Proposal["state"], more: Partial<Proposal> = {}): Proposal =>
  proposal({ state, aim: { desired: pose(1), reachable: pose(1), deviation, ...noBudget }, ...more });

const nowOf = (situation: Situation): StepName | undefined =>
  stepsOf(situation).find(({ state }) => state === "now")?.name;
const stepIn = (situation: Situation, name: StepName): Step => {
  const found = stepsOf(situation).find((step) => step.name === name);
  if (found === undefined) throw new Error(name);
  return found;
};

describe("the step that is to be done now", () => {
  const closed = { ...open, state: "closed" } as Case;
  const suspended = { ...open, state: "suspended" } as Case;
  const unset = (more: Partial<Targeting>): Partial<Situation> => ({ targeting: { ...targeting, ...more } });
  const noAlignment = {
    view: { alignment: null, alignment_problem: { code: "NO_TARGET", text: "No target is set." } },
  } as Partial<Situation>;
  const unhomed = [axis(0, { homed: false }), axis(0), axis(0)];
  it.each<[StepName, Situation]>([
    ["case", { ...ready, cases: [closed] }],
    ["case", { ...ready, cases: [suspended] }],
    ["case", { ...ready, cases: [{ ...open, robot: "prostate" }] }],
    ["home", withAxes(unhomed)],
    ["register", { ...ready, ...unset({ registration_state: "expired" }), ...noAlignment }],
    ["target", { ...ready, ...unset({ entry_point: null }), ...noAlignment }],
    ["review", ready],
    ["align", { ...ready, proposals: [toTarget("checked")] }],
    ["align", { ...ready, proposals: [toTarget("executing")] }],
    ["review", { ...ready, proposals: [toTarget("aborted")] }],
    ["align", { ...ready, proposals: [toTarget("done")] }],
    ["confirm", withAxes(at(-51, 0))],
    ["insert", ticked(withAxes(at(-50, 0)), "confirm")],
    ["insert", withAxes(at(-50, 90), { proposals: [toTarget("paused")] })],
    ["confirm", withAxes(at(-50, 0), { proposals: [toTarget("paused", { wants_confirmation: true })] })],
    [
      "insert",
      ticked(
        withAxes(at(-50, 0), { proposals: [toTarget("paused", { wants_confirmation: true })] }),
        "confirm",
      ),
    ],
    ["confirm", withAxes(at(-50, 200), { proposals: [toTarget("done")] })],
    ["treat", ticked(withAxes(at(-50, 200)), "confirm")],
    ["treat", withAxes(at(-50, 170), { proposals: [proposal({ mode: "ablation", state: "executing" })] })],
    ["retract", ticked(withAxes(at(-50, 200)), "treat")],
    ["end", ticked(withAxes(at(-50, 0)), "treat")],
  ])("is %s", (name, situation) => {
    expect(nowOf(situation)).toBe(name);
    expect(stepsOf(situation).filter(({ state }) => state === "now")).toHaveLength(1);
    expect(stepsOf(situation)).toHaveLength(12);
  });

  it("is the retraction whatever else is open to be done, once it is proposed", () => {
    const out = proposal({ axes: ["insertion"], ends: [{ slot: 2, target_counts: 0 }] });
    expect(nowOf(withAxes(at(-50, 200), { proposals: [out] }))).toBe("retract");
    expect(nowOf(withAxes(at(-50, 200), { proposals: [{ ...out, axes: ["yaw"] }] }))).toBe("confirm");
  });
});

describe("what a step claims", () => {
  it("is no home while the motion that brings the robot there has not ended", () => {
    const homing = proposal({ kind: "home", state: "paused" });
    expect(stepIn({ ...ready, proposals: [homing] }, "home").state).toBe("now");
  });

  it("is no alignment while one axis is off, not homed, or the case not open", () => {
    expect(stepIn(withAxes(at(-53, 0)), "align").state).toBe("waits");
    const lost = withAxes([axis(-50, { homed: false }), axis(0), axis(0)]);
    expect(stepIn(lost, "align").state).toBe("waits");
    const suspended = withAxes(at(-50, 0), { cases: [{ ...open, state: "suspended" } as Case] });
    expect(stepIn(suspended, "align").words).toBe("It waits for an open case.");
    expect(stepIn(suspended, "register").state).toBe("waits");
  });

  it("is no insertion unless the robot is aligned, too", () => {
    expect(stepIn(withAxes(at(0, 200)), "insert").state).toBe("waits");
    expect(stepIn(withAxes(at(-50, 200)), "insert").state).toBe("done");
    expect(stepIn(withAxes(at(-50, 197)), "insert")).toMatchObject({ state: "waits" });
  });

  it("is no review by a motion to another target", () => {
    const elsewhere = toTarget("checked", {
      aim: { desired: pose(2), reachable: pose(2), deviation, ...noBudget },
    });
    expect(stepIn({ ...ready, proposals: [elsewhere] }, "review").state).not.toBe("done");
  });

  it("says by how much the target is missed where that is too much", () => {
    const missed = { ...alignment, within_tolerance: false, deviation: { ...deviation, distance_mm: 27 } };
    const view = { ...ready.view, alignment: missed };
    expect(stepIn({ ...ready, view }, "review").words).toContain("miss the target by 27.00 mm and 0.01°");
    expect(stepIn(withAxes(at(-50, 0), { view }), "review").state).not.toBe("done");
    expect(stepIn(withAxes(at(-50, 0), { view }), "align").words).toContain("miss the target by more");
  });

  it("is an imager that was heard since the case was opened, and none before", () => {
    expect(stepIn({ ...ready, imager: imager("2026-01-01T09:59:59Z") }, "image").state).toBe("waits");
    const heard = stepIn({ ...ready, imager: imager("2026-01-01T10:00:01Z") }, "image");
    expect(heard).toMatchObject({ state: "done" });
    expect(heard.words).toContain("4.0 s ago");
  });

  it("is no retraction before anything was ticked", () => {
    expect(stepIn(ready, "retract")).toMatchObject({ state: "waits", words: "The probe is out." });
    const unknown = withAxes([axis(0), axis(0), axis(0, { homed: false })]);
    expect(stepIn(unknown, "retract").words).toContain("not known");
  });

  it("names what keeps the axes from moving", () => {
    const off = at(0, 0).map((each) => ({ ...each, state: "DISABLED" as const, homed: false }));
    const locked = stepIn(withAxes(off, { mode: "LOCKED" }), "home");
    expect(locked).toMatchObject({ state: "now", act: "ready" });
    expect(stepIn(withAxes(off), "home").words).toBe("Not enabled: yaw, probe_rotation, insertion.");
    const faulted = withAxes([axis(0, { state: "FAULTED", homed: false }), axis(0), axis(0)]);
    expect(stepIn(faulted, "home")).toMatchObject({ act: "motors" });
    const unhomed = at(0, 0).map((each) => ({ ...each, homed: false }));
    const home = stepIn(withAxes(unhomed), "home");
    expect(home.act).toBe("home");
    expect(home.words).toContain("probe_rotation: no switch.");
  });

  it("follows the robot's modes", () => {
    const prostate = { ...ready.robot, modes: ["manual", "cooperative_biopsy"] };
    const situation = ticked(withAxes(at(-50, 185), { robot: prostate }), "confirm");
    expect(stepIn(situation, "treat").title).toBe("Biopsy");
    expect(stepIn(situation, "insert").words).toContain("within 2 mm of");
    expect(nowOf(situation)).toBe("treat");
    const before = ticked(withAxes(at(-50, 0), { robot: prostate }), "confirm");
    expect(stepIn(before, "insert").act).toBe("biopsy");
    expect(stepIn(before, "treat").act).toBeNull();
  });
});

describe("ticks", () => {
  const inserted = withAxes(at(-50, 200));
  const both = { confirm: tickOf(inserted), treat: tickOf(inserted) };
  const held = (now: Situation): (keyof Ticks)[] => {
    const ticks = heldTicks(both, motors, tickOf(now));
    return (["confirm", "treat"] as const).filter((name) => ticks[name] !== null);
  };

  it("hold while nothing changes but the trembling of an encoder", () => {
    expect(heldTicks(both, motors, tickOf(withAxes(at(-51, 201))))).toBe(both);
  });

  it("end when case, registration or target changes", () => {
    for (const more of [
      { case: 4 },
      { registration: pose(1) },
      { registration_state: "expired" as const },
      { ignore_registration_rotation: true },
      { entry_point: [1, 0, 0] },
      { target_point: [0, 0, 8] },
    ])
      expect(held({ ...inserted, targeting: { ...targeting, ...more } })).toEqual([]);
  });

  it("end when the probe moves; that the treatment is done outlives taking the probe out alone", () => {
    expect(held(withAxes(at(-50, 190)))).toEqual(["treat"]);
    expect(held(withAxes(at(-40, 200)))).toEqual([]);
  });

  it("cannot be made away from the target, or of a treatment with the probe out", () => {
    expect(reasonAgainstTick(ready, "confirm")).toContain("not aligned");
    expect(reasonAgainstTick(withAxes(at(-50, 0)), "confirm")).toBeNull();
    expect(reasonAgainstTick(withAxes(at(-50, 0)), "treat")).toBe("The probe is out.");
    expect(reasonAgainstTick(inserted, "treat")).toBeNull();
  });
});

describe("oldest", () => {
  it("is the question whose answer is due first, one without an answer before all", () => {
    const asked = (answeredAtMs: number | null, everyMs: number) => ({ answeredAtMs, everyMs });
    expect(oldest([asked(900, 250), asked(500, 1000)])).toEqual(asked(900, 250));
    expect(oldest([asked(900, 250), asked(null, 1000)])).toEqual(asked(null, 1000));
    expect(oldest([])).toBeUndefined();
  });
});

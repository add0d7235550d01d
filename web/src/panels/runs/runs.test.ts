import { describe, expect, it } from "vitest";
import type { ListedRun, RunAxis, RunSamples } from "../../api/client";
import {
  type Drawn,
  filterOf,
  type Known,
  largestError,
  noFilter,
  queryOf,
  runSheet,
  titleOf,
  valuesAt,
  wholeNumber,
  withNewest,
  withOlder,
} from "./runs";

const lateral: RunAxis = {
  slot: 4,
  axis: "lateral",
  title: "Lateral",
  unit: "mm",
  counts_per_unit: 100,
  begin_counts: 0,
  target_counts: -300,
  end_counts: -299,
  largest_error_counts: 12,
  rms_error_counts: 4.5,
};
const yaw: RunAxis = {
  ...lateral,
  ...{ slot: 0, axis: "yaw", title: "Yaw", unit: "rad", counts_per_unit: -1800 / Math.PI },
};

const page = (ids: readonly number[], more: boolean): Known => ({
  runs: ids.map((id) => ({ id }) as ListedRun),
  more,
});
const idsOf = ({ runs, more }: Known): unknown[] => [...runs.map(({ id }) => id), more];

describe("the list", () => {
  it("drops what has gone from the newest page, and keeps the older pages", () => {
    const known = withOlder(page([9, 8, 7], true), page([6, 5], false));
    expect(idsOf(withNewest(known, page([10, 9, 7], true)))).toEqual([10, 9, 7, 6, 5, false]);
  });

  it("has nothing older than a newest page that is all there is", () => {
    expect(idsOf(withNewest(page([9, 8, 7, 6], false), page([9, 8], false)))).toEqual([9, 8, false]);
  });

  it("asks for what was chosen, and for no case as for case 0", () => {
    expect(queryOf(noFilter)).toEqual({});
    expect(queryOf(filterOf("case=0&outcome=done&kind="), 7)).toEqual({
      case: 0,
      outcome: "done",
      before: 7,
    });
  });
});

describe("words", () => {
  it("name what was moved, and where to", () => {
    expect(titleOf({ kind: "move", mode: "manual", axes: [lateral] })).toBe("Lateral to -3.00\u00a0mm");
    expect(titleOf({ kind: "path", mode: "conformal_ablation", axes: [lateral, yaw] })).toBe(
      "Conformal ablation: Lateral, Yaw",
    );
    expect(titleOf({ kind: "move", mode: "manual", axes: [{ ...lateral, target_counts: null }] })).toBe(
      "Jog Lateral",
    );
  });

  it("say the largest error of each unit without a sign, and nothing where there is none", () => {
    const worse = { ...lateral, largest_error_counts: 45 };
    expect(largestError([lateral, yaw, worse])).toBe("0.45\u00a0mm, 1.2°");
    expect(largestError([{ ...lateral, largest_error_counts: null }])).toBeNull();
  });

  it("refuse a number with what was expected", () => {
    expect(wholeNumber("Runs", " 20 ", [20, 100])).toBe(20);
    expect(wholeNumber("Runs", "1e2", [20, 100])).toBe(
      "Runs: “1e2” does not fit; expected a whole number from 20 to 100.",
    );
    expect(wholeNumber("Runs", "101", [20, 100])).toContain("“101” does not fit");
  });
});

describe("what is drawn", () => {
  const samples = (plan: RunSamples["plan"]): RunSamples => ({
    id: 7,
    times_s: [0, 1, 3],
    buckets_of_sample: 1,
    axes: [{ slot: 4, commanded_counts: [-300, -300, null], actual_counts: [0, -100, -300] }],
    plan,
  });
  const timed = {
    basis: "time" as const,
    why: null,
    times_s: [0, 2],
    axes: [{ slot: 4, positions_counts: [0, -300] }],
  };
  const untimed = { basis: "way" as const, why: null, times_s: [], axes: [] };
  const drawn = (id: number, plan: RunSamples["plan"]): Drawn => ({
    run: { id, axes: [lateral] },
    samples: samples(plan),
  });
  const lines = (...of: Parameters<typeof runSheet>) =>
    runSheet(...of).charts.map(({ title, lines: all }) => [
      title,
      ...all.map((line) => [line.label, line.least]),
    ]);

  it("is the plan, at rest after its end, and where the axis was, over one time", () => {
    expect(runSheet(drawn(7, timed), null, new Set(), false).timeS).toEqual([0, 1, 2, 3]);
    expect(lines(drawn(7, timed), null, new Set(), true)).toEqual([
      ["Lateral", ["planned", [0, -1.5, -3, -3]], ["actual", [0, -1, -2, -3]]],
      ["Lateral: deviation", ["actual less planned", [0, 0.5, 1, 0]]],
    ]);
  });

  it("is what was commanded where nothing was planned in time, and only as long as it was", () => {
    expect(lines(drawn(7, untimed), null, new Set(), false)).toEqual([
      ["Lateral", ["commanded", [-3, -3, null]], ["actual", [0, -1, -3]]],
    ]);
  });

  it("has the lines of both runs by their numbers, and no axis that is hidden", () => {
    const [[, ...both] = []] = lines(drawn(7, timed), drawn(5, untimed), new Set(), false);
    expect(both.map(([label]) => label)).toEqual(["planned #7", "actual #7", "commanded #5", "actual #5"]);
    expect(lines(drawn(7, timed), null, new Set(["lateral"]), false)).toEqual([]);
  });

  it("bridges no gap", () => {
    expect(valuesAt([0, 1, 2], [5, null, 7], [0, 0.5, 1, 1.5, 2])).toEqual([5, null, null, null, 7]);
    expect(valuesAt([1], [5], [0, 1, 2])).toEqual([null, 5, null]);
  });
});

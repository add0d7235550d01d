import { describe, expect, it } from "vitest";
import type { AxisProfile, Motor } from "../../api/client";
import { curvesOf, HEIGHT, type Profile, WIDTH } from "./profile";

const motor = { slot: 4, title: "Lateral", unit: "mm", counts_per_unit: 10 } as Motor;

const timed: AxisProfile = {
  slot: 4,
  homed: true,
  lowest_setpoint_counts: -90,
  highest_setpoint_counts: -10,
  soft_min_counts: -100,
  soft_max_counts: 0,
  velocity_limit_counts_per_s: 60,
  drive_limit: 1000,
  lowest_counts: -80,
  highest_counts: -20,
  fastest_counts_per_s: 59.5,
  positions_counts: [-20, -50, -80],
  velocities_counts_per_s: [0, -59.5, 0],
  drives: [],
};

const overTime: Profile = { basis: "time", why: null, times_s: [0, 1, 2], axes: [timed] };

function pairs(points: string): number[][] {
  return points.split(" ").map((pair) => pair.split(",").map(Number));
}

describe("curvesOf a path", () => {
  const [position, velocity] = curvesOf(overTime, timed, motor);

  it("runs from the start to the end of the time, downwards where positions fall", () => {
    const drawn = pairs(position?.points ?? "");
    expect(drawn.map(([x]) => x)).toEqual([0, WIDTH / 2, WIDTH]);
    const heights = drawn.map(([, y]) => y ?? 0);
    expect(heights[0]).toBeLessThan(heights[1] ?? 0);
    expect(heights[1]).toBeLessThan(heights[2] ?? 0);
    expect(position?.ends).toEqual(["0.0 s", "2.0 s"]);
  });

  it("has the soft limits outside of the band of setpoints, and all of it inside of the drawing", () => {
    const [top = 0, bottom = 0] = position?.band ?? [];
    const [low = 0, high = 0] = position?.limits ?? [];
    expect(high).toBeLessThan(top);
    expect(low).toBeGreaterThan(bottom);
    expect(high).toBeGreaterThan(0);
    expect(low).toBeLessThan(HEIGHT);
  });

  it("says in words what it shows", () => {
    expect(position?.words).toBe("-2.0\u00a0mm to -8.0\u00a0mm, allowed -9.0 to -1.0\u00a0mm");
    expect(velocity?.words).toBe("at most 6.0 mm/s of 6.0 mm/s");
  });

  it("tells one that leaves its limits from one that keeps to them", () => {
    expect([position?.within, velocity?.within]).toEqual([true, true]);
    const [far, fast] = curvesOf(
      overTime,
      { ...timed, lowest_counts: -101, fastest_counts_per_s: 61 },
      motor,
    );
    expect([far?.within, fast?.within]).toEqual([false, false]);
    const [beyond] = curvesOf(overTime, { ...timed, positions_counts: [-20, -50, -95] }, motor);
    expect(beyond?.within).toBe(false);
  });

  it("draws no soft limits of an axis that is not homed", () => {
    const [unhomed] = curvesOf(overTime, { ...timed, homed: false, lowest_counts: -101 }, motor);
    expect(unhomed?.limits).toEqual([]);
    expect(unhomed?.within).toBe(true);
  });
});

describe("curvesOf a move of one axis", () => {
  const axis: AxisProfile = {
    ...timed,
    velocity_limit_counts_per_s: null,
    fastest_counts_per_s: 0,
    velocities_counts_per_s: [],
    drives: [500, 250, 0],
  };
  const [drive] = curvesOf({ basis: "way", why: null, times_s: [], axes: [axis] }, axis, motor);

  it("has its drive over its positions, below the bound", () => {
    const drawn = pairs(drive?.points ?? "");
    expect(drawn[0]?.[0]).toBeGreaterThan(drawn[2]?.[0] ?? 0);
    expect(drawn[0]?.[1]).toBeGreaterThan(drive?.limits[0] ?? HEIGHT);
    expect(drawn[2]?.[1]).toBe(HEIGHT);
    expect(drive?.words).toContain("drive up to 50 % of the axis' bound");
    expect(drive?.overWay).toBe(true);
  });

  it("has no curve where nothing is planned", () => {
    expect(curvesOf({ basis: "none", why: "Homing.", times_s: [], axes: [] }, axis, motor)).toEqual([]);
  });
});

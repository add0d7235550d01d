import { describe, expect, it } from "vitest";
import { ageWords, changeWords, sourceWords } from "./history";

const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

describe("changeWords", () => {
  it("say what each field is and what it was", () => {
    const words = changeWords({
      old: { target_point: null, robot_to_entry_offset: 5, canula_to_treatment_offset: 1 },
      new: { target_point: [5, 200, -0.001], robot_to_entry_offset: 6, canula_to_treatment_offset: 2 },
    });
    expect(words).toEqual(["Target 5.00, 200.00, 0.00, was not set", "B 6.00, was 5.00"]);
  });

  it("say how far a registration moved and turned", () => {
    const turned = [0, -1, 0, 3, 1, 0, 0, 4, 0, 0, 1, 0, 0, 0, 0, 1];
    expect(changeWords({ old: { registration: identity }, new: { registration: turned } })).toEqual([
      "Registration with its origin at 3.00, 4.00, 0.00, moved by 5.00 mm, turned by 90.00°",
    ]);
    expect(
      changeWords({
        old: { registration_problem: null },
        new: { registration_problem: "The registration has expired: The table moved." },
      }),
    ).toEqual(["The registration has expired: The table moved."]);
    expect(
      changeWords({
        old: { ignore_registration_rotation: false },
        new: { ignore_registration_rotation: true },
      }),
    ).toEqual(["Rotation of the registration ignored"]);
  });

  it("say how well a registration fits, and nothing of a fit that is not known", () => {
    const fit = { residual_mm: 0.4, fiducials: 7 };
    const none = { residual_mm: null, fiducials: null };
    expect(changeWords({ old: none, new: fit })).toEqual([
      "Fit of the registration: residual 0.40 mm, 7 fiducials",
    ]);
    expect(changeWords({ old: fit, new: none })).toEqual([]);
  });

  it("say that the accuracy of images changed", () => {
    const one = [0.1, 0, 0, 0, 0.1, 0, 0, 0, 0.1];
    expect(
      changeWords({ old: { target_covariance_mm2: null }, new: { target_covariance_mm2: one } }),
    ).toEqual(["Covariance of the target: set"]);
    expect(
      changeWords({ old: { target_covariance_mm2: one }, new: { target_covariance_mm2: null } }),
    ).toEqual(["Covariance of the target: none"]);
    expect(changeWords({ old: { fiducial_points: [] }, new: { fiducial_points: [[], [], []] } })).toEqual([
      "Points of its fiducials: 3",
    ]);
  });

  it("say how many targets are planned", () => {
    expect(changeWords({ old: { planned_targets: [] }, new: { planned_targets: [{}, {}] } })).toEqual([
      "Planned targets: 2",
    ]);
  });
});

describe("sourceWords", () => {
  it("name the way and the address", () => {
    expect(sourceWords({ source: "openigtlink", client: "openigtlink 10.0.0.5:40312" })).toBe(
      "OpenIGTLink, 10.0.0.5:40312",
    );
    expect(sourceWords({ source: "console", client: "127.0.0.1:5000" })).toBe("console, 127.0.0.1:5000");
  });
});

describe("ageWords", () => {
  it.each([
    ["2026-01-01T00:00:00.000Z", "2026-01-01T00:00:12.900Z", "12 s ago"],
    ["2026-01-01T00:00:00.000Z", "2026-01-01T00:59:59.000Z", "59 min ago"],
    ["2026-01-01T00:00:00.000Z", "2026-01-01T23:00:00.000Z", "23 h ago"],
    ["2026-01-01T00:00:00.000Z", "2026-01-03T00:00:00.000Z", "2 d ago"],
    ["2026-01-01T00:00:01.000Z", "2026-01-01T00:00:00.000Z", "0 s ago"],
    ["", "2026-01-01T00:00:00.000Z", "at an unknown time"],
  ])("from %s to %s", (time, now, words) => {
    expect(ageWords(time, now)).toBe(words);
  });
});

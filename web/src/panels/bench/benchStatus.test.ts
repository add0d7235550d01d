import { describe, expect, it } from "vitest";
import { plantStatus } from "./benchStatus";

const sound = {
  pedalNo: "free",
  pedalNc: "free",
  estopPulled: false,
  axes: [],
  inputs: [],
  unpowered: new Set(),
};

describe("plantStatus", () => {
  it("reads the faults of pedal, E-stop, axes and cards", () => {
    const status = plantStatus({
      ok: true,
      pedal: { pressed: true, no: "open", nc: "free" },
      estop: { pulled: true, loop_closed: false },
      axes: [
        { slot: 0, jammed: false, reversed: true, counts_per_tick: 2, encoder: "stuck", has_switch: true },
        {
          slot: 3,
          jammed: true,
          switch: "triggered",
          has_switch: false,
          parameters: { lag_ms: 12.5, coast_counts: 12.5 },
          parameters_changed: true,
        },
      ],
      cards: [
        { slot: 0, powered: true },
        { slot: 3, powered: false },
      ],
    });
    expect(status).toMatchObject({ pedalNo: "open", pedalNc: "free", estopPulled: true });
    expect(status.axes[0]).toEqual({
      slot: 0,
      jammed: false,
      reversed: true,
      runawayCountsPerTick: 2,
      encoder: "stuck",
      switchState: "normal",
      hasSwitch: true,
      parameters: {},
      parametersChanged: false,
    });
    expect(status.axes[1]).toMatchObject({ slot: 3, jammed: true, switchState: "triggered" });
    expect(status.axes[1]).toMatchObject({
      parameters: { lag_ms: 12.5, coast_counts: 12.5 },
      parametersChanged: true,
    });
    expect([...status.unpowered]).toEqual([3]);
  });

  it("lists every connected input of the sensor cards", () => {
    const sensors = [{ slot: 3, name: "force", inputs: [{ adc: 2, counts: 1970, force_counts: 40 }] }];
    expect(plantStatus({ sensors }).inputs).toEqual([{ slot: 3, adc: 2, name: "force", forceCounts: 40 }]);
  });

  it.each([
    [undefined],
    [null],
    ["status"],
    [{}],
    [{ axes: 3, cards: {}, sensors: [{ slot: 1, inputs: 7 }] }],
    [{ axes: [null, 3, {}, { jammed: true }], cards: [{ powered: false }] }],
  ])("takes %j for a sound plant", (answer) => {
    expect(plantStatus(answer)).toEqual(sound);
  });
});

import { describe, expect, it } from "vitest";
import { jammedSlots } from "./benchStatus";

describe("jammedSlots", () => {
  it("lists the jammed axes", () => {
    const axes = [
      { slot: 0, jammed: false },
      { slot: 3, jammed: true },
      { slot: 7, jammed: true },
    ];
    expect([...jammedSlots({ ok: true, axes })]).toEqual([3, 7]);
  });

  it.each([
    [undefined],
    [null],
    ["status"],
    [{}],
    [{ axes: 3 }],
    [{ axes: [null, 3, {}, { jammed: true }] }],
  ])("is empty for %j", (status) => {
    expect(jammedSlots(status).size).toBe(0);
  });
});

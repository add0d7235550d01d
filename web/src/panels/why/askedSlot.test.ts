import { describe, expect, it } from "vitest";
import type { Motor, Proposal } from "../../api/client";
import { askedSlot } from "./askedSlot";

const motors = [
  { slot: 3, name: "insertion" },
  { slot: 4, name: "lateral" },
] as Motor[];
const proposal = (state: Proposal["state"], ...axes: string[]): Proposal => ({ state, axes }) as Proposal;

describe("askedSlot", () => {
  it("is the axis that was chosen, as long as the robot has it", () => {
    expect(askedSlot(4, [], motors)).toBe(4);
    expect(askedSlot(9, [], motors)).toBe(3);
  });

  it("is that of the newest open proposal while none was chosen", () => {
    expect(askedSlot(null, [proposal("done", "insertion"), proposal("paused", "lateral")], motors)).toBe(4);
    expect(askedSlot(null, [proposal("done", "lateral")], motors)).toBe(3);
  });

  it("is none without axes", () => {
    expect(askedSlot(null, [], [])).toBeNull();
  });
});

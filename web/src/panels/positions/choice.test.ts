import { expect, it } from "vitest";
import type { PositionsComparison } from "../../api/client";
import { axesThatDiffer } from "./choice";

it("proposes to set the axes that differ and may be set", () => {
  const row = (axis: string, now_counts: number, saved_counts: number, restorable: boolean) =>
    ({ axis, now_counts, saved_counts, restorable }) as PositionsComparison["axes"][number];
  const axes = [row("yaw", 0, 10, true), row("pitch", 5, 5, true), row("head", 0, 99999, false)];
  expect([...axesThatDiffer(axes)]).toEqual(["yaw"]);
});

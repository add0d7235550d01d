import { describe, expect, it } from "vitest";
import {
  codeHash,
  codeOf,
  motionHash,
  motionOf,
  proposalHash,
  proposalOf,
  routeOf,
  runHash,
  runOf,
} from "./route";

describe("routeOf", () => {
  it.each([
    ["", "robot"],
    ["#/robot", "robot"],
    ["#/plots", "plots"],
    ["#/tuning", "tuning"],
    ["#/view", "view"],
    ["#/workflow", "workflow"],
    ["#/workflow/7", "robot"],
    ["#/users", "users"],
    ["#audit", "audit"],
    ["#/account", "account"],
    ["#/nowhere", "robot"],
    ["#/users/7", "robot"],
    ["#/proposals", "proposals"],
    ["#/proposals/7", "proposals"],
    ["#/view/7", "view"],
    ["#/proposals/ablation", "proposals"],
    ["#/proposals/x", "robot"],
    ["#/proposals/7/8", "robot"],
    ["#/plots/7", "robot"],
    ["#/runs", "runs"],
    ["#/runs/7", "runs"],
    ["#/runs/7/5", "runs"],
    ["#/runs/x", "robot"],
    ["#/codes", "codes"],
    ["#/codes/verdict/RANGE", "codes"],
  ])("%j is the page %s", (hash, route) => {
    expect(routeOf(hash)).toBe(route);
  });
});

describe("codeOf", () => {
  it("finds the code that a link leads to", () => {
    expect(codeOf(codeHash("verdict", "RANGE"))).toEqual({ family: "verdict", code: "RANGE" });
  });

  it.each(["#/codes", "#/codes/verdict", "#/codes/verdict/NOTHING", "#/codes/toString/RANGE", "#/users"])(
    "finds none in %j",
    (hash) => {
      expect(codeOf(hash)).toBeNull();
    },
  );
});

describe("proposalOf", () => {
  it("finds the proposal that a link leads to, on either page", () => {
    expect(proposalOf(proposalHash("proposals", 12))).toBe(12);
    expect(proposalOf(proposalHash("view", 3))).toBe(3);
  });

  it.each(["#/proposals", "#/proposals/0", "#/proposals/-1", "#/proposals/1e3", "#/users/7"])(
    "finds none in %j",
    (hash) => {
      expect(proposalOf(hash)).toBeNull();
    },
  );
});

describe("motionOf", () => {
  it("finds the form that a link leads to", () => {
    expect(motionOf(motionHash("ablation"))).toBe("ablation");
  });

  it.each(["#/proposals", "#/proposals/sweep", "#/proposals/ablation/1", "#/view/ablation"])(
    "finds none in %j",
    (hash) => {
      expect(motionOf(hash)).toBeNull();
    },
  );
});

describe("runOf", () => {
  it("finds the run that a link leads to, and the one beside it", () => {
    expect(runOf(runHash(7))).toEqual({ id: 7, other: null });
    expect(runOf(runHash(7, 5))).toEqual({ id: 7, other: 5 });
  });

  it.each(["#/runs", "#/runs/0", "#/runs/7/x", "#/runs/7/7", "#/runs/7/5/3", "#/proposals/7"])(
    "finds none in %j",
    (hash) => {
      expect(runOf(hash)).toBeNull();
    },
  );
});

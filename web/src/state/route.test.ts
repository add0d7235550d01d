import { describe, expect, it } from "vitest";
import { codeHash, codeOf, routeOf } from "./route";

describe("routeOf", () => {
  it.each([
    ["", "robot"],
    ["#/robot", "robot"],
    ["#/plots", "plots"],
    ["#/view", "view"],
    ["#/users", "users"],
    ["#audit", "audit"],
    ["#/account", "account"],
    ["#/nowhere", "robot"],
    ["#/users/7", "robot"],
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

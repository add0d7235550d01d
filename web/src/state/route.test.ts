import { describe, expect, it } from "vitest";
import { routeOf } from "./route";

describe("routeOf", () => {
  it.each([
    ["", "robot"],
    ["#/robot", "robot"],
    ["#/users", "users"],
    ["#audit", "audit"],
    ["#/account", "account"],
    ["#/nowhere", "robot"],
    ["#/users/7", "robot"],
  ])("%j is the page %s", (hash, route) => {
    expect(routeOf(hash)).toBe(route);
  });
});

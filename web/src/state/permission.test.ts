import { describe, expect, it } from "vitest";
import type { MotionControl, Role, User } from "../api/client";
import { type Need, reasonAgainst, reasonOfMode } from "./permission";
import type { Login } from "./store";

const as = (role: Role): Login => ({ phase: "in", user: { name: "ann", role } as User, session: 7 });
const claim = (user: string) => ({ session: 9, user, since: "2026-01-01T00:00:00Z" });
const held: MotionControl = { holder: claim("ann"), mine: true, requests: [] };
const heldBy = (user: string): MotionControl => ({ holder: claim(user), mine: false, requests: [] });
const free: MotionControl = { holder: null, mine: false, requests: [] };

describe("reasonAgainst", () => {
  it.each<[Role, Need, boolean]>([
    ["viewer", "engineer", false],
    ["viewer", "holder", false],
    ["viewer", "admin", false],
    ["engineer", "engineer", true],
    ["engineer", "holder", true],
    ["engineer", "admin", false],
    ["admin", "engineer", true],
    ["admin", "holder", true],
    ["admin", "admin", true],
    ["viewer", "setpoint", false],
    ["engineer", "setpoint", true],
  ])("%s with control, need %s: allowed %s", (role, need, allowed) => {
    expect(reasonAgainst(as(role), held, "manual", need) === null).toBe(allowed);
  });

  it("names who is in control and what to do", () => {
    expect(reasonAgainst(as("engineer"), heldBy("bob"), "manual", "holder")).toBe(
      "bob is in control: request control.",
    );
    expect(reasonAgainst(as("engineer"), free, "manual", "holder")).toBe(
      "Nobody is in control: take control.",
    );
    expect(reasonAgainst(as("engineer"), heldBy("ann"), "manual", "holder")).toContain("in another session");
  });

  it("allows nothing before it is known who is in control or without login", () => {
    expect(reasonAgainst(as("admin"), null, "manual", "holder")).not.toBeNull();
    expect(reasonAgainst({ phase: "out", notice: null }, held, "manual", "engineer")).toBe("Log in first.");
  });

  it.each([
    "home",
    "coordinated",
    "trajectory",
    "draping",
    "ablation",
    "cooperative_biopsy",
    "frequency_sweep",
  ])("leaves no setpoint to the holder in mode %s, and says so; everything else stays allowed", (mode) => {
    expect(reasonAgainst(as("engineer"), held, mode, "setpoint")).toContain(
      `The mode ${mode.replaceAll("_", " ")} drives the setpoints`,
    );
    expect(reasonAgainst(as("engineer"), held, mode, "holder")).toBeNull();
  });

  it("names the missing control first, and locks nothing for a mode that nobody knows", () => {
    expect(reasonAgainst(as("engineer"), free, "home", "setpoint")).toContain("Nobody is in control");
    expect(reasonAgainst(as("engineer"), held, null, "setpoint")).toBeNull();
    expect(reasonOfMode("manual")).toBeNull();
  });
});

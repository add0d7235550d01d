import { describe, expect, it } from "vitest";
import type { Proposal, Status, User } from "../api/client";
import type { Frame } from "../stream/decode";
import type { Notice } from "./notice";
import {
  type ConsoleState,
  initialState,
  MOST_PROPOSALS,
  mergeProposals,
  withBenchAnswer,
  withFrame,
  withFrameError,
  withLogin,
  withLogout,
  withNotice,
  withProposal,
  withStatus,
  withTime,
} from "./store";

const user = { name: "ann", role: "engineer" } as User;
const open: ConsoleState = { ...initialState, phase: "open", login: { phase: "in", user, session: 7 } };
const frame = { connected: true, ageMs: 5, mode: "LOCKED" } as Frame;
const notice: Notice = { code: "RANGE", meaning: "Too far.", nextStep: "Come back." };
const proposal = (id: number, state: Proposal["state"]): Proposal =>
  ({ id, state, slot: 3, verdict: state === "refused" ? "RANGE" : null, detail: "" }) as Proposal;

const applied = (state: ConsoleState, change: Partial<ConsoleState>): ConsoleState => ({
  ...state,
  ...change,
});

describe("data", () => {
  it("live with a frame, grow old with time and recover with the next frame", () => {
    const first = applied(open, withFrame(open, frame, 1000));
    expect(first.freshness).toEqual({ level: "live", ageMs: 5, reason: null });
    const old = applied(first, withTime(first, 2500));
    expect(old.freshness.level).toBe("covered");
    expect(withFrame(old, frame, 2600).freshness?.level).toBe("live");
  });

  it("are covered by a message that cannot be read, until one can", () => {
    const first = applied(open, withFrame(open, frame, 1000));
    const unreadable = applied(first, withFrameError(first, "stream version 2, expected 1", 1010));
    expect(unreadable.freshness).toMatchObject({ level: "covered", reason: "unreadable" });
    expect(applied(unreadable, withTime(unreadable, 1020)).freshness.level).toBe("covered");
    expect(withFrame(unreadable, frame, 1030)).toMatchObject({ frameError: null });
  });
});

describe("the public status", () => {
  const status = { connected: true, age_ms: 5, mode: "LOCKED", estop: true, clock: "sim" } as Status;

  it("is all that the header shows without login, and may be a second old", () => {
    const out = applied(initialState, withStatus(initialState, status, 1000));
    expect(out.glance).toMatchObject({ mode: "LOCKED", estop: true, simulatedClock: true });
    expect(applied(out, withTime(out, 2000)).freshness.level).toBe("live");
    expect(applied(out, withTime(out, 6000)).freshness.level).toBe("covered");
  });

  it("never takes the place of the stream", () => {
    const streaming = applied(open, withFrame(open, frame, 1000));
    const both = applied(streaming, withStatus(streaming, status, 1500));
    expect([both.glance, both.arrivedAtMs, both.status]).toEqual([frame, 1000, status]);
    expect(applied(both, withTime(both, 2500)).freshness.level).toBe("covered");
  });
});

describe("a session", () => {
  it("opens for its user", () => {
    expect(withLogin(user, 7).login).toEqual({ phase: "in", user, session: 7 });
  });

  it("leaves nothing behind that only users may see", () => {
    const seen = { ...open, proposals: [proposal(1, "done")], notices: { 0: notice }, stops: 2 };
    const left = withLogout(applied(seen, withFrame(seen, frame, 1000)), notice);
    expect(left).toMatchObject({ login: { phase: "out", notice }, frame: null, proposals: [], notices: {} });
    expect([left.glance, left.stops]).toEqual([frame, 2]);
  });
});

describe("the refusal of Unlock", () => {
  const refused = { ...open, unlockNotice: notice };

  it("stays while locked and goes with the lock", () => {
    expect(applied(refused, withFrame(refused, frame, 0)).unlockNotice).toBe(notice);
    expect(applied(refused, withFrame(refused, { ...frame, mode: "READY" }, 0)).unlockNotice).toBeNull();
  });
});

describe("proposals", () => {
  it("stand newest first, in their newest version", () => {
    const merged = mergeProposals(
      [proposal(2, "done"), proposal(5, "approved")],
      [proposal(4, "done"), proposal(2, "executing")],
    );
    expect(merged.map(({ id, state }) => `${id} ${state}`)).toEqual(["5 approved", "4 done", "2 done"]);
  });

  it("are bounded in number; the newest stay", () => {
    const many = Array.from({ length: MOST_PROPOSALS + 5 }, (_, index) => proposal(index + 1, "done"));
    const merged = mergeProposals(many, []);
    expect([merged.length, merged[0]?.id]).toEqual([MOST_PROPOSALS, MOST_PROPOSALS + 5]);
  });

  it("show their refusal at the axis and leave other notices alone", () => {
    const before = { ...open, notices: { 0: notice } };
    const refused = applied(before, withProposal(before, proposal(1, "refused")));
    expect(refused.notices[3]?.code).toBe("RANGE");
    expect(refused.notices[0]).toBe(notice);
    expect(withProposal(before, proposal(1, "executing")).notices).toBeUndefined();
  });

  it("of several axes show their refusal above them", () => {
    const refused = withProposal(open, { ...proposal(1, "refused"), slot: null });
    expect(refused.notices?.robot?.code).toBe("RANGE");
  });
});

describe("notices", () => {
  it("are set and removed by axis", () => {
    const set = applied(open, withNotice(open, 4, notice));
    expect(set.notices).toEqual({ 4: notice });
    expect(withNotice(set, 4, null).notices).toEqual({});
  });
});

describe("the refusal of a bench command", () => {
  it("outlives other commands and goes when the command is accepted", () => {
    const refused = applied(open, withBenchAnswer(open, "jam", notice));
    expect(applied(refused, withBenchAnswer(refused, "pedal", null)).benchRefusal).toEqual({
      command: "jam",
      notice,
    });
    expect(applied(refused, withBenchAnswer(refused, "jam", null)).benchRefusal).toBeNull();
  });
});

import { describe, expect, it } from "vitest";
import type { ListedSession } from "../../api/client";
import { ownSessions } from "./sessions";

const session = (number: number, user: string, mine = false): ListedSession => ({
  session: number,
  user,
  mine,
  since: "2026-01-01T00:00:00Z",
  last_use: "2026-01-01T00:00:00Z",
  expires: "2026-01-01T12:00:00Z",
  address: null,
});

describe("ownSessions", () => {
  it("leaves out everybody else's, and puts the session of this page first", () => {
    const listed = [session(9, "ada"), session(8, "eve"), session(7, "ada", true), session(6, "ada")];
    expect(ownSessions(listed, "ada").map((each) => each.session)).toEqual([7, 9, 6]);
  });
});

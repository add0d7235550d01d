import { afterEach, describe, expect, it, vi } from "vitest";

vi.stubGlobal("location", { origin: "http://console.invalid" });
const { api } = await import("./client");

const respond = (status: number, body: string, type = "application/json"): void => {
  vi.stubGlobal("fetch", async () => new Response(body, { status, headers: { "content-type": type } }));
};

/** The browser's network, which answers when the test says so and from then on at once. */
class NetworkInHand {
  readonly asked: string[] = [];
  private release: () => void = () => undefined;

  constructor() {
    const released = new Promise<void>((resolve) => {
      this.release = resolve;
    });
    vi.stubGlobal("fetch", async (request: Request) => {
      this.asked.push(new URL(request.url).pathname);
      await released;
      return Response.json({ verdict: null, tick: null });
    });
  }

  answerAll(): void {
    this.release();
  }
}

afterEach(() => {
  vi.stubGlobal("fetch", undefined);
});

describe("an API call", () => {
  it("gives the app's answer", async () => {
    respond(200, '{"verdict":"ACCEPTED","tick":7}');
    expect(await api.act(3, "enable")).toEqual({ ok: true, value: { verdict: "ACCEPTED", tick: 7 } });
  });

  it("gives the app's problem when refused", async () => {
    const problem = {
      type: "",
      title: "Refused",
      status: 409,
      code: "MODE",
      detail: "The system is LOCKED.",
    };
    respond(409, JSON.stringify(problem), "application/problem+json");
    expect(await api.act(3, "enable")).toEqual({ ok: false, problem });
  });

  it.each([
    ["no app", () => Promise.reject(new TypeError("fetch failed")), "NO_APP"],
    ["an error without explanation", async () => new Response("oops", { status: 500 }), "HTTP_500"],
    ["an answer that is no JSON", async () => new Response("<html>", { status: 200 }), "NO_APP"],
  ])("ends in a problem with a next step for %s", async (_, answer, code) => {
    vi.stubGlobal("fetch", answer);
    const outcome = await api.status();
    expect(outcome).toMatchObject({ ok: false, problem: { code } });
    expect(outcome.ok ? "" : outcome.problem.next_step).not.toBe("");
  });

  it("reads one after the other, and never holds up what the operator asks for", async () => {
    const network = new NetworkInHand();
    const reads = [api.status(), api.motors(), api.proposals()];
    const unlocked = api.reset();
    await vi.waitFor(() => expect(network.asked).toEqual(["/api/reset", "/api/status"]));
    network.answerAll();
    await Promise.all([...reads, unlocked]);
    expect(network.asked.slice(2)).toEqual(["/api/motors", "/api/proposals"]);
  });

  it("is not sent beyond four without an answer, so that STOP finds a free connection", async () => {
    const network = new NetworkInHand();
    const waiting = [0, 1, 2, 3].map((slot) => api.act(slot, "enable"));
    expect(await api.act(4, "enable")).toMatchObject({ ok: false, problem: { code: "BUSY_CONSOLE" } });
    const stopped = api.stop();
    await vi.waitFor(() => expect(network.asked.length).toBe(5));
    expect(network.asked.at(-1)).toBe("/api/stop");
    network.answerAll();
    await Promise.all([...waiting, stopped]);
    respond(200, '{"verdict":"ACCEPTED","tick":7}');
    expect((await api.act(4, "enable")).ok).toBe(true);
  });
});

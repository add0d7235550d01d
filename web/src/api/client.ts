/** The HTTP interface, typed by spec/openapi.yaml. Every call ends in a value or a problem, never in an exception. */
import createClient from "openapi-fetch";
import type { components, paths } from "../generated/api";

export type Motor = components["schemas"]["Motor"];
export type Proposal = components["schemas"]["Proposal"];
export type ProposalDraft = components["schemas"]["ProposalDraft"];
export type Status = components["schemas"]["Status"];
export type VerdictAnswer = components["schemas"]["VerdictAnswer"];
export type AxisAction = paths["/api/motors/{slot}/{action}"]["post"]["parameters"]["path"]["action"];

/** What an error says; the part of the API's problem that people need. */
export type Problem = Pick<components["schemas"]["Problem"], "code" | "detail" | "expected" | "next_step">;

export type Outcome<Value> = { ok: true; value: Value } | { ok: false; problem: Problem };

type Send<Value> = () => Promise<{ data?: Value; error?: unknown; response: Response }>;

const ANSWER_WITHIN_MS = 2000;
/**
 * Browsers keep six connections to a host. Reading takes one, what the operator asks for at most four, so that STOP
 * never waits behind other requests.
 */
const MOST_PENDING_ACTIONS = 4;

const http = createClient<paths>({
  baseUrl: globalThis.location?.origin ?? "",
  fetch: (request: Request) => fetch(request, { signal: AbortSignal.timeout(ANSWER_WITHIN_MS) }),
});

let lastRead: Promise<unknown> = Promise.resolve();

/** Reads one after the other. */
function read<Value>(send: Send<Value>): Promise<Outcome<Value>> {
  const outcome = lastRead.then(() => outcomeOf(send));
  lastRead = outcome;
  return outcome;
}

let pendingActions = 0;

/** Sends at once or not at all: what an operator asked for must not happen when it is no longer expected. */
async function act<Value>(send: Send<Value>): Promise<Outcome<Value>> {
  if (pendingActions >= MOST_PENDING_ACTIONS) return { ok: false, problem: tooManyPending };
  pendingActions += 1;
  try {
    return await outcomeOf(send);
  } finally {
    pendingActions -= 1;
  }
}

async function outcomeOf<Value>(send: Send<Value>): Promise<Outcome<Value>> {
  try {
    const { data, error, response } = await send();
    if (response.ok && data !== undefined) return { ok: true, value: data };
    return { ok: false, problem: isProblem(error) ? error : unexpectedAnswer(response.status) };
  } catch {
    return { ok: false, problem: noAnswer };
  }
}

function isProblem(error: unknown): error is Problem {
  return typeof error === "object" && error !== null && "code" in error && "detail" in error;
}

const tooManyPending: Problem = {
  code: "BUSY_CONSOLE",
  detail: `${MOST_PENDING_ACTIONS} earlier requests have no answer yet; this one was not sent.`,
  next_step: "Wait until the app answers, then try again.",
};

const noAnswer: Problem = {
  code: "NO_APP",
  detail: `The app gave no readable answer within ${ANSWER_WITHIN_MS / 1000} s.`,
  next_step: "Check that the app runs and that this computer reaches it.",
};

function unexpectedAnswer(status: number): Problem {
  return {
    code: `HTTP_${status}`,
    detail: `The app answered with HTTP status ${status} and no explanation.`,
    next_step: "Reload the page; if it happens again, report it with the app's log.",
  };
}

export const api = {
  status: () => read(() => http.GET("/api/status")),
  motors: () => read(() => http.GET("/api/motors")),
  proposals: () => read(() => http.GET("/api/proposals")),
  act: (slot: number, action: AxisAction) =>
    act(() => http.POST("/api/motors/{slot}/{action}", { params: { path: { slot, action } } })),
  propose: (draft: ProposalDraft) => act(() => http.POST("/api/proposals", { body: draft })),
  abort: (id: number) => act(() => http.POST("/api/proposals/{id}/abort", { params: { path: { id } } })),
  reset: () => act(() => http.POST("/api/reset")),
  bench: () => read(() => http.GET("/api/bench")),
  benchCommand: (command: string, body: Record<string, unknown>) =>
    act(() => http.POST("/api/bench/{command}", { params: { path: { command } }, body })),
  /** Outside all counts: STOP is always sent, and survives leaving the page. */
  stop: () => outcomeOf(() => http.POST("/api/stop", { keepalive: true, priority: "high" })),
};

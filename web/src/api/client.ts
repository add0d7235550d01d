/** The HTTP interface, typed by spec/openapi.yaml. Every call ends in a value or a problem, never in an exception. */
import createClient from "openapi-fetch";
import type { components, paths } from "../generated/api";

type Schemas = components["schemas"];

export type Motor = Schemas["Motor"];
export type Proposal = Schemas["Proposal"];
export type JogStart = Schemas["JogStart"];
export type JogDirection = JogStart["direction"];
export type ProposalDraft = Schemas["ProposalDraft"];
export type RobotFileChange = Schemas["RobotFileChange"];
export type ProposalPlan = Schemas["ProposalPlan"];
export type ProposalGhost = Schemas["ProposalGhost"];
export type AxisProfile = Schemas["AxisProfile"];
export type LoadedTrajectory = Schemas["LoadedTrajectory"];
export type ListedRun = Schemas["ListedRun"];
export type Run = Schemas["Run"];
export type RunAxis = Schemas["RunAxis"];
export type RunList = Schemas["RunList"];
export type RunSamples = Schemas["RunSamples"];
export type RunRetention = Schemas["RunRetention"];
export type RunQuery = NonNullable<paths["/api/runs"]["get"]["parameters"]["query"]>;
export type BodyPart = Schemas["BodyPart"];
export type Reach = Schemas["Reach"];
export type Status = Schemas["Status"];
export type CardStatus = Status["cards"][number];
export type VerdictAnswer = Schemas["VerdictAnswer"];
export type Session = Schemas["Session"];
export type ListedSession = Schemas["ListedSession"];
export type User = Schemas["User"];
export type Role = Schemas["Role"];
export type NewUser = Schemas["NewUser"];
export type UserChange = Schemas["UserChange"];
export type MotionControl = Schemas["MotionControl"];
export type Claim = Schemas["Claim"];
export type Robot = Schemas["Robot"];
export type KernelConfiguration = Schemas["KernelConfiguration"];
export type ModeAnswer = Schemas["ModeAnswer"];
export type AxisVerdict = Schemas["AxisVerdicts"][number];
export type PositionsFile = Schemas["PositionsFile"];
export type PositionsComparison = Schemas["PositionsComparison"];
export type DeclaredPositions = Schemas["DeclaredPositions"];
export type Connection = Schemas["Connection"];
export type NavigationConnection = Schemas["NavigationConnection"];
export type Imager = Schemas["Imager"];
export type Alarm = Schemas["Alarm"];
/** What is left out lets every record through. */
export type AuditFilter = { before?: number; kind?: string; actor?: string; text?: string };
export type Holds = Schemas["Holds"];
export type NavigationRole = NavigationConnection["role"];
export type Biopsy = Schemas["Biopsy"];
export type BiopsyNow = Schemas["BiopsyNow"];
export type Force = Schemas["Force"];
export type LogLevel = Schemas["LogLevel"];
export type LogLine = Schemas["LogLine"];
export type HistoryRows = Schemas["History"];
export type Extremes = Schemas["Extremes"];
export type Capture = Schemas["Capture"];
export type Case = Schemas["Case"];
export type Targeting = Schemas["Targeting"];
export type AlignmentView = Schemas["AlignmentView"];
export type Alignment = Schemas["Alignment"];
export type ErrorBudget = Schemas["ErrorBudget"];
export type TargetChange = Schemas["TargetChange"];
export type RegistrationChange = Schemas["RegistrationChange"];
export type TargetingHistory = Schemas["TargetingHistory"];
export type TargetingOrigin = Schemas["TargetingOrigin"];
export type AuditRecord = Schemas["AuditRecord"];
export type AuditCheck = Schemas["AuditCheck"];
export type AxisAction = paths["/api/motors/{axis}/{action}"]["post"]["parameters"]["path"]["action"];

/** What an error says; the part of the API's problem that people need. */
export type Problem = Pick<
  Schemas["Problem"],
  "code" | "detail" | "expected" | "next_step" | "field" | "line"
> & {
  /** Seconds to wait before another attempt makes sense. */
  readonly retryAfterS?: number;
};

export type Outcome<Value> = { ok: true; value: Value } | { ok: false; problem: Problem };

type Send<Value> = () => Promise<{ data?: Value; error?: unknown; response: Response }>;

const ANSWER_WITHIN_MS = 2000;
/** Hashing a password is slow by intent, and several axes have several verdicts. */
const SLOW_ANSWER_WITHIN_MS = 10_000;
/**
 * Browsers keep six connections to a host. Reading takes one, what the operator asks for at most four, so that STOP
 * never waits behind other requests.
 */
const MOST_PENDING_ACTIONS = 4;

function clientWithin(patienceMs: number) {
  return createClient<paths>({
    baseUrl: globalThis.location?.origin ?? "",
    fetch: (request: Request) => fetch(request, { signal: AbortSignal.timeout(patienceMs) }),
  });
}

const http = clientWithin(ANSWER_WITHIN_MS);
const slowHttp = clientWithin(SLOW_ANSWER_WITHIN_MS);

let tellLoggedOut: (problem: Problem) => void = () => undefined;

/** `listener` is told whenever the app answers that nobody is logged in here. */
export function onLoggedOut(listener: (problem: Problem) => void): void {
  tellLoggedOut = listener;
}

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
    const problem = isProblem(error)
      ? { ...error, ...retryAfter(response) }
      : unexpectedAnswer(response.status);
    if (response.status === 401 && problem.code === "LOGIN") tellLoggedOut(problem);
    return { ok: false, problem };
  } catch {
    return { ok: false, problem: noAnswer };
  }
}

function isProblem(error: unknown): error is Problem {
  return typeof error === "object" && error !== null && "code" in error && "detail" in error;
}

function retryAfter(response: Response): { retryAfterS?: number } {
  const seconds = Number(response.headers.get("Retry-After") ?? Number.NaN);
  return Number.isFinite(seconds) ? { retryAfterS: seconds } : {};
}

const tooManyPending: Problem = {
  code: "BUSY_CONSOLE",
  detail: `${MOST_PENDING_ACTIONS} earlier requests have no answer yet; this one was not sent.`,
  next_step: "Wait until the app answers, then try again.",
};

const noAnswer: Problem = {
  code: "NO_APP",
  detail: "The app gave no readable answer in time.",
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
  session: () => read(() => http.GET("/api/session")),
  sessions: () => read(() => http.GET("/api/sessions")),
  endSession: (session: number) =>
    act(() => http.DELETE("/api/sessions/{session}", { params: { path: { session } } })),
  login: (name: string, password: string) =>
    act(() => slowHttp.POST("/api/login", { body: { name, password } })),
  logout: () => act(() => http.POST("/api/logout")),
  changePassword: (current: string, wanted: string) =>
    act(() => slowHttp.PUT("/api/password", { body: { current, new: wanted } })),

  users: () => read(() => http.GET("/api/users")),
  addUser: (user: NewUser) => act(() => slowHttp.POST("/api/users", { body: user })),
  changeUser: (user: string, change: UserChange) =>
    act(() => slowHttp.PUT("/api/users/{user}", { params: { path: { user } }, body: change })),

  control: () => read(() => http.GET("/api/control")),
  requestControl: () => act(() => http.POST("/api/control/request")),
  releaseControl: () => act(() => http.POST("/api/control/release")),
  handOverControl: (session: number) => act(() => http.POST("/api/control/hand-over", { body: { session } })),
  takeOverControl: () => act(() => http.POST("/api/control/take-over")),

  kernelConfiguration: () => read(() => http.GET("/api/kernel/configuration")),
  robots: () => read(() => http.GET("/api/robots")),
  mode: () => read(() => http.GET("/api/mode")),
  setMode: (mode: string) => act(() => http.PUT("/api/mode", { body: { mode } })),
  motors: () => read(() => http.GET("/api/motors")),
  act: (axis: number, action: AxisAction) =>
    act(() => http.POST("/api/motors/{axis}/{action}", { params: { path: { axis: String(axis), action } } })),
  setHomeAgainstSwitch: (axis: number) =>
    act(() =>
      http.POST("/api/motors/{axis}/{action}", {
        params: { path: { axis: String(axis), action: "set-home" } },
        body: { override_switch: true },
      }),
    ),
  zeroAll: () => act(() => slowHttp.POST("/api/motors/zero-all")),
  proposals: () => read(() => http.GET("/api/proposals")),
  propose: (draft: ProposalDraft) => act(() => http.POST("/api/proposals", { body: draft })),
  beginJog: (start: JogStart) => act(() => http.POST("/api/jog", { body: start })),
  renewJog: (id: number) => act(() => http.PUT("/api/jog/{id}", { params: { path: { id } } })),
  approve: (id: number) => act(() => http.POST("/api/proposals/{id}/approve", { params: { path: { id } } })),
  confirm: (id: number) => act(() => http.POST("/api/proposals/{id}/confirm", { params: { path: { id } } })),
  reject: (id: number) => act(() => http.POST("/api/proposals/{id}/reject", { params: { path: { id } } })),
  proposalPlan: (id: number) =>
    read(() => slowHttp.GET("/api/proposals/{id}/plan", { params: { path: { id } } })),
  robotFile: (id: number) =>
    read(() => http.GET("/api/proposals/{id}/robot-file", { params: { path: { id } } })),
  abort: (id: number) => act(() => http.POST("/api/proposals/{id}/abort", { params: { path: { id } } })),
  runs: (query: RunQuery) => read(() => http.GET("/api/runs", { params: { query } })),
  run: (id: number) => read(() => http.GET("/api/runs/{id}", { params: { path: { id } } })),
  runSamples: (id: number) =>
    read(() => slowHttp.GET("/api/runs/{id}/samples", { params: { path: { id } } })),
  runTable: (id: number) =>
    read(() => slowHttp.GET("/api/runs/{id}/csv", { params: { path: { id } }, parseAs: "text" })),
  setRunNote: (id: number, text: string) =>
    act(() => http.PUT("/api/runs/{id}/note", { params: { path: { id } }, body: { text } })),
  setRunRetention: (count: number, days: number) =>
    act(() => http.PUT("/api/runs/retention", { body: { count, days } })),
  trajectory: () => read(() => http.GET("/api/trajectory")),
  loadTrajectory: (text: string, timing: "as_written" | "slowed_to_fit") =>
    act(() =>
      slowHttp.PUT("/api/trajectory", {
        params: { query: { timing } },
        body: text,
        bodySerializer: (body) => body,
        headers: { "Content-Type": "text/csv" },
      }),
    ),
  unloadTrajectory: () => act(() => http.DELETE("/api/trajectory")),
  reset: () => act(() => http.POST("/api/reset")),

  positions: () => read(() => http.GET("/api/positions")),
  /** The file is sent as it is: judging it is the app's. */
  comparePositions: (file: unknown) =>
    act(() => http.POST("/api/positions/compare", { body: file as PositionsFile })),
  restore: (file: PositionsFile, axes: string[]) =>
    act(() => slowHttp.PUT("/api/motors/restore", { body: { file, axes } })),
  /** What Set Home, Zero all or Load declared last, while it can be undone. */
  declaredPositions: () => read(() => http.GET("/api/positions/undo")),
  undoDeclaredPositions: () => act(() => slowHttp.POST("/api/positions/undo")),

  biopsy: () => read(() => http.GET("/api/biopsy")),
  zeroForces: () => act(() => http.POST("/api/biopsy/zero")),
  setMembranes: (depths_mm: number[]) =>
    act(() => http.PUT("/api/biopsy/membranes", { body: { depths_mm, next: 0 } })),
  resetMembranes: () => act(() => http.POST("/api/biopsy/membranes/reset")),

  alarms: () => read(() => http.GET("/api/alarms")),
  acknowledgeAlarm: (id: number) =>
    act(() => http.POST("/api/alarms/{id}/acknowledge", { params: { path: { id } } })),
  holds: () => read(() => http.GET("/api/holds")),
  setBreathingGate: (in_use: boolean) => act(() => http.PUT("/api/holds/gate", { body: { in_use } })),
  holdForScan: (active: boolean) => act(() => http.PUT("/api/holds/scan", { body: { active } })),

  communications: () => read(() => http.GET("/api/communications")),
  disconnect: (id: number) => act(() => http.PUT("/api/communications/disconnect", { body: { id } })),
  navigationConnections: () => read(() => http.GET("/api/communications/connections")),
  imager: () => read(() => http.GET("/api/communications/imager")),
  endNavigation: (id: number) =>
    act(() => http.DELETE("/api/communications/connections/{id}", { params: { path: { id } } })),
  setNavigationRole: (id: number, role: NavigationRole) =>
    act(() =>
      http.PUT("/api/communications/connections/{id}/role", { params: { path: { id } }, body: { role } }),
    ),
  history: (after: number) => read(() => http.GET("/api/history", { params: { query: { after } } })),
  /** `until`: last tick; undefined: the newest. */
  capture: (slot: number, seconds: number, until?: number) =>
    read(() =>
      http.GET("/api/capture", {
        params: { query: until === undefined ? { slot, seconds } : { slot, seconds, until } },
      }),
    ),
  listCases: () => read(() => http.GET("/api/cases")),
  openCase: (label: string) => act(() => http.POST("/api/cases", { body: { label } })),
  /** With its part of the audit. */
  getCase: (number: number) =>
    act(() => slowHttp.GET("/api/cases/{number}", { params: { path: { number } } })),
  deleteCase: (number: number) =>
    act(() => http.DELETE("/api/cases/{number}", { params: { path: { number } } })),
  suspendCase: (number: number) =>
    act(() => http.POST("/api/cases/{number}/suspend", { params: { path: { number } } })),
  resumeCase: (number: number) =>
    act(() => http.POST("/api/cases/{number}/resume", { params: { path: { number } } })),
  closeCase: (number: number) =>
    act(() => http.POST("/api/cases/{number}/close", { params: { path: { number } } })),
  addCaseNote: (number: number, text: string) =>
    act(() => http.POST("/api/cases/{number}/notes", { params: { path: { number } }, body: { text } })),
  targeting: () => read(() => http.GET("/api/targeting")),
  alignment: () => read(() => http.GET("/api/targeting/alignment")),
  targetingHistory: () => read(() => http.GET("/api/targeting/history")),
  setRegistration: (change: RegistrationChange) =>
    act(() => http.PUT("/api/targeting/registration", { body: change })),
  /** The table moved. */
  expireRegistration: () => act(() => http.POST("/api/targeting/registration/expire", { body: {} })),
  setPlannedTargets: (planned_targets: Targeting["planned_targets"]) =>
    act(() => http.PUT("/api/targeting/planned", { body: { planned_targets } })),
  setTarget: (change: TargetChange) => act(() => http.PUT("/api/targeting/target", { body: change })),
  /** Computed anew for each probe. */
  reach: () => read(() => slowHttp.GET("/api/targeting/reach")),
  logs: (lines: number) => read(() => http.GET("/api/logs", { params: { query: { lines } } })),
  setLogLevel: (level: LogLevel) => act(() => http.PUT("/api/logs", { body: { level } })),
  audit: (records: number, filter: AuditFilter = {}) =>
    read(() => http.GET("/api/audit", { params: { query: { records, ...filter } } })),

  /** Goes over all records: a long audit takes its time. */
  verifyAudit: (noted?: string) =>
    act(() => slowHttp.GET("/api/audit/verify", { params: { query: noted === undefined ? {} : { noted } } })),
  bench: () => read(() => http.GET("/api/bench")),
  benchCommand: (command: string, body: Record<string, unknown>) =>
    act(() => http.POST("/api/bench/{command}", { params: { path: { command } }, body })),
  /** Outside all counts: STOP is always sent, and survives leaving the page. */
  stop: () => outcomeOf(() => http.POST("/api/stop", { keepalive: true, priority: "high" })),
};

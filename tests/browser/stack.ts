/** A robot of one's own: `interlock run` with its three processes on the paced clock. */
import { type ChildProcess, execFileSync, spawn } from "node:child_process";
import { mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { connect, type Socket } from "node:net";
import { tmpdir } from "node:os";
import path from "node:path";
import { createInterface } from "node:readline";
import { programs } from "./places";

const READY_WITHIN_MS = 300_000;
/** Of a recording, whose moments nobody waits for. */
const REPLAY_SPEED = "20";
/** In which /proc counts processor time. */
const CLOCK_TICKS_PER_S = 100;

const interlock = path.join(programs, "interlock");

/**
 * `fast` is five times the pace, for what lasts and asks nothing of the page meanwhile. `slow` is a tenth of it, for tests in which a page keeps up with the robot: it renews a pedal or a jog that would
 * lapse by this clock, or does something while an axis moves.
 */
export type Clock = "paced" | "fast" | "slow" | "realtime";

const clockOptions = {
  paced: [],
  fast: ["--speed", "5"],
  slow: ["--speed", "0.1"],
  realtime: ["--realtime"],
} as const;

export type RobotName = "neuro" | "prostate";

interface Ready {
  readonly url: string;
  /** Of the user `admin`, said once at the first start. */
  readonly password: string;
  /** Where navigation programs are served; 0 where none are. */
  readonly igtlPort: number;
}

/** The state of an axis in the answer of the simulated hardware to `status`. */
interface PlantAxis {
  readonly slot: number;
  readonly position_counts: number;
}

interface PlantAnswer {
  readonly ok: boolean;
  readonly error?: string;
  readonly tick: number;
  readonly axes?: readonly PlantAxis[];
}

export class Stack {
  readonly url: string;
  readonly password: string;
  readonly igtlPort: number;
  private socket?: Socket;
  private answers?: AsyncIterator<string>;

  private constructor(
    private readonly run: ChildProcess,
    private readonly state: string,
    ready: Ready,
  ) {
    this.url = ready.url;
    this.password = ready.password;
    this.igtlPort = ready.igtlPort;
  }

  /** Starts the robot with a fresh state, and that plant in place of the robot's own, and waits for its ready line. */
  static async start(robot: RobotName, clock: Clock, plant?: string): Promise<Stack> {
    const state = mkdtempSync(path.join(tmpdir(), "interlock-browser-"));
    const plantFile = path.join(state, "plant.toml");
    if (plant !== undefined) writeFileSync(plantFile, plant);
    const run = spawn(
      interlock,
      [
        ...["run", "--robot", robot],
        ...clockOptions[clock],
        ...(plant === undefined ? [] : ["--plant", plantFile]),
        ...["--port", "0", "--igtl-port", "0", "--state", state, "--sockets", path.join(state, "sockets")],
      ],
      { stdio: ["ignore", "pipe", "pipe"] },
    );
    return new Stack(run, state, await readiness(run));
  }

  /** Shows the last minute of this robot in a console of its own. */
  async replay(): Promise<Stack> {
    const state = mkdtempSync(path.join(tmpdir(), "interlock-replay-"));
    const recording = path.join(state, "last-minute.ilkr");
    execFileSync(interlock, ["record", "--state", this.state, "--output", recording]);
    const run = spawn(interlock, ["replay", recording, "--console", "--port", "0", "--speed", REPLAY_SPEED], {
      stdio: ["ignore", "pipe", "pipe"],
    });
    return new Stack(run, state, await readiness(run));
  }

  /** A command to the simulated hardware itself (models/plant/README.md). What it holds, no page that is slow lets go. */
  async plant(command: string, fields: object = {}): Promise<PlantAnswer> {
    this.socket ??= connect(path.join(this.state, "sockets", "control.sock"));
    this.answers ??= createInterface({ input: this.socket })[Symbol.asyncIterator]();
    this.socket.write(`${JSON.stringify({ command, ...fields })}\n`);
    const { value } = await this.answers.next();
    const answer = JSON.parse(value) as PlantAnswer;
    if (!answer.ok) throw new Error(`${command}: ${answer.error}`);
    return answer;
  }

  /** Waits until the axis of that slot has stood still for so many ticks. */
  async rest(slot: number, ticks: number): Promise<void> {
    let since = await this.plant("status");
    const place = (answer: PlantAnswer) => answer.axes?.find((axis) => axis.slot === slot)?.position_counts;
    for (let now = since; now.tick < since.tick + ticks; now = await this.plant("status"))
      if (place(now) !== place(since)) since = now;
  }

  /** Signals the app's process alone; kernel and simulator run on. */
  signalApp(signal: "SIGSTOP" | "SIGCONT" | "SIGKILL"): void {
    process.kill(this.appPid(), signal);
  }

  /** Processor time that the app has taken since it started. */
  appCpuS(): number {
    const line = readFileSync(`/proc/${this.appPid()}/stat`, "utf8");
    // After the name in brackets: the state, ten numbers, then user and system time.
    const [user, system] = line
      .slice(line.lastIndexOf(")") + 2)
      .split(" ")
      .slice(11, 13)
      .map(Number);
    return ((user ?? Number.NaN) + (system ?? Number.NaN)) / CLOCK_TICKS_PER_S;
  }

  /** Ends all processes and removes their state. */
  async end(): Promise<void> {
    this.socket?.destroy();
    if (this.run.exitCode === null) {
      const ended = new Promise((resolve) => this.run.once("exit", resolve));
      this.run.kill("SIGINT");
      await ended;
    }
    rmSync(this.state, { recursive: true, force: true });
  }

  private appPid(): number {
    const own = String(this.run.pid);
    for (const pid of readdirSync("/proc").filter((name) => /^\d+$/.test(name))) {
      const { name, parent } = processOf(pid);
      if (parent === own && name === "interlock-app") return Number(pid);
    }
    throw new Error(`interlock run (process ${own}) has no child interlock-app`);
  }
}

function processOf(pid: string): { name: string; parent: string } {
  try {
    const [, name = "", parent = ""] =
      /\((.*)\) \S (\d+)/.exec(readFileSync(`/proc/${pid}/stat`, "utf8")) ?? [];
    return { name, parent };
  } catch {
    // The process ended between the listing and the reading.
    return { name: "", parent: "" };
  }
}

function readiness(run: ChildProcess): Promise<Ready> {
  const said: string[] = [];
  let password: string | undefined;
  let igtlPort: string | undefined;
  return new Promise((resolve, reject) => {
    const giveUp = (reason: string): void => {
      run.kill("SIGKILL");
      reject(new Error(`interlock run ${reason}; it said:\n${said.join("\n")}`));
    };
    const timer = setTimeout(
      () => giveUp(`was not ready within ${READY_WITHIN_MS / 1000} s`),
      READY_WITHIN_MS,
    );
    run.once("error", (error) => giveUp(`did not start (${error.message})`));
    run.once("exit", (code) => giveUp(`ended with exit code ${code}`));
    for (const stream of [run.stdout, run.stderr]) {
      if (stream === null) continue;
      createInterface({ input: stream }).on("line", (line) => {
        said.push(line);
        password ??= /^first login: admin (\S+)$/.exec(line)?.[1];
        igtlPort ??= /OpenIGTLink 127\.0\.0\.1:(\d+)$/.exec(line)?.[1];
        const url = /^ready (http:\S+)/.exec(line)?.[1];
        if (url === undefined) return;
        clearTimeout(timer);
        run.removeAllListeners("exit");
        if (password === undefined) giveUp("said no first login");
        else resolve({ url, password, igtlPort: Number(igtlPort ?? 0) });
      });
    }
  });
}

/** The console as an operator meets it: by roles and names, never by the page's inner structure. */
import { expect, type Locator, type Page } from "@playwright/test";
import type { Stack } from "./stack";

/** For so long an axis rests that is said to: more than a controller takes from an approval to its first drive. */
const REST_TICKS = 150;

interface Motor {
  readonly title: string;
  readonly slot: number;
  readonly position_counts: number;
}

export class Axis {
  readonly row: Locator;
  readonly track: Locator;
  /** What the kernel in the page says of the target that is typed or dragged. */
  readonly foretelling: Locator;

  constructor(
    private readonly page: Page,
    private readonly title: string,
    private readonly stack: Stack,
  ) {
    this.row = page.getByRole("listitem", { name: `Axis ${title}`, exact: true });
    this.foretelling = this.row.getByRole("status").filter({ hasText: /would|cannot be told/ });
    this.track = page.getByRole("slider", { name: `${title} target` });
  }

  button(action: "Enable" | "Disable" | "Go Home" | "Set Home" | "Clear"): Locator {
    return this.row.getByRole("button", { name: `${action} ${this.title}`, exact: true });
  }

  async press(action: Parameters<Axis["button"]>[0]): Promise<void> {
    await this.button(action).click();
  }

  async expectState(state: string): Promise<void> {
    await expect(this.row.getByText(state, { exact: true })).toBeVisible();
  }

  /** Once the page says no more that the kernel would refuse it: it wants power up and the axis at rest. One whose
   * encoder trembles just then is asked again. */
  async enable(): Promise<void> {
    const enabled = this.row.getByText("ENABLED", { exact: true });
    await expect(async () => {
      if (await enabled.isVisible()) return;
      await expect(this.button("Enable")).not.toHaveAttribute("data-foretold");
      await this.press("Enable");
      await expect(enabled).toBeVisible({ timeout: 2000 });
    }).toPass();
  }

  /** Declares that the axis is at home; the kernel wants it at rest, so one that still settles is asked again. */
  async setHome(overridden = false): Promise<void> {
    const question = this.page.getByRole("region", { name: `Override the switch of ${this.title}?` });
    await expect(async () => {
      await this.press("Set Home");
      if (overridden) await question.getByRole("button", { name: "Set Home all the same" }).click();
      await expect(this.row.getByText("UNHOMED")).toHaveCount(0, { timeout: 2000 });
    }).toPass();
  }

  /** Types a target in the axis' unit and proposes it. */
  async propose(target: string): Promise<void> {
    await this.row.getByRole("textbox").fill(target);
    await this.row.getByRole("button", { name: `Propose ${this.title}` }).click();
  }

  /** Measured counts, as shown. */
  async counts(): Promise<number> {
    const text = await this.row.getByRole("status", { name: `${this.title} position` }).textContent();
    return Number(/(-?\d+) counts/.exec(text ?? "")?.[1] ?? Number.NaN);
  }

  /** Counts under the circle. */
  async circle(): Promise<number> {
    return Number(await this.track.getAttribute("aria-valuenow"));
  }

  /** Takes the circle along the track, in pixels, and leaves it held. */
  async drag(pixels: number): Promise<void> {
    const box = await this.track.boundingBox();
    if (box === null) throw new Error(`the track of ${this.title} is not visible`);
    const min = Number(await this.track.getAttribute("aria-valuemin"));
    const max = Number(await this.track.getAttribute("aria-valuemax"));
    const x = box.x + (box.width * ((await this.circle()) - min)) / (max - min);
    const y = box.y + box.height / 2;
    await this.page.mouse.move(x, y);
    await this.page.mouse.down();
    await this.page.mouse.move(x + pixels, y, { steps: 8 });
  }

  async expectRefusal(verdict: string): Promise<Locator> {
    const refusal = this.row.getByRole("alert").filter({ hasText: `Refused: ${verdict}` });
    await expect(refusal).toBeVisible();
    return refusal;
  }

  /** Waits until the axis rests and the page shows where, and gives it: up to one count that the encoder trembles by. */
  async restingCounts(): Promise<number> {
    const motor = async (): Promise<Motor> => {
      const answer = await this.page.request.get(new URL("/api/motors", this.stack.url).href);
      const motors = (await answer.json()) as Motor[];
      const found = motors.find(({ title }) => title === this.title);
      if (found === undefined) throw new Error(`no axis ${this.title}`);
      return found;
    };
    await this.stack.rest((await motor()).slot, REST_TICKS);
    const { position_counts: counts } = await motor();
    await expect.poll(async () => Math.abs((await this.counts()) - counts)).toBeLessThanOrEqual(1);
    return counts;
  }
}

/** Of each page a panel that no other one has, and that it always has. */
export const knownBy = {
  Robot: "Motors",
  Workflow: "Workflow",
  Targeting: "Registration",
  Proposals: "All proposals",
  Runs: "Runs",
  Plots: "Capture",
  Tuning: "Measure an axis",
  "3D": "3D",
  Codes: "Codes",
  Users: "Users",
  Audit: "Audit",
  Account: "Account",
} as const;

export type PageName = keyof typeof knownBy;

export class ConsolePage {
  readonly mode: Locator;
  readonly estop: Locator;
  readonly pedalState: Locator;
  readonly unlock: Locator;
  readonly stop: Locator;
  readonly stopAnswer: Locator;
  readonly pedal: Locator;
  readonly latch: Locator;
  readonly control: Locator;
  readonly loginForm: Locator;

  constructor(
    readonly page: Page,
    private readonly stack: Stack,
  ) {
    this.mode = page.getByRole("status", { name: "Mode", exact: true });
    this.estop = page.getByRole("status", { name: "E-stop", exact: true });
    this.pedalState = page.getByRole("status", { name: "Pedal", exact: true });
    this.unlock = page.getByRole("button", { name: "Unlock" });
    this.stop = page.getByRole("button", { name: /^STOP/ });
    this.stopAnswer = page.getByRole("status", { name: "Answer to STOP" });
    this.pedal = page.getByRole("button", { name: /^\S* ?Pedal/ });
    this.latch = page.getByRole("button", { name: "Latch pedal" });
    this.control = page.getByRole("status", { name: "Control", exact: true });
    this.loginForm = page.getByRole("form", { name: "Log in" });
  }

  panel(title: string): Locator {
    return this.page.getByRole("region", { name: title, exact: true });
  }

  button(name: string): Locator {
    return this.page.getByRole("button", { name, exact: true });
  }

  async tryLogIn(name: string, password: string): Promise<void> {
    await this.loginForm.getByLabel("Name").fill(name);
    await this.loginForm.getByLabel("Password").fill(password);
    await this.loginForm.getByRole("button", { name: "Log in" }).click();
  }

  async logIn(name: string, password: string): Promise<void> {
    await this.tryLogIn(name, password);
    await expect(this.page.getByRole("link", { name: "Account" })).toContainText(name);
  }

  async takeControl(): Promise<void> {
    await this.button("Take control").click();
    await expect(this.control).toHaveText("You are in control");
  }

  /** Presses the theme's button, each time once it shows the theme before, until it is that one. */
  async chooseTheme(theme: "light" | "dark"): Promise<void> {
    const switching = this.page.getByRole("button", { name: /^Theme:/ });
    for (;;) {
      const shown = (await switching.getAttribute("aria-label")) ?? "";
      if (shown === `Theme: ${theme}`) return;
      await switching.click();
      await expect(switching).not.toHaveAttribute("aria-label", shown);
    }
  }

  /** Ends when the page is there: until its code is loaded the one before stays. */
  async open(page: PageName): Promise<void> {
    await this.page.getByRole("link", { name: page, exact: page === "Proposals" }).click();
    await expect(this.page.locator(`[aria-label="${knownBy[page]}"].panel`)).toBeAttached();
  }

  /** By the Users page; ends on the Robot page. */
  async addUser(name: string, role: "viewer" | "engineer" | "admin", password: string): Promise<void> {
    await this.open("Users");
    const form = this.page.getByRole("form", { name: "Add a user" });
    await form.getByLabel("Name").fill(name);
    await form.getByLabel("Role").selectOption(role);
    await form.getByLabel("Password").fill(password);
    await form.getByRole("button", { name: "Add user" }).click();
    await expect(this.page.getByRole("row", { name: `User ${name}` })).toBeVisible();
    await this.open("Robot");
  }

  /**
   * Moves axes of a robot that just started by hand, by counts a title: homing from close to the switch is homing, and
   * takes less time. An axis that is enabled before it rests would drift.
   */
  async pushByHand(slotAndCountsOf: Record<string, [slot: number, counts: number]>): Promise<void> {
    for (const [slot, counts] of Object.values(slotAndCountsOf)) {
      const status = await this.page.evaluate(
        async (body) => (await fetch("/api/bench/push", { method: "POST", body })).status,
        JSON.stringify({ slot, counts }),
      );
      expect(status, `push of slot ${slot}`).toBe(200);
    }
    for (const [title, [, counts]] of Object.entries(slotAndCountsOf)) {
      await expect.poll(() => this.axis(title).counts()).toBe(counts);
    }
  }

  /** As another program of the same user: registration, entry and target belong to a case. */
  async openCase(label = "phantom"): Promise<void> {
    const cases = new URL("/api/cases", this.stack.url).href;
    const answer = await this.page.request.post(cases, { data: { label } });
    expect(answer.status(), "opening of a case").toBe(201);
  }

  axis(title: string): Axis {
    return new Axis(this.page, title, this.stack);
  }

  /** Of a proposal that waits for that. */
  /** Ends once it is approved: a press that comes before waits for another one. */
  async approve(id: number): Promise<void> {
    const approve = this.button(`Approve proposal ${id}`);
    await approve.click();
    await expect(approve).toHaveCount(0);
  }

  proposal(id: number): Locator {
    return this.page.getByRole("listitem", { name: `Proposal ${id}`, exact: true });
  }

  async expectMode(mode: "LOCKED" | "READY" | "MOTION" | "UNKNOWN"): Promise<void> {
    await expect(this.mode).toContainText(mode);
  }

  async unlockRobot(): Promise<void> {
    await this.expectMode("LOCKED");
    await this.unlock.click();
    await this.expectMode("READY");
  }

  /** Enables every axis; what asks for all of them is told no until the last one is. */
  async enableAll(): Promise<void> {
    for (const row of await this.page.getByRole("listitem", { name: /^Axis / }).all()) {
      const label = (await row.getAttribute("aria-label")) ?? "";
      await this.axis(label.replace("Axis ", "")).enable();
    }
  }

  /** Steps on the pedal of the simulated hardware itself. MOTION may have ended again before the page shows it. */
  async pressPedal(): Promise<void> {
    await this.expectArmed();
    await this.stack.plant("pedal", { pressed: true });
    await expect(this.pedalState).toContainText("pressed");
  }

  async releasePedal(): Promise<void> {
    await this.stack.plant("pedal", { pressed: false });
    await expect(this.pedalState).toContainText("released");
  }

  /** Presses the page's pedal with the pointer and keeps it down: for as long as the page renews it. */
  async holdPedal(): Promise<void> {
    await this.expectArmed();
    await this.pedal.hover();
    await this.page.mouse.down();
    await this.expectMode("MOTION");
  }

  async letPedalGo(): Promise<void> {
    await this.page.mouse.up();
    await this.expectMode("READY");
  }

  /** Presses the page's pedal and keeps the pointer free. */
  async latchPedal(): Promise<void> {
    await this.expectArmed();
    await this.latch.click();
    await this.expectMode("MOTION");
  }

  async expectArmed(): Promise<void> {
    await expect(this.page.getByText("· armed")).toBeVisible();
  }
}

/** What the console costs the network, the operator's computer and the app; see run.py for the limits. */
import { writeFileSync } from "node:fs";
import path from "node:path";
import type { CDPSession } from "@playwright/test";
import { ConsolePage } from "../../tests/browser/console_page";
import { firstLoad } from "../../tests/browser/first_load";
import { expect, test } from "../../tests/browser/fixtures";
import { reports } from "../../tests/browser/places";
import type { Stack } from "../../tests/browser/stack";

const minutes = Number(process.env.CONSOLE_MINUTES ?? "10");
const figuresFile = process.env.CONSOLE_FIGURES ?? path.join(reports, "console_figures.json");

const CONSOLES = 4;
const CPU_S = 30;
const SAMPLE_EVERY_S = 10;
/** Of the run, for caches and compiled code to settle. */
const WARM_UP_SHARE = 0.2;
const ROUNDS = 8;
/** What was painted sooner than this after an interaction is counted, but not reported one by one. */
const PROMPT_MS = 16;

/** What Chromium tells of an interaction, and TypeScript does not know yet. */
interface InteractionTiming extends PerformanceEntry {
  readonly interactionId: number;
}

test.use({ clock: "real" });
test.setTimeout((minutes + 15) * 60_000);

const figures: Record<string, number> = {};

test.afterAll(() => writeFileSync(figuresFile, JSON.stringify(figures)));

test("bytes of the first load", async ({ page, stack }) => {
  const { bytes, compressedBytes } = await firstLoad(page, stack);
  figures.first_load_compressed_bytes = compressedBytes;
  figures.first_load_bytes = bytes;
});

test("time from an interaction to the next paint, with every part of the panels open", async ({
  robot,
  page,
}) => {
  await unfold(robot);
  await page.evaluate((durationThreshold) => {
    const worst = new Map<number, number>();
    Object.assign(window, { worst });
    new PerformanceObserver((list) => {
      for (const entry of list.getEntries() as InteractionTiming[]) {
        const { interactionId: id, duration } = entry;
        if (id !== 0) worst.set(id, Math.max(duration, worst.get(id) ?? 0));
      }
    }).observe({ type: "event", durationThreshold } as PerformanceObserverInit);
  }, PROMPT_MS);
  for (let round = 0; round < ROUNDS; round++) await interact(robot);
  const [slow, count] = await page.evaluate(() => [
    [...(window as unknown as { worst: Map<number, number> }).worst.values()],
    (performance as unknown as { interactionCount: number }).interactionCount,
  ]);
  expect(count).toBeGreaterThan(ROUNDS);
  const prompt = Array<number>(Math.max(0, count - slow.length)).fill(PROMPT_MS);
  const all = sorted([...slow, ...prompt]);
  figures.interactions = all.length;
  figures.interaction_to_paint_ms_median = quantile(all, 0.5);
  figures.interaction_to_paint_ms_p98 = quantile(all, 0.98);
  figures.interaction_to_paint_ms_worst = quantile(all, 1);
});

test("memory of a page that stays open", async ({ robot, page }) => {
  await unfold(robot);
  const session = await page.context().newCDPSession(page);
  await session.send("Performance.enable");
  const heaps: number[] = [];
  const elements: number[] = [];
  const end = performance.now() + minutes * 60_000;
  const warm = performance.now() + WARM_UP_SHARE * minutes * 60_000;
  while (performance.now() < end) {
    await interact(robot);
    await page.waitForTimeout(SAMPLE_EVERY_S * 1000);
    if (performance.now() < warm) continue;
    await session.send("HeapProfiler.collectGarbage");
    heaps.push(await metric(session, "JSHeapUsedSize"));
    elements.push(await metric(session, "Nodes"));
  }
  figures.memory_minutes = minutes;
  figures.memory_heap_kib = Math.round(quantile(sorted(heaps), 0.5) / 1024);
  figures.memory_growth_kib = Math.round(growth(heaps) / 1024);
  figures.memory_growth_nodes = Math.round(growth(elements));
});

test("the app's processor time for four open consoles", async ({ browser, stack }) => {
  const idle = await appShare(stack);
  const contexts = await Promise.all(Array.from({ length: CONSOLES }, () => browser.newContext()));
  for (const context of contexts) {
    const page = await context.newPage();
    await page.goto(stack.url);
    const console = new ConsolePage(page);
    await console.logIn("admin", stack.password);
    await expect(console.panel("Motors")).toBeVisible();
  }
  const busy = await appShare(stack);
  await Promise.all(contexts.map((context) => context.close()));
  figures.app_cpu_percent_without_console = round(idle);
  figures.app_cpu_percent_with_four = round(busy);
  figures.app_cpu_percent_of_four = round(busy - idle);
});

async function unfold(robot: ConsolePage): Promise<void> {
  await robot.panel("Bench").getByText("More faults").click();
  const whys = robot.page.getByRole("button", { name: /^Why not moving\?/ });
  while ((await whys.count()) > 0) await whys.first().click();
}

/** What an operator does most, without leaving a trace. */
async function interact(robot: ConsolePage): Promise<void> {
  const { page } = robot;
  await robot.axis("Lateral").track.focus();
  for (let step = 0; step < 10; step++) await page.keyboard.press("ArrowRight");
  const field = robot.axis("Lateral").row.getByRole("textbox");
  await field.click();
  await page.keyboard.type("-12.5");
  await field.fill("");
  for (let press = 0; press < 2; press++) await robot.button("Keys").click();
  for (let press = 0; press < 2; press++) await robot.panel("Bench").getByText("More faults").click();
  for (const name of ["Codes", "Robot"] as const) await robot.open(name);
  await unfold(robot);
}

async function metric(session: CDPSession, name: string): Promise<number> {
  const { metrics } = await session.send("Performance.getMetrics");
  return metrics.find((each) => each.name === name)?.value ?? Number.NaN;
}

/** Percent of one core that the app takes, over some time. */
async function appShare(stack: Stack): Promise<number> {
  const [cpu, time] = [stack.appCpuS(), performance.now()];
  await new Promise((resolve) => setTimeout(resolve, CPU_S * 1000));
  return (100_000 * (stack.appCpuS() - cpu)) / (performance.now() - time);
}

const round = (value: number): number => Math.round(10 * value) / 10;
const sorted = (values: readonly number[]): number[] => [...values].sort((a, b) => a - b);

function quantile(ascending: readonly number[], share: number): number {
  return ascending[Math.min(ascending.length - 1, Math.floor(share * ascending.length))] ?? Number.NaN;
}

/** From the median of the first third to that of the last. */
function growth(values: readonly number[]): number {
  const third = Math.max(1, Math.floor(values.length / 3));
  return quantile(sorted(values.slice(-third)), 0.5) - quantile(sorted(values.slice(0, third)), 0.5);
}

/** What the console costs the network, the operator's computer and the app; see run.py for the limits. */
import { writeFileSync } from "node:fs";
import path from "node:path";
import type { CDPSession, Page } from "@playwright/test";
import { ConsolePage } from "../../tests/browser/console_page";
import { firstLoad } from "../../tests/browser/first_load";
import { expect, test } from "../../tests/browser/fixtures";
import { reports } from "../../tests/browser/places";
import type { Stack } from "../../tests/browser/stack";

const minutes = Number(process.env.CONSOLE_MINUTES ?? "10");
const figuresFile = process.env.CONSOLE_FIGURES ?? path.join(reports, "console_figures.json");

const CONSOLES = 4;
const CPU_S = 30;
const PAUSE_S = 10;
const SAMPLE_EVERY_S = 30;
/** Of the run, for caches and compiled code to settle. */
const WARM_UP_SHARE = 0.2;
const ROUNDS = 8;
/** Of history that the app keeps and the page takes in: until then its growth is no leak. */
const HISTORY_S = 130;
/** What was painted sooner than this after an interaction is counted, but not reported one by one. */
const PROMPT_MS = 16;

/** What Chromium tells of an interaction, and TypeScript does not know yet. */
interface InteractionTiming extends PerformanceEntry {
  readonly interactionId: number;
}

test.use({ clock: "realtime" });
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
  await watchInteractions(page);
  for (let round = 0; round < ROUNDS; round++) await interact(robot);
  await noteInteractions(page, "");
});

test("time from an interaction to the next paint, with every plot open", async ({ robot, page }) => {
  await openPlots(robot);
  await watchInteractions(page);
  for (let round = 0; round < ROUNDS; round++) await interactWithPlots(robot);
  await noteInteractions(page, "plots_");
});

test("memory of a page that stays open", async ({ robot, page }) => {
  await unfold(robot);
  await noteMemory(page, "", WARM_UP_SHARE * minutes * 60, () => interact(robot));
});

test("memory of the plots that stay open", async ({ robot, page }) => {
  await openPlots(robot);
  await noteMemory(page, "plots_", HISTORY_S, () => interactWithPlots(robot));
});

test("the app's processor time for four open consoles", async ({ browser, stack }) => {
  const idle = await appShare(stack);
  const contexts = await Promise.all(Array.from({ length: CONSOLES }, () => browser.newContext()));
  const consoles: ConsolePage[] = [];
  for (const context of contexts) {
    const page = await context.newPage();
    await page.goto(stack.url);
    const console = new ConsolePage(page, stack);
    await console.logIn("admin", stack.password);
    await expect(console.panel("Motors")).toBeVisible();
    consoles.push(console);
  }
  const busy = await appShare(stack);
  for (const console of consoles) await openPlots(console);
  const plotting = await appShare(stack);
  await Promise.all(contexts.map((context) => context.close()));
  figures.app_cpu_percent_without_console = round(idle);
  figures.app_cpu_percent_with_four = round(busy);
  figures.app_cpu_percent_of_four = round(busy - idle);
  figures.plots_app_cpu_percent_of_four = round(plotting - idle);
});

/** From now on the page keeps the longest time of each interaction that was not painted promptly. */
function watchInteractions(page: Page): Promise<void> {
  return page.evaluate((durationThreshold) => {
    const worst = new Map<number, number>();
    Object.assign(window, { worst });
    new PerformanceObserver((list) => {
      for (const entry of list.getEntries() as InteractionTiming[]) {
        const { interactionId: id, duration } = entry;
        if (id !== 0) worst.set(id, Math.max(duration, worst.get(id) ?? 0));
      }
    }).observe({ type: "event", durationThreshold } as PerformanceObserverInit);
  }, PROMPT_MS);
}

/** Counts in every interaction since the page was loaded: those before the watch were prompt or are not known. */
async function noteInteractions(page: Page, prefix: string): Promise<void> {
  const [slow, count] = await page.evaluate(() => [
    [...(window as unknown as { worst: Map<number, number> }).worst.values()],
    (performance as unknown as { interactionCount: number }).interactionCount,
  ]);
  expect(count).toBeGreaterThan(ROUNDS);
  const prompt = Array<number>(Math.max(0, count - slow.length)).fill(PROMPT_MS);
  const all = sorted([...slow, ...prompt]);
  figures[`${prefix}interactions`] = all.length;
  figures[`${prefix}interaction_to_paint_ms_median`] = quantile(all, 0.5);
  figures[`${prefix}interaction_to_paint_ms_p98`] = quantile(all, 0.98);
  figures[`${prefix}interaction_to_paint_ms_worst`] = quantile(all, 1);
}

/**
 * Uses the page for the minutes of the run; what grows until it is warm is not counted. Growth is that of what the page's
 * own program keeps. The whole heap has compiled code and, in a browser that is watched, a record of each request besides.
 */
async function noteMemory(
  page: Page,
  prefix: string,
  warmUpS: number,
  use: () => Promise<void>,
): Promise<void> {
  const session = await page.context().newCDPSession(page);
  await session.send("Performance.enable");
  const kept: number[] = [];
  const heaps: number[] = [];
  const elements: number[] = [];
  const warm = performance.now() + warmUpS * 1000;
  const end = warm + (1 - WARM_UP_SHARE) * minutes * 60_000;
  let next = warm;
  while (performance.now() < end) {
    await use();
    await page.waitForTimeout(PAUSE_S * 1000);
    if (performance.now() < next) continue;
    next += SAMPLE_EVERY_S * 1000;
    kept.push(await keptByPage(session));
    heaps.push(await metric(session, "JSHeapUsedSize"));
    elements.push(await metric(session, "Nodes"));
  }
  figures[`${prefix}memory_minutes`] = minutes;
  figures[`${prefix}memory_heap_kib`] = Math.round(quantile(sorted(heaps), 0.5) / 1024);
  figures[`${prefix}memory_heap_growth_kib`] = Math.round(growth(heaps) / 1024);
  figures[`${prefix}memory_kept_kib`] = Math.round(quantile(sorted(kept), 0.5) / 1024);
  figures[`${prefix}memory_growth_kib`] = Math.round(growth(kept) / 1024);
  figures[`${prefix}memory_growth_nodes`] = Math.round(growth(elements));
}

/** What Chromium tells of its heap: a row of numbers for each object. */
interface HeapSnapshot {
  readonly snapshot: {
    readonly meta: {
      readonly node_fields: readonly string[];
      readonly node_types: readonly [readonly string[]];
    };
  };
  readonly nodes: readonly number[];
}

/** Of a snapshot's kinds: what is there because the page's program holds on to it. */
const OWN_KINDS = ["object", "closure", "array", "string", "concatenated string", "sliced string", "regexp"];

/** Bytes of the objects, functions and texts that are left when everything unused has been collected. */
async function keptByPage(session: CDPSession): Promise<number> {
  const chunks: string[] = [];
  const take = ({ chunk }: { chunk: string }) => chunks.push(chunk);
  session.on("HeapProfiler.addHeapSnapshotChunk", take);
  await session.send("HeapProfiler.takeHeapSnapshot", { reportProgress: false });
  session.off("HeapProfiler.addHeapSnapshotChunk", take);
  const { snapshot, nodes } = JSON.parse(chunks.join("")) as HeapSnapshot;
  const { node_fields: fields, node_types: kinds } = snapshot.meta;
  const [kindAt, sizeAt] = [fields.indexOf("type"), fields.indexOf("self_size")];
  const own = new Set(OWN_KINDS.map((kind) => kinds[0].indexOf(kind)));
  let bytes = 0;
  for (let at = 0; at < nodes.length; at += fields.length)
    if (own.has(nodes[at + kindAt] ?? -1)) bytes += nodes[at + sizeAt] ?? 0;
  return bytes;
}

const chart = (robot: ConsolePage, title: string) =>
  robot.panel("Plots").getByRole("figure", { name: title }).getByRole("img");

/** Every plot of the page, over the longest time that it shows. */
async function openPlots(robot: ConsolePage): Promise<void> {
  const { page } = robot;
  await robot.open("Plots");
  await page.getByLabel("Last").selectOption("120");
  for (const title of ["Position", "Error", "Velocity", "Drive"])
    await expect(chart(robot, title)).toBeVisible();
  await expect(robot.panel("Loop time").getByRole("img").first()).toBeVisible();
}

/** Cursor, zoom, pause, another axis, all while the plots follow the robot. */
async function interactWithPlots(robot: ConsolePage): Promise<void> {
  const { page } = robot;
  const position = chart(robot, "Position");
  await position.focus();
  for (let step = 0; step < 10; step++) await page.keyboard.press("ArrowRight");
  await page.keyboard.press("+");
  await page.keyboard.press("-");
  await position.dblclick({ position: { x: 200, y: 40 } });
  const pause = robot.panel("Plots").getByRole("button", { name: /Pause/ });
  for (let press = 0; press < 2; press++) await pause.click();
  const axis = page.getByRole("combobox", { name: "Axis", exact: true });
  await axis.focus();
  await page.keyboard.press("ArrowDown");
  await expect(chart(robot, "Drive")).toBeVisible();
  await axis.focus();
  await page.keyboard.press("ArrowUp");
  await page.getByLabel("Last").selectOption("120");
}

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

import { test as base, expect, type Page } from "@playwright/test";
import { ConsolePage } from "./console_page";
import { type Clock, type RobotName, Stack } from "./stack";

/** What Chromium reports on its console by design: refused requests, an app that is gone or has no kernel yet, a network that is cut, a slow picture. */
const expectedComplaint =
  /status of (401|403|404|409|422|429|503)|ERR_CONNECTION_|ERR_INTERNET_DISCONNECTED|GPU stall due to ReadPixels/;

interface Fixtures {
  robotName: RobotName;
  clock: Clock;
  /** Text of a file of a plant in place of the robot's own. */
  plant: string | undefined;
  /** By so much more a page is patient with the app than it is by itself, so that no slow machine makes it give up. */
  patience: number;
  stack: Stack;
  /** The console before login. */
  front: ConsolePage;
  /** The console of the administrator, who is in control. */
  robot: ConsolePage;
  /** Another browser, before login. */
  other: ConsolePage;
}

/** Each test has a robot of its own, and fails when a page breaks a rule of its content policy or throws. */
export const test = base.extend<Fixtures>({
  robotName: ["neuro", { option: true }],
  clock: ["paced", { option: true }],
  plant: [undefined, { option: true }],
  patience: [20, { option: true }],
  stack: async ({ robotName, clock, plant }, use) => {
    const stack = await Stack.start(robotName, clock, plant);
    await use(stack);
    await stack.end();
  },
  front: async ({ page, stack, patience }, use) => {
    await openConsole(page, stack, patience, use);
  },
  robot: async ({ front, stack }, use) => {
    await front.logIn("admin", stack.password);
    await front.takeControl();
    await use(front);
  },
  other: async ({ browser, stack, patience }, use) => {
    const context = await browser.newContext();
    await openConsole(await context.newPage(), stack, patience, use);
    await context.close();
  },
});

async function openConsole(
  page: Page,
  stack: Stack,
  patience: number,
  use: (opened: ConsolePage) => Promise<void>,
): Promise<void> {
  const complaints: string[] = [];
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("console", (message) => {
    const serious = message.type() === "error" || message.type() === "warning";
    if (serious && !expectedComplaint.test(message.text())) complaints.push(message.text());
  });
  await page.addInitScript((factor) => {
    const timeout = AbortSignal.timeout.bind(AbortSignal);
    AbortSignal.timeout = (ms) => timeout(factor * ms);
  }, patience);
  await page.goto(stack.url);
  await use(new ConsolePage(page, stack));
  expect(complaints).toEqual([]);
}

export { expect };

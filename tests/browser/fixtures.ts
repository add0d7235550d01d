import { test as base, expect } from "@playwright/test";
import { ConsolePage } from "./console_page";
import { Stack } from "./stack";

/** What Chromium reports on its console by design: refused requests, an app that is gone or has no kernel yet. */
const expectedComplaint = /status of (409|422|503)|ERR_CONNECTION_/;

interface Fixtures {
  stack: Stack;
  robot: ConsolePage;
}

/** Each test has a robot of its own, and fails when the page breaks a rule of its content policy or throws. */
export const test = base.extend<Fixtures>({
  // biome-ignore lint/correctness/noEmptyPattern: Playwright finds the fixtures that a fixture needs in this pattern.
  stack: async ({}, use) => {
    const stack = await Stack.start();
    await use(stack);
    await stack.end();
  },
  robot: async ({ page, stack }, use) => {
    const complaints: string[] = [];
    page.on("pageerror", (error) => complaints.push(String(error)));
    page.on("console", (message) => {
      const serious = message.type() === "error" || message.type() === "warning";
      if (serious && !expectedComplaint.test(message.text())) complaints.push(message.text());
    });
    await page.goto(stack.url);
    await use(new ConsolePage(page));
    expect(complaints).toEqual([]);
  },
});

export { expect };

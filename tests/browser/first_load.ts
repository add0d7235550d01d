/** What a browser fetches when it opens the console for the first time. */
import { expect, type Page, type Response } from "@playwright/test";
import { ConsolePage } from "./console_page";
import type { Stack } from "./stack";

export interface FirstLoad {
  readonly files: readonly string[];
  readonly bytes: number;
  /** As they were sent, with the headers of each answer. */
  readonly compressedBytes: number;
  /** Requests to anywhere but the app. */
  readonly foreign: readonly string[];
}

/** Opens the console and logs in. Whatever is asked of another origin gets no answer. */
export async function firstLoad(page: Page, stack: Stack): Promise<FirstLoad> {
  const foreign: string[] = [];
  const fetched = new Map<string, Response>();
  const own = new URL(stack.url).origin;
  await page.route("**/*", (route) => {
    const { origin, href } = new URL(route.request().url());
    if (origin === own) return route.continue();
    foreign.push(href);
    return route.abort();
  });
  page.on("response", (response) => {
    const { pathname } = new URL(response.url());
    if (!pathname.startsWith("/api/")) fetched.set(pathname, response);
  });
  const kernel = page.waitForEvent("response", (response) => response.url().endsWith(".wasm"));
  await page.goto(stack.url);
  const console = new ConsolePage(page, stack);
  await console.logIn("admin", stack.password);
  await expect(console.panel("Motors")).toBeVisible();
  await expect(console.mode).toContainText("LOCKED");
  await kernel;
  await page.evaluate(() => document.fonts.ready.then(() => undefined));
  const answers = [...fetched.values()];
  const bodies = await Promise.all(answers.map((answer) => answer.body()));
  const sizes = await Promise.all(answers.map((answer) => answer.request().sizes()));
  return {
    files: [...fetched.keys()],
    bytes: bodies.reduce((sum, body) => sum + body.length, 0),
    compressedBytes: sizes.reduce((sum, size) => sum + size.responseHeadersSize + size.responseBodySize, 0),
    foreign,
  };
}

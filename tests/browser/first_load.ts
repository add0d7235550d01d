/** What a browser fetches when it opens the console for the first time. */
import { gzipSync } from "node:zlib";
import { expect, type Page } from "@playwright/test";
import { ConsolePage } from "./console_page";
import type { Stack } from "./stack";

export interface FirstLoad {
  readonly files: readonly string[];
  readonly bytes: number;
  /** By gzip, file by file. */
  readonly compressedBytes: number;
  /** Requests to anywhere but the app. */
  readonly foreign: readonly string[];
}

/** Opens the console and logs in. Whatever is asked of another origin gets no answer. */
export async function firstLoad(page: Page, stack: Stack): Promise<FirstLoad> {
  const foreign: string[] = [];
  const fetched = new Map<string, Promise<Buffer>>();
  const own = new URL(stack.url).origin;
  await page.route("**/*", (route) => {
    const { origin, href } = new URL(route.request().url());
    if (origin === own) return route.continue();
    foreign.push(href);
    return route.abort();
  });
  page.on("response", (response) => {
    const { pathname } = new URL(response.url());
    if (!pathname.startsWith("/api/")) fetched.set(pathname, response.body());
  });
  const kernel = page.waitForEvent("response", (response) => response.url().endsWith(".wasm"));
  await page.goto(stack.url);
  const console = new ConsolePage(page, stack);
  await console.logIn("admin", stack.password);
  await expect(console.panel("Motors")).toBeVisible();
  await expect(console.mode).toContainText("LOCKED");
  await kernel;
  await page.evaluate(() => document.fonts.ready.then(() => undefined));
  const bodies = await Promise.all(fetched.values());
  return {
    files: [...fetched.keys()],
    bytes: bodies.reduce((sum, body) => sum + body.length, 0),
    compressedBytes: bodies.reduce((sum, body) => sum + gzipSync(body).length, 0),
    foreign,
  };
}

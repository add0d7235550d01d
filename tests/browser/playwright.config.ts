import { defineConfig } from "@playwright/test";
import { reports } from "./places";

/**
 * Debian's Chromium against the real processes on the paced clock. Each test has a robot of its own, on a port of its own,
 * so that two run side by side, whichever file they are in. The limits only end a run that hangs: what is waited for is an
 * event, on a machine however busy.
 */
export default defineConfig({
  testDir: ".",
  outputDir: `${reports}/browser`,
  workers: 2,
  fullyParallel: true,
  retries: 0,
  forbidOnly: true,
  timeout: 900_000,
  expect: { timeout: 180_000 },
  reporter: [["list"], ["junit", { outputFile: `${reports}/browser.xml` }]],
  use: {
    viewport: { width: 1280, height: 800 },
    colorScheme: "dark",
    locale: "en-GB",
    timezoneId: "UTC",
    screenshot: "only-on-failure",
    launchOptions: {
      executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium-headless-shell",
      args: [
        "--no-sandbox",
        "--disable-gpu",
        "--no-first-run",
        "--disable-background-networking",
        "--disable-component-update",
        "--disable-sync",
      ],
    },
  },
});

import { defineConfig } from "@playwright/test";
import base from "../../tests/browser/playwright.config";

/** Measurements and pictures of the console: one browser at a time, none of them part of the tests. */
export default defineConfig({
  ...base,
  testDir: ".",
  testMatch: "*.measure.ts",
  workers: 1,
  // A test of these lasts many minutes, and without a limit one action that never ends would take them all.
  use: { ...base.use, actionTimeout: 30_000 },
  reporter: [["line"]],
});

import react from "@vitejs/plugin-react";
import { defineConfig } from "vitest/config";
import { compress } from "./compress.ts";

const app = process.env.INTERLOCK_APP ?? "http://127.0.0.1:8080";

export default defineConfig({
  plugins: [react(), compress()],
  build: {
    // The content security policy allows files of our own origin only: nothing may be inlined as a data URL.
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    target: "es2023",
  },
  server: { proxy: { "/api": { target: app, ws: true } } },
  test: {
    environment: "node",
    include: ["src/**/*.test.ts"],
    // Only ends a run that hangs.
    testTimeout: 300_000,
  },
});

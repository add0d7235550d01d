/** What the console may weigh, and that it needs no network. Times and memory: verification/console. */

import { firstLoad } from "./first_load";
import { expect, test } from "./fixtures";

const LARGEST_FIRST_LOAD_BYTES = 250_000;

test("the first load is light, and asks nothing of any other computer", async ({ page, stack }) => {
  const { files, compressedBytes, foreign } = await firstLoad(page, stack);
  const scripts = files.filter((file) => file.endsWith(".js"));
  expect(scripts.some((file) => file.startsWith("/assets/index-"))).toBe(true);
  expect(
    scripts.filter((file) => /\/(View|Plots|Proposals|Runs|Targeting|Tuning|Workflow)Page-/.test(file)),
  ).toEqual([]);
  expect(files.filter((file) => file.endsWith(".wasm"))).toHaveLength(1);
  expect(foreign).toEqual([]);
  expect(compressedBytes).toBeLessThanOrEqual(LARGEST_FIRST_LOAD_BYTES);
});

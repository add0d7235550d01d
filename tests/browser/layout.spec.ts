/** The panels where a user wants them. */
import type { Page } from "@playwright/test";
import { knownBy, type PageName } from "./console_page";
import { expect, test } from "./fixtures";

const password = "correct horse battery";

/** The titles in the order of the page, which is the order of Tab and of a screen reader. */
const titles = (page: Page): Promise<string[]> =>
  page.getByRole("main").locator(".panel h2").allTextContents();

test("panels are moved and folded by keys, and come back so for that user alone", async ({
  robot,
  other,
  page,
}) => {
  await robot.addUser("ann", "engineer", password);
  const before = await titles(page);
  await robot.button("Arrange").click();
  await robot.button("Move Status up").focus();
  await page.keyboard.press("Enter");
  await page.keyboard.press("Enter");
  await expect(robot.button("Move Status up")).toBeFocused();
  await robot.button("Move Proposals to the other column").press("Enter");
  await expect(robot.button("Move Proposals to the other column")).toBeFocused();
  await robot.button("Fold Log").press("Enter");
  await robot.button("Arrange").click();
  const arranged = ["Motors", "Log", "Communication", "Navigation", "Proposals", "Bench", "Status"];
  const expected = [...arranged, ...before.filter((title) => !arranged.includes(title))];
  expect(await titles(page)).toEqual(expected);
  await expect(robot.panel("Log").getByRole("list")).toHaveCount(0);

  await page.reload();
  await expect(robot.panel("Log").getByRole("button", { name: "Unfold Log" })).toBeVisible();
  await expect.poll(() => titles(page)).toEqual(expected);
  await other.logIn("ann", password);
  await expect.poll(() => titles(other.page)).toEqual(before);
});

test.describe("under fingers", () => {
  test.use({ hasTouch: true, isMobile: true, viewport: { width: 1280, height: 800 } });

  test("everything that is pressed is 44 px high, and no page scrolls sideways", async ({ robot, page }) => {
    await robot.panel("Bench").getByText("More faults").click();
    for (const name of Object.keys(knownBy) as PageName[]) {
      await robot.open(name);
      // Polled, as the page before may still be there.
      const low = (): Promise<(string | null)[]> =>
        page
          .locator("button:visible, select:visible")
          .evaluateAll((controls) =>
            controls
              .filter((control) => control.getBoundingClientRect().height < 44)
              .map((control) => control.getAttribute("aria-label") ?? control.textContent),
          );
      await expect.poll(low, name).toEqual([]);
      const wide = await page.evaluate(() => document.documentElement.scrollWidth);
      expect(wide, name).toBeLessThanOrEqual(1280);
    }
  });
});

/** Of what can be pressed or typed into, what something else lies over, or the page's edge cuts. */
const unreachable = (page: Page): Promise<string[]> =>
  page.evaluate(() => {
    const controls = document.querySelectorAll(
      "button, a[href], input, select, textarea, summary, [role=slider]",
    );
    return [...controls].flatMap((control) => {
      if (!control.checkVisibility({ visibilityProperty: true })) return [];
      control.scrollIntoView({ block: "center", inline: "nearest" });
      const { left, top, width, height } = control.getBoundingClientRect();
      const hit = document.elementFromPoint(left + width / 2, top + height / 2);
      const own =
        hit !== null &&
        (control.contains(hit) || hit.contains(control) || hit.closest("label")?.contains(control));
      const name = control.getAttribute("aria-label") ?? control.textContent;
      return own
        ? []
        : [`${control.tagName} "${name}" at ${left},${top} under ${hit?.outerHTML.slice(0, 80)}`];
    });
  });

for (const robotName of ["neuro", "prostate"] as const) {
  test.describe(`on the ${robotName}, at every width`, () => {
    test.use({ robotName });

    test("no page scrolls sideways, and each control is hit at its centre", async ({ robot, page }) => {
      test.setTimeout(300_000);
      await robot.button("Pull E-stop").click();
      await expect(page.locator(".alarm-line[data-priority=high]")).toBeVisible();
      // 640: a laptop's 1280 at 200 %.
      for (const width of [360, 640, 768, 1024, 1280, 1600, 3840]) {
        await page.setViewportSize({ width, height: Math.max(740, Math.round(width * 0.6)) });
        for (const name of Object.keys(knownBy) as PageName[]) {
          await robot.open(name);
          const where = `${name} at ${width}`;
          await expect.poll(() => unreachable(page), { message: where, timeout: 20_000 }).toEqual([]);
          const wide = await page.evaluate(() => document.documentElement.scrollWidth);
          expect(wide, where).toBeLessThanOrEqual(width);
        }
      }
    });
  });
}

/** Someone who uses the console by the keyboard alone, and looks where the focus is. */
import { expect, type Locator, type Page } from "@playwright/test";

const MOST_STOPS = 400;

/** What has the focus: how it is called, and what is wrong with how that shows; null when nothing is. */
interface Stop {
  readonly name: string;
  readonly fault: string | null;
}

export class Keyboard {
  constructor(private readonly page: Page) {}

  /** Goes by Tab, or back, until `wanted` has the focus: as far as the order of the page says, and then looks. */
  async reach(wanted: Locator): Promise<void> {
    await expect(async () => {
      const stops = await wanted.evaluate(stopsAhead);
      for (let stop = 0; stop < Math.abs(stops); stop++)
        await this.page.keyboard.press(stops > 0 ? "Tab" : "Shift+Tab");
      expect(await wanted.evaluate(stopsAhead)).toBe(0);
    }).toPass();
  }

  async press(wanted: Locator, key: "Enter" | "Space" = "Enter"): Promise<void> {
    await expect(wanted).toBeEnabled();
    await this.reach(wanted);
    await this.page.keyboard.press(key);
  }

  async type(field: Locator, text: string): Promise<void> {
    await this.reach(field);
    await this.page.keyboard.type(text);
  }

  /** Every stop of Tab on the page, once around. */
  async stops(): Promise<Stop[]> {
    const found: Stop[] = [];
    await this.page.evaluate(fromTheTop);
    for (let stops = 0; stops < MOST_STOPS; stops++) {
      await this.page.keyboard.press("Tab");
      const stop = await this.page.evaluate(lookAtFocus);
      if (stop === null) return found;
      found.push(stop);
    }
    throw new Error(`Tab does not come around within ${MOST_STOPS} stops`);
  }
}

/**
 * Runs in the page. How many stops of Tab there are from the focus to an element; negative when it lies behind. A list
 * that scrolls is a stop, too, so this may be less than there are.
 */
function stopsAhead(wanted: Element): number {
  const kinds = 'a[href], button:enabled, input:enabled, select:enabled, summary, [tabindex="0"]';
  const stops = [...document.querySelectorAll(kinds)].filter((element) => element.checkVisibility());
  const focused = document.activeElement ?? document.body;
  const before = stops.filter(
    (stop) => focused.compareDocumentPosition(stop) & Node.DOCUMENT_POSITION_PRECEDING,
  );
  return stops.indexOf(wanted) - (stops.includes(focused) ? before.length : before.length - 1);
}

/** Runs in the page. Taking the focus away is not enough: Tab would go on from where it was. */
function fromTheTop(): void {
  document.body.tabIndex = -1;
  document.body.focus();
  document.body.removeAttribute("tabindex");
}

/** Runs in the page. Null when the focus has left the page's elements. */
function lookAtFocus(): Stop | null {
  const focused = document.activeElement;
  if (focused === null || focused === document.body) return null;
  const name = focused.getAttribute("aria-label") ?? focused.textContent?.trim() ?? focused.tagName;
  const ringed = [focused, focused.parentElement].some((element) => {
    if (element === null) return false;
    const { outlineStyle, outlineWidth } = getComputedStyle(element);
    return outlineStyle !== "none" && Number.parseFloat(outlineWidth) >= 2;
  });
  if (!ringed) return { name, fault: "no ring around it" };
  const box = focused.getBoundingClientRect();
  const top = document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2);
  const seen = top !== null && (focused.contains(top) || top.contains(focused));
  return { name, fault: seen ? null : `hidden under ${top?.className ?? "the edge of the window"}` };
}

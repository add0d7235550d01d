import { describe, expect, it } from "vitest";
import {
  canMove,
  chosenLayout,
  defaultLayout,
  moved,
  type PanelName,
  rememberLayout,
  withFolded,
} from "./layout";
import type { Shelf } from "./shelf";

const shown: PanelName[] = [...defaultLayout.main, "bench", "proposals", "why", "status"];

function holding(text: string): Shelf {
  return { getItem: () => text, setItem: () => undefined };
}

describe("the layout", () => {
  it("is remembered for each user", () => {
    const stored = new Map<string, string>();
    const shelf: Shelf = {
      getItem: (key) => stored.get(key) ?? null,
      setItem: (key, value) => void stored.set(key, value),
    };
    const arranged = withFolded(moved(defaultLayout, "status", "across", shown), "log", true);
    rememberLayout(shelf, "ann", arranged);
    expect([chosenLayout(shelf, "ann"), chosenLayout(shelf, "bob")]).toEqual([arranged, defaultLayout]);
  });

  it.each(["", "no JSON", "null", "[]", '{"main": 3, "side": "log", "folded": {}}', '{"main": ["nothing"]}'])(
    "is that of the beginning where %j is stored",
    (text) => expect(chosenLayout(holding(text), "ann")).toEqual(defaultLayout),
  );

  it("has every panel once and wide ones in the main column, whatever is stored", () => {
    const text =
      '{"main": ["why", "why", "motors"], "side": ["why", "log", "status"], "folded": ["why", 7, "motors"]}';
    const { main, side, folded } = chosenLayout(holding(text), "ann");
    expect(main).toEqual(["why", "motors", "log", "communication", "navigation"]);
    expect(side).toEqual(["status", "bench", "biopsy", "proposals"]);
    expect(folded).toEqual(["why"]);
  });
});

describe("moved", () => {
  it("passes the next panel that is shown", () => {
    const { side } = moved(defaultLayout, "proposals", "up", shown);
    expect(side).toEqual(["proposals", "bench", "biopsy", "why", "status"]);
    expect(moved({ ...defaultLayout, side }, "proposals", "down", shown).side).toEqual([
      "bench",
      "proposals",
      "biopsy",
      "why",
      "status",
    ]);
  });

  it("goes across and back, but not with a wide panel, and not beyond an end", () => {
    const across = moved(defaultLayout, "why", "across", shown);
    expect([across.main.at(-1), across.side.includes("why")]).toEqual(["why", false]);
    expect(moved(across, "why", "across", shown).side.at(-1)).toBe("why");
    expect(canMove(defaultLayout, "motors", "across", shown)).toBe(false);
    expect(canMove(defaultLayout, "motors", "up", shown)).toBe(false);
    expect(canMove(defaultLayout, "bench", "up", shown)).toBe(false);
    expect(canMove(defaultLayout, "status", "down", shown)).toBe(false);
  });
});

import { describe, expect, it } from "vitest";
import type { Shelf } from "./shelf";
import { chosenTheme, nextTheme, rememberTheme } from "./theme";

function shelf(): Shelf {
  const kept = new Map<string, string>();
  return { getItem: (key) => kept.get(key) ?? null, setItem: (key, value) => void kept.set(key, value) };
}

const broken: Shelf = {
  getItem: () => {
    throw new Error("no storage");
  },
  setItem: () => {
    throw new Error("no storage");
  },
};

describe("the theme", () => {
  it("is remembered for each user", () => {
    const kept = shelf();
    rememberTheme(kept, "ann", "dark");
    expect([chosenTheme(kept, "ann"), chosenTheme(kept, "bob")]).toEqual(["dark", "system"]);
  });

  it("is the computer's where nothing can be stored, or something else was", () => {
    rememberTheme(broken, "ann", "dark");
    expect(chosenTheme(broken, "ann")).toBe("system");
    expect(chosenTheme({ ...shelf(), getItem: () => "purple" }, "ann")).toBe("system");
  });

  it("goes round", () => {
    expect([nextTheme("system"), nextTheme("light"), nextTheme("dark")]).toEqual(["light", "dark", "system"]);
  });
});

import { describe, expect, it } from "vitest";
import {
  draftOf,
  hasNews,
  isChanged,
  isEdited,
  kept,
  numbersOf,
  received,
  taken,
  valuesOf,
  withText,
  withValues,
} from "./draft";

const point = draftOf([5, 200, 60]);
const edited = withText(point, 2, "61.5");

describe("a group that nobody edits", () => {
  it("follows what arrives", () => {
    expect(received(point, [1, 2, 3]).text).toEqual(["1", "2", "3"]);
  });

  it("has nothing to send", () => {
    expect(isChanged(point)).toBe(false);
  });

  it("is not edited by the same number written otherwise", () => {
    expect(isEdited(withText(point, 0, " 5.00 "))).toBe(false);
  });

  it("keeps what is typed on its way to a number", () => {
    const typing = withText(point, 0, "5.");
    expect(received(typing, [5, 200, 60]).text[0]).toBe("5.");
  });
});

describe("a group that is edited", () => {
  it("is not overwritten by what arrives, and has news", () => {
    const later = received(edited, [5, 190, 60]);
    expect(later.text).toEqual(["5", "200", "61.5"]);
    expect(hasNews(edited)).toBe(false);
    expect(hasNews(later)).toBe(true);
  });

  it("takes what arrived when asked to", () => {
    const later = taken(received(edited, [5, 190, 60]));
    expect(later.text).toEqual(["5", "190", "60"]);
    expect(isEdited(later)).toBe(false);
  });

  it("keeps what was edited when asked to, until something else arrives", () => {
    const later = kept(received(edited, [5, 190, 60]));
    expect(hasNews(later)).toBe(false);
    expect(isChanged(later)).toBe(true);
    expect(valuesOf(later)).toEqual([5, 200, 61.5]);
    expect(hasNews(received(later, [5, 180, 60]))).toBe(true);
  });

  it("is done when the app tells what was typed", () => {
    const later = received(edited, [5, 200, 61.5]);
    expect(isEdited(later)).toBe(false);
    expect(isChanged(later)).toBe(false);
  });

  it("has no news when the app comes back to where the editing began", () => {
    const there = received(edited, [5, 190, 60]);
    expect(hasNews(received(there, [5, 200, 60]))).toBe(false);
  });

  it("has nothing to send once the app has the same", () => {
    const meanwhile = { ...edited, arrived: [5, 200, 61.5] };
    expect(isChanged(meanwhile)).toBe(false);
  });
});

describe("values", () => {
  it("keep the digits that are not shown where nothing was edited", () => {
    const exact = draftOf([0.123456789, 1]);
    expect(valuesOf(withText(exact, 1, "2"))).toEqual([0.123456789, 2]);
  });

  it("are none while a text is no number", () => {
    expect(numbersOf(withText(point, 0, "abc"))).toBeNull();
    expect(isChanged(withText(point, 0, "abc"))).toBe(true);
  });

  it("that were never set are empty, and are not edited by being so", () => {
    const unset = draftOf([null, null, null]);
    expect(unset.text).toEqual(["", "", ""]);
    expect(isEdited(unset)).toBe(false);
    expect(isEdited(withText(unset, 0, "1"))).toBe(true);
  });

  it("of a file are edits, not what the app has", () => {
    const loaded = withValues(point, [1, 2, 3]);
    expect(loaded.arrived).toEqual([5, 200, 60]);
    expect(isChanged(loaded)).toBe(true);
  });
});

import { describe, expect, it } from "vitest";
import { fileName, MOST_BYTES, readPositions } from "./file";

describe("readPositions", () => {
  it("hands over any JSON object: the app judges it", () => {
    expect(readPositions("a.json", '{"format":"other"}')).toEqual({ ok: true, file: { format: "other" } });
  });

  it.each([
    ["a picture", "\u0089PNG\r\n", "is no JSON"],
    ["an empty file", "", "is no JSON"],
    ["a list", "[1]", "holds no JSON object"],
    ["null", "null", "holds no JSON object"],
    ["a huge file", " ".repeat(MOST_BYTES + 1), "is longer than 64 KiB"],
  ])("refuses %s with its name, the reason and the next step", (_, text, reason) => {
    const answer = readPositions("holiday.png", text);
    expect(answer).toMatchObject({ ok: false, notice: { code: "POSITIONS_FILE" } });
    expect(answer.ok ? "" : answer.notice.meaning).toContain(`holiday.png ${reason}`);
    expect(answer.ok ? "" : answer.notice.nextStep).not.toBe("");
  });
});

describe("fileName", () => {
  it("tells robot and time", () => {
    const file = { robot: "neuro", saved: "2026-11-21T14:05:09.123Z" };
    expect(fileName(file)).toBe("neuro-positions-20261121T140509Z.json");
  });

  it("holds nothing that leads elsewhere", () => {
    expect(fileName({ robot: "../up", saved: "x/y" })).toBe("___up-positions-.json");
  });
});

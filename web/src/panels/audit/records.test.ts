import { describe, expect, it } from "vitest";
import type { AuditRecord } from "../../api/client";
import { detailText, mergeRecords, recordsCsv } from "./records";

const record = (number: number): AuditRecord => ({ number }) as AuditRecord;

describe("mergeRecords", () => {
  it("puts pages that overlap in one list, newest first", () => {
    const merged = mergeRecords([record(5), record(4)], [record(3), record(4), record(6)]);
    expect(merged.map(({ number }) => number)).toEqual([6, 5, 4, 3]);
  });
});

describe("detailText", () => {
  it("says every field, texts plainly", () => {
    expect(detailText({ user: "ann", axes: [1, 2], enabled: false, old: null })).toBe(
      "user ann, axes [1,2], enabled false, old null",
    );
  });

  it("is empty without detail", () => {
    expect(detailText({})).toBe("");
  });
});

describe("recordsCsv", () => {
  it("quotes what a field may have in it, oldest first", () => {
    const second = { ...record(2), actor: 'a "b", c', detail: { text: "x" }, tick: null } as AuditRecord;
    expect(recordsCsv([second, record(1)]).split("\r\n")).toEqual([
      "number,time,tick,actor,session,kind,detail,hash",
      "1,,,,,,,",
      '2,,,"a ""b"", c",,,"{""text"":""x""}",',
      "",
    ]);
  });
});

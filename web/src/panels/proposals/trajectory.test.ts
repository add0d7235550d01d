import { describe, expect, it } from "vitest";
import type { Problem } from "../../api/client";
import { wrongRow } from "./trajectory";

const text = "time [s],yaw [rad],insertion [mm]\r\n0,-0.1,1\r\n1,-0.4,5000\r\n";
const problem = (line: number | undefined, field?: string): Problem =>
  ({ code: "OUT_OF_RANGE", detail: "", line, field }) as Problem;

describe("wrongRow", () => {
  it("marks the cell of the column and line that the app named", () => {
    const row = wrongRow(text, problem(3, "insertion [mm]"));
    expect(row?.line).toBe(3);
    expect(row?.cells).toEqual([
      { column: "time [s]", text: "1", wrong: false },
      { column: "yaw [rad]", text: "-0.4", wrong: false },
      { column: "insertion [mm]", text: "5000", wrong: true },
    ]);
  });

  it("marks a cell that is missing, and one that has no head", () => {
    expect(wrongRow("a,b\n1\n", problem(2, "b"))?.cells).toEqual([
      { column: "a", text: "1", wrong: false },
      { column: "b", text: "", wrong: true },
    ]);
    const beyond = wrongRow("a,b\n1,2,3\n", problem(2, "column 3"))?.cells[2];
    expect(beyond).toEqual({ column: "column 3", text: "3", wrong: true });
  });

  it("marks the header's own cell, and the line as a whole where no column is named", () => {
    expect(wrongRow("time [s],elbow [rad]\n0,0\n", problem(1, "elbow [rad]"))?.cells[1]?.wrong).toBe(true);
    expect(wrongRow(text, problem(2))?.whole).toBe(true);
  });

  it("shows nothing that the file has not", () => {
    expect(wrongRow(text, problem(undefined, "yaw [rad]"))).toBeNull();
    expect(wrongRow(text, problem(9))).toBeNull();
  });

  it("cuts a line with a thousand columns to those around the wrong one", () => {
    const head = Array.from({ length: 1000 }, (_, index) => `c${index}`).join(",");
    const cells = wrongRow(`${head}\n`, problem(1, "c500"))?.cells ?? [];
    expect(cells.length).toBe(24);
    expect(cells.find(({ wrong }) => wrong)?.text).toBe("c500");
  });
});

/** A pose from a file or the clipboard. Reads numbers; whether they are rigid is for `poseProblems` to say. */
import { numberIn } from "./numbers";

/** No pose needs more. */
export const MOST_CHARACTERS = 64 * 1024;

export type ReadPose =
  | { readonly ok: true; readonly pose: readonly number[] }
  /** What is wrong, where, what was expected. */
  | { readonly ok: false; readonly problem: string };

const EXPECTED = "expected 16 numbers, four rows of four, in the scanner's frame (RAS), mm";

/** JSON (16 numbers, four rows of four, or an object with them as `registration`), or the numbers as text. */
export function readPose(text: string): ReadPose {
  if (text.length > MOST_CHARACTERS) return wrong(`It is longer than ${MOST_CHARACTERS / 1024} KiB`);
  if (/^#Insight Transform File/i.test(text.trimStart())) {
    // It would be a mirrored and inverted registration that looks like a right one.
    return {
      ok: false,
      problem:
        "It is an ITK transform file, which counts in LPS and from the robot's side; " +
        "expected the matrix as the scanner's program shows it, in RAS, as text or JSON.",
    };
  }
  return /^\s*[[{]/.test(text) ? fromJson(text) : fromText(text);
}

function fromJson(text: string): ReadPose {
  let value: unknown;
  try {
    value = JSON.parse(text);
  } catch {
    return wrong("It begins like JSON and is none");
  }
  const matrix = Array.isArray(value) ? value : namedIn(value);
  if (matrix === null) return wrong('It is an object without a list "registration"');
  return judged(matrix.flat(), (at) => `Number ${at + 1}`);
}

function namedIn(value: unknown): unknown[] | null {
  const named =
    typeof value === "object" && value !== null && "registration" in value ? value.registration : null;
  return Array.isArray(named) ? named : null;
}

function fromText(text: string): ReadPose {
  const lines = text.split("\n").map((line) => line.replace(/[#%].*/, ""));
  const found = lines.flatMap((line, at) =>
    line
      .split(/[\s,;]+/)
      .filter((word) => word !== "")
      .map((word) => ({ word, line: at + 1 })),
  );
  return judged(
    found.map(({ word }) => word),
    (at) => `Line ${found[at]?.line ?? 1}`,
  );
}

function judged(found: readonly unknown[], where: (at: number) => string): ReadPose {
  const pose: number[] = [];
  for (const [at, each] of found.entries()) {
    const value = typeof each === "number" ? each : typeof each === "string" ? numberIn(each) : null;
    if (value === null) return wrong(`${where(at)}: ${JSON.stringify(each)} is no number`);
    pose.push(value);
  }
  if (pose.length !== 16) return wrong(`It has ${pose.length} ${pose.length === 1 ? "number" : "numbers"}`);
  const last = pose.slice(12);
  if (last.join() !== "0,0,0,1") {
    return wrong(`Its last row is ${last.join(" ")} instead of 0 0 0 1: is it written column by column`, "?");
  }
  return { ok: true, pose };
}

function wrong(what: string, end = ""): ReadPose {
  return { ok: false, problem: end === "?" ? `${what}? ${capital(EXPECTED)}.` : `${what}; ${EXPECTED}.` };
}

function capital(words: string): string {
  return words.charAt(0).toUpperCase() + words.slice(1);
}

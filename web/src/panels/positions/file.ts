/** The file of saved positions, on its way to and from the operator's disk. The app judges what is in it. */
import type { PositionsFile } from "../../api/client";
import type { Notice } from "../../state/notice";

/** The app takes no larger body. */
export const MOST_BYTES = 64 * 1024;

export type ReadFile = { ok: true; file: unknown } | { ok: false; notice: Notice };

/** Reads what was chosen or dropped; what is no JSON at all is refused here, in words. */
export function readPositions(name: string, text: string): ReadFile {
  if (text.length > MOST_BYTES) {
    return refused(name, `is longer than ${MOST_BYTES / 1024} KiB and so no file of saved positions.`);
  }
  try {
    const file: unknown = JSON.parse(text);
    if (typeof file === "object" && file !== null && !Array.isArray(file)) return { ok: true, file };
  } catch {
    return refused(name, "is no JSON and so no file of saved positions.");
  }
  return refused(name, "holds no JSON object and so is no file of saved positions.");
}

function refused(name: string, meaning: string): ReadFile {
  return {
    ok: false,
    notice: {
      code: "POSITIONS_FILE",
      meaning: `${name} ${meaning}`,
      nextStep: "Choose a file that Save has written.",
    },
  };
}

/** A name that tells robot and time, and that every file system takes. */
export function fileName(file: Pick<PositionsFile, "robot" | "saved">): string {
  const stamp = file.saved.replace(/\.\d+/, "").replace(/[^0-9TZ]/g, "");
  return `${file.robot.replace(/[^A-Za-z0-9_-]/g, "_")}-positions-${stamp}.json`;
}

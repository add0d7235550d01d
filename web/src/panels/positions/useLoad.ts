import { useState } from "react";
import { type AxisVerdict, api, type PositionsComparison, type PositionsFile } from "../../api/client";
import { declare } from "../../state/commands";
import { type Notice, noticeOfProblem } from "../../state/notice";
import { readPositions } from "./file";

export type Load =
  | { readonly phase: "idle" }
  | { readonly phase: "refused"; readonly notice: Notice }
  | {
      readonly phase: "compared";
      readonly name: string;
      readonly file: PositionsFile;
      readonly comparison: PositionsComparison;
    }
  | { readonly phase: "answered"; readonly verdicts: readonly AxisVerdict[] };

export interface Loading {
  readonly load: Load;
  /** Takes a file that was chosen or dropped, and has it compared. */
  readonly take: (chosen: File) => Promise<void>;
  /** Has the named axes of the compared file set. */
  readonly restore: (axes: string[]) => Promise<void>;
  readonly close: () => void;
}

/** Saved positions on their way back: chosen, compared by the app, confirmed by the operator, set by the kernel. */
export function useLoad(): Loading {
  const [load, setLoad] = useState<Load>({ phase: "idle" });

  const take = async (chosen: File): Promise<void> => {
    const answer = readPositions(chosen.name, await chosen.text());
    if (!answer.ok) return setLoad({ phase: "refused", notice: answer.notice });
    const outcome = await api.comparePositions(answer.file);
    if (!outcome.ok) return setLoad({ phase: "refused", notice: noticeOfProblem(outcome.problem) });
    // The app has checked that it is one.
    const file = answer.file as PositionsFile;
    setLoad({ phase: "compared", name: chosen.name, file, comparison: outcome.value });
  };

  const restore = async (axes: string[]): Promise<void> => {
    if (load.phase !== "compared") return;
    const outcome = await declare(() => api.restore(load.file, axes));
    if (outcome.ok) setLoad({ phase: "answered", verdicts: outcome.value });
    else setLoad({ phase: "refused", notice: noticeOfProblem(outcome.problem) });
  };

  return { load, take, restore, close: () => setLoad({ phase: "idle" }) };
}

import type { Motor } from "../../api/client";
import { CodeLink } from "../../design/CodeLink";
import { useKernel } from "../../kernel/useKernel";
import { useConsole } from "../../state/store";
import type { AxisFrame } from "../../stream/decode";
import { gateLines, type Stand } from "./gates";

const marks: Record<Stand, { readonly shape: string; readonly word: string }> = {
  open: { shape: "✓", word: "open" },
  blocks: { shape: "■", word: "BLOCKS" },
  closed: { shape: "□", word: "closed too" },
  follows: { shape: "▹", word: "follows" },
  later: { shape: "·", word: "judged later" },
};

/** All gates between a wish and its drive, the one that blocks marked, with what to do. */
export function GateList({ motor, axis }: { readonly motor: Motor; readonly axis: AxisFrame }) {
  const frame = useConsole((state) => state.frame);
  const stands = useKernel((kernel) => kernel.walkGates(motor.slot, axis.setpointCounts));
  if (frame === null) return null;
  return (
    <ol className="gates" aria-label={`Gates of ${motor.title}`}>
      {gateLines(frame, axis, stands).map((gate) => (
        <li key={gate.name} data-stand={gate.stand} aria-label={`Gate ${gate.name}`}>
          <i aria-hidden="true">{marks[gate.stand].shape}</i>
          <strong>
            <CodeLink family="gate" code={gate.name} />
          </strong>
          <span className="stand">{marks[gate.stand].word}</span>
          {gate.stand !== "open" && gate.stand !== "later" && (
            <span className="gate-words">
              {gate.meaning} {gate.next_step !== "" && <span className="next-step">{gate.next_step}</span>}
            </span>
          )}
        </li>
      ))}
      {stands === null && (
        <li className="gates-unsure">The gates behind the one that blocks cannot be judged on this page.</li>
      )}
    </ol>
  );
}

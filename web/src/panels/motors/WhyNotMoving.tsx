import { useConsole } from "../../state/store";
import type { AxisFrame } from "../../stream/decode";
import { gateLines, type Stand } from "./gates";

const marks: Record<Stand, { readonly shape: string; readonly word: string }> = {
  open: { shape: "✓", word: "open" },
  blocks: { shape: "■", word: "BLOCKS" },
  closed: { shape: "□", word: "closed too" },
  later: { shape: "·", word: "judged later" },
};

/** All gates between a wish and its drive, the one that blocks marked, with what to do. */
export function WhyNotMoving({ title, axis }: { readonly title: string; readonly axis: AxisFrame }) {
  const frame = useConsole((state) => state.frame);
  if (frame === null) return null;
  return (
    <ol className="gates" aria-label={`Gates of ${title}`}>
      {gateLines(frame, axis).map((gate) => (
        <li key={gate.name} data-stand={gate.stand}>
          <i aria-hidden="true">{marks[gate.stand].shape}</i>
          <strong>{gate.name}</strong>
          <span className="stand">{marks[gate.stand].word}</span>
          {(gate.stand === "blocks" || gate.stand === "closed") && (
            <span className="gate-words">
              {gate.meaning} <span className="next-step">{gate.next_step}</span>
            </span>
          )}
        </li>
      ))}
    </ol>
  );
}

import { useEffect } from "react";
import { api, type DeclaredPositions } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { useVerdicts } from "../../design/VerdictList";
import { declare } from "../../state/commands";
import { useConsole } from "../../state/store";
import { usePolled } from "../../state/usePolled";
import { undoStory } from "./undo";

const ASK_EVERY_MS = 1000;

/**
 * The newest Set Home, Zero all or Load, and the way back, for the minute in which there is one. The line is there always
 * and has one height: nothing below it moves when that minute ends.
 */
export function UndoLine() {
  const { value, notice, refresh } = usePolled(api.declaredPositions, ASK_EVERY_MS);
  const declarations = useConsole((state) => state.declarations);
  const motors = useConsole((state) => state.motors);
  const { send, list } = useVerdicts("Undo");
  useEffect(() => {
    if (declarations > 0) void refresh();
  }, [declarations, refresh]);
  const declared = notice === null ? value : null;
  const story = declared === null ? null : undoStory(declared, motors);
  return (
    <>
      <section className="undo-line" aria-label="Undo of positions" data-open={story !== null}>
        {/* biome-ignore lint/a11y/noNoninteractiveTabindex: whoever has no pointer scrolls it by keys. */}
        <div className="undo-words" tabIndex={0}>
          {declared === null || story === null ? (
            "Set Home, Zero all and Load can be undone here for 60 s, as long as the axis does not move."
          ) : (
            <Words declared={declared} story={story} />
          )}
        </div>
        <CommandButton
          need="holder"
          label={story === null ? "Undo positions" : `Undo ${story.what}`}
          off={story === null ? "No position was declared in the last 60 s." : story.off}
          onCommand={() => send(() => declare(api.undoDeclaredPositions))}
        >
          Undo
        </CommandButton>
      </section>
      {list}
    </>
  );
}

interface WordsProps {
  readonly declared: DeclaredPositions;
  readonly story: ReturnType<typeof undoStory>;
}

function Words({ declared, story }: WordsProps) {
  return (
    <>
      <strong>{story.what}</strong> by {declared.by},{" "}
      <output aria-live="off" aria-label="Time left to undo">
        {declared.left_s} s
      </output>{" "}
      left to undo{" "}
      <ul>
        {story.shifts.map(({ slot, words, moved }) => (
          <li key={slot}>
            {words}
            {moved && <em> ✕ it moved</em>}
          </li>
        ))}
      </ul>{" "}
      {story.invalid}
    </>
  );
}

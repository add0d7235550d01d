import { createContext, useContext } from "react";
import type { Move, PanelName } from "../state/layout";

/** What the page lets a user do with the panel that stands here. */
export interface Place {
  readonly name: PanelName;
  readonly folded: boolean;
  readonly onFold: (folded: boolean) => void;
  /** Where it can go; null unless the user arranges the page. */
  readonly moves: readonly Move[] | null;
  /** Of what must be seen, never. */
  readonly foldable: boolean;
  readonly onMove: (move: Move) => void;
}

/** Null around panels that stand where they are. */
export const PlaceContext = createContext<Place | null>(null);

const looks: readonly { readonly move: Move; readonly shape: string; readonly words: string }[] = [
  { move: "up", shape: "↑", words: "up" },
  { move: "down", shape: "↓", words: "down" },
  { move: "across", shape: "⇄", words: "to the other column" },
];

/** By which a button is found again after its panel moved. */
export const moveButtonId = (name: PanelName, move: Move): string => `move-${name}-${move}`;

/** Buttons that move and fold the panel with that title; one that is folded can always be unfolded. */
export function PlaceTools({ title }: { readonly title: string }) {
  const place = useContext(PlaceContext);
  if (place === null) return null;
  const { name, folded, foldable, moves, onFold, onMove } = place;
  return (
    <span className="place-tools">
      {moves !== null &&
        looks.map(({ move, shape, words }) => (
          <button
            key={move}
            id={moveButtonId(name, move)}
            type="button"
            className="button small"
            aria-label={`Move ${title} ${words}`}
            aria-disabled={!moves.includes(move)}
            onClick={() => onMove(move)}
          >
            <i aria-hidden="true">{shape}</i>
          </button>
        ))}
      {(folded || (moves !== null && foldable)) && (
        <button
          type="button"
          className="button small"
          aria-expanded={!folded}
          onClick={() => onFold(!folded)}
        >
          {folded ? "Unfold" : "Fold"} <span className="visually-hidden">{title}</span>
        </button>
      )}
    </span>
  );
}

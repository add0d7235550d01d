/** Which panels stand where on the robot's page, and which are folded, as a user arranged them on this computer. */
import { keep, kept, type Shelf } from "./shelf";

/** In the order of a page that nobody arranged. Motors, tables and logs need the width of the main column. */
const places = {
  motors: "main",
  log: "main",
  communication: "main",
  navigation: "main",
  bench: "side",
  biopsy: "side",
  proposals: "side",
  why: "side",
  status: "side",
} as const satisfies Record<string, Column>;

export type Column = "main" | "side";
export type PanelName = keyof typeof places;
export type Move = "up" | "down" | "across";

export interface Layout {
  readonly main: readonly PanelName[];
  readonly side: readonly PanelName[];
  readonly folded: readonly PanelName[];
}

const names = Object.keys(places) as PanelName[];
const atFirst = (column: Column): PanelName[] => names.filter((name) => places[name] === column);

export const defaultLayout: Layout = { main: atFirst("main"), side: atFirst("side"), folded: [] };

const keyOf = (user: string): string => `interlock.layout.${user}`;

/** The layout that the user chose here; panels that it does not know are added at the end of their column. */
export function chosenLayout(shelf: Shelf, user: string): Layout {
  const stored = read(kept(shelf, keyOf(user)));
  const main = list(stored.main);
  const side = list(stored.side).filter((name) => !main.includes(name) && places[name] === "side");
  const missing = (column: Column): PanelName[] =>
    atFirst(column).filter((name) => !main.includes(name) && !side.includes(name));
  return {
    main: [...main, ...missing("main")],
    side: [...side, ...missing("side")],
    folded: list(stored.folded).filter(canFold),
  };
}

export function rememberLayout(shelf: Shelf, user: string, layout: Layout): void {
  keep(shelf, keyOf(user), JSON.stringify(layout));
}

/** Whether a panel can go there; `shown` are those that the page has now. */
export function canMove(layout: Layout, name: PanelName, move: Move, shown: readonly PanelName[]): boolean {
  return moved(layout, name, move, shown) !== layout;
}

/** The layout with a panel one place further among those that are shown, or at the end of the other column. */
export function moved(layout: Layout, name: PanelName, move: Move, shown: readonly PanelName[]): Layout {
  const column: Column = layout.main.includes(name) ? "main" : "side";
  if (move === "across") {
    if (places[name] === "main") return layout;
    const other: Column = column === "main" ? "side" : "main";
    return { ...layout, [column]: without(layout[column], name), [other]: [...layout[other], name] };
  }
  const neighbours = layout[column].filter((each) => shown.includes(each));
  const neighbour = neighbours[neighbours.indexOf(name) + (move === "up" ? -1 : 1)];
  if (neighbour === undefined) return layout;
  const rest = without(layout[column], name);
  const at = rest.indexOf(neighbour) + (move === "up" ? 0 : 1);
  return { ...layout, [column]: [...rest.slice(0, at), name, ...rest.slice(at)] };
}

/** The motors tell the faults of their axes: they are always seen. */
export function canFold(name: PanelName): boolean {
  return name !== "motors";
}

export function withFolded(layout: Layout, name: PanelName, folded: boolean): Layout {
  const others = without(layout.folded, name);
  return { ...layout, folded: folded ? [...others, name] : others };
}

function without(list: readonly PanelName[], name: PanelName): PanelName[] {
  return list.filter((each) => each !== name);
}

/** What was stored may be of another version, or not be ours. */
function read(text: string | null): Record<string, unknown> {
  try {
    const stored: unknown = JSON.parse(text ?? "{}");
    return typeof stored === "object" && stored !== null ? { ...stored } : {};
  } catch {
    return {};
  }
}

/** The names of panels in it, each once. */
function list(stored: unknown): PanelName[] {
  return Array.isArray(stored) ? names.filter((name) => stored.includes(name)).sort(asIn(stored)) : [];
}

function asIn(order: readonly unknown[]): (one: PanelName, other: PanelName) => number {
  return (one, other) => order.indexOf(one) - order.indexOf(other);
}

/** What the keys do, for those who ask. */

export interface KeyHelp {
  readonly key: string;
  readonly where: string;
  readonly does: string;
}

export const keys: readonly KeyHelp[] = [
  { key: "Esc", where: "anywhere", does: "STOP, at once; withdraws previews and questions" },
  { key: "?", where: "outside of text", does: "shows and hides this" },
  { key: "Tab", where: "anywhere", does: "goes to the next control" },
  { key: "Arrows", where: "on a track", does: "preview by 1 % of the range" },
  { key: "Page Up, Page Down", where: "on a track", does: "preview by 10 % of the range" },
  { key: "Home, End", where: "on a track", does: "preview the ends of the allowed range" },
  { key: "Enter", where: "on a track, in a target", does: "proposes" },
  { key: "Space, Enter", where: "on a jog button", does: "jog while held" },
];

const texts: ReadonlySet<string> = new Set(["INPUT", "TEXTAREA", "SELECT"]);

/** Whether a key that goes there is text. */
export function isTyping(target: unknown): boolean {
  return (
    typeof target === "object" && target !== null && "tagName" in target && texts.has(String(target.tagName))
  );
}

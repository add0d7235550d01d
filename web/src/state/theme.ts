/** Light or dark: as the computer says, or as the user chose on this computer. */

export const themes = ["system", "light", "dark"] as const;
export type Theme = (typeof themes)[number];

/** The part of the browser's storage that is used. */
export type Shelf = Pick<Storage, "getItem" | "setItem">;

const keyOf = (user: string): string => `interlock.theme.${user}`;

/** The theme that the user chose here; the computer's when none, or when nothing can be stored. */
export function chosenTheme(shelf: Shelf, user: string): Theme {
  try {
    const stored = shelf.getItem(keyOf(user));
    return themes.find((theme) => theme === stored) ?? "system";
  } catch {
    return "system";
  }
}

/** Remembers a choice; without storage it lasts until the page is left. */
export function rememberTheme(shelf: Shelf, user: string, theme: Theme): void {
  try {
    shelf.setItem(keyOf(user), theme);
  } catch {
    // The page is themed all the same.
  }
}

/** The theme that a press of the button leads to. */
export function nextTheme(theme: Theme): Theme {
  return themes[(themes.indexOf(theme) + 1) % themes.length] ?? "system";
}

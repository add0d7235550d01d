/** Light or dark: as the computer says, or as the user chose on this computer. */
import { keep, kept, type Shelf } from "./shelf";

export const themes = ["system", "light", "dark"] as const;
export type Theme = (typeof themes)[number];

const keyOf = (user: string): string => `interlock.theme.${user}`;

/** The theme that the user chose here; the computer's when none, or when nothing can be stored. */
export function chosenTheme(shelf: Shelf, user: string): Theme {
  const stored = kept(shelf, keyOf(user));
  return themes.find((theme) => theme === stored) ?? "system";
}

export function rememberTheme(shelf: Shelf, user: string, theme: Theme): void {
  keep(shelf, keyOf(user), theme);
}

/** The theme that a press of the button leads to. */
export function nextTheme(theme: Theme): Theme {
  return themes[(themes.indexOf(theme) + 1) % themes.length] ?? "system";
}

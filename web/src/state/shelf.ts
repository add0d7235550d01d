/** What a user chose on this computer, kept in the browser. */

/** The part of the browser's storage that is used. */
export type Shelf = Pick<Storage, "getItem" | "setItem">;

/** What is kept under that key; null when nothing is, or when nothing can be stored. */
export function kept(shelf: Shelf, key: string): string | null {
  try {
    return shelf.getItem(key);
  } catch {
    return null;
  }
}

/** Keeps a choice; without storage it lasts until the page is left. */
export function keep(shelf: Shelf, key: string, value: string): void {
  try {
    shelf.setItem(key, value);
  } catch {
    // The page is as it was chosen all the same.
  }
}

/** A file that is dropped beside its target must not take the place of the page, and STOP with it. */
export function keepPageOnDrop(): void {
  for (const event of ["dragover", "drop"]) {
    window.addEventListener(event, (dragged) => dragged.preventDefault());
  }
}

/** Hands the operator a file of the page's making. */
export function download(name: string, type: string, text: string): void {
  const url = URL.createObjectURL(new Blob([text], { type }));
  const link = document.createElement("a");
  link.href = url;
  link.download = name;
  link.click();
  // The browser reads it after this handler has ended.
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

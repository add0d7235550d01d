/** Numbers as people type several of them: "25, 50" or "3 -2 70". Null when one of them is none. */
export function numbersIn(text: string): number[] | null {
  const words = text.split(/[\s,;]+/).filter((word) => word !== "");
  const numbers = words.map(Number);
  return numbers.every(Number.isFinite) ? numbers : null;
}

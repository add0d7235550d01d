import { useConsole } from "../state/store";
import { foretellRefusal } from "./foretell";
import type { PageKernel } from "./pageKernel";
import { useKernel } from "./useKernel";

/** Why the kernel would refuse what `question` asks it, in words; null when it would not, or cannot be asked. */
export function useRefusal(question: (kernel: PageKernel) => string): string | null {
  const frame = useConsole((state) => state.frame);
  return foretellRefusal(frame, useKernel(question));
}

import { useConsole } from "../state/store";
import { ask } from "./asking";
import type { PageKernel } from "./pageKernel";

/** What the kernel in the page says of the newest frame; null when it cannot. */
export function useKernel<Answer>(question: (kernel: PageKernel) => Answer): Answer | null {
  const frame = useConsole((state) => state.frame);
  const kernel = useConsole((state) => state.pageKernel);
  return ask(kernel, frame, question);
}

/** Which axis the operator wonders about. */
import type { Motor, Proposal } from "../../api/client";
import { isOpen } from "../../state/proposals";

/** The chosen axis; else that of the newest open proposal that moves one; else the first. Null without axes. */
export function askedSlot(
  chosen: number | null,
  proposals: readonly Proposal[],
  motors: readonly Motor[],
): number | null {
  if (chosen !== null && motors.some(({ slot }) => slot === chosen)) return chosen;
  const open = proposals.find((proposal) => isOpen(proposal) && proposal.axes.length > 0);
  const named = motors.find(({ name }) => name === open?.axes[0]);
  return (named ?? motors[0])?.slot ?? null;
}

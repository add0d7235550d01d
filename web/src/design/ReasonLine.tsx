import type { Need } from "../state/permission";
import { useReason } from "../state/useReason";

/** Says once, for all controls of a panel, why they are disabled. */
export function ReasonLine({ need, off = null }: { readonly need: Need; readonly off?: string | null }) {
  const reason = useReason(need) ?? off;
  if (reason === null) return null;
  return <p className="reason-line">Read only. {reason}</p>;
}

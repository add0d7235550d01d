import { type ReactNode, useState } from "react";
import type { Need } from "../state/permission";
import { useReason } from "../state/useReason";

interface CommandButtonProps {
  readonly need: Need;
  /** What to press it for, where the words on it do not tell alone. */
  readonly label?: string;
  /** Why it would do nothing now; null or absent when it would. */
  readonly off?: string | null | undefined;
  /** Why it would be refused now; null or absent when it would not, or nobody knows. */
  readonly warning?: string | null;
  readonly pressed?: boolean;
  readonly className?: string;
  readonly onCommand: () => Promise<void> | void;
  readonly children: ReactNode;
}

/**
 * Asks the app for something. Waits for the answer before it can be pressed again: a double click asks once. Meanwhile it
 * keeps the focus, which a disabled button would lose.
 */
export function CommandButton(props: CommandButtonProps) {
  const reason = useReason(props.need) ?? props.off ?? null;
  const [waiting, setWaiting] = useState(false);
  const onClick = async (): Promise<void> => {
    if (waiting) return;
    setWaiting(true);
    try {
      await props.onCommand();
    } finally {
      setWaiting(false);
    }
  };
  return (
    <button
      type="button"
      className={`button ${props.className ?? ""}`}
      disabled={reason !== null}
      aria-disabled={waiting}
      data-foretold={reason === null && props.warning != null ? "refused" : undefined}
      title={reason ?? props.warning ?? undefined}
      aria-label={props.label}
      aria-pressed={props.pressed}
      onClick={() => void onClick()}
    >
      {props.children}
    </button>
  );
}

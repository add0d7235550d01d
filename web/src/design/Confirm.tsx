import { type ReactNode, useEffect, useRef } from "react";
import { useConsole } from "../state/store";

interface ConfirmProps {
  readonly title: string;
  readonly action: string;
  readonly off?: boolean;
  /** Another answer, before the action. */
  readonly other?: ReactNode;
  readonly onConfirm: () => Promise<void> | void;
  readonly onCancel: () => void;
  readonly children: ReactNode;
}

/**
 * A question in the place where it was raised. Not a modal dialog: that would put STOP out of reach of the pointer.
 * STOP withdraws the question.
 */
export function Confirm({ title, action, off, other, onConfirm, onCancel, children }: ConfirmProps) {
  const cancel = useRef<HTMLButtonElement>(null);
  const stops = useConsole((state) => state.stops);
  const asked = useRef(stops);
  useEffect(() => cancel.current?.focus(), []);
  useEffect(() => {
    if (stops !== asked.current) onCancel();
  }, [stops, onCancel]);
  return (
    <section className="confirm" aria-label={title}>
      <div className="confirm-words">
        <strong>{title}</strong>
        {children}
      </div>
      <div className="confirm-answers">
        <button ref={cancel} type="button" className="button" onClick={onCancel}>
          Cancel
        </button>
        {other}
        <button
          type="button"
          className="button primary"
          disabled={off === true}
          onClick={() => void onConfirm()}
        >
          {action}
        </button>
      </div>
    </section>
  );
}

import { type DragEvent, useRef, useState } from "react";
import { useReason } from "../../state/useReason";

/** Chooses a file of saved positions, or takes one that is dropped on it. */
export function LoadButton({ onFile }: { readonly onFile: (file: File) => void }) {
  const input = useRef<HTMLInputElement>(null);
  const [over, setOver] = useState(false);
  const reason = useReason("holder");

  const onDrop = (event: DragEvent): void => {
    event.preventDefault();
    setOver(false);
    const file = event.dataTransfer.files[0];
    if (reason === null && file !== undefined) onFile(file);
  };

  return (
    <>
      <button
        type="button"
        className={`button ${over ? "drop" : ""}`}
        disabled={reason !== null}
        title={reason ?? "Choose a saved file, or drop it here"}
        onClick={() => input.current?.click()}
        onDragOver={(event) => {
          event.preventDefault();
          setOver(true);
        }}
        onDragLeave={() => setOver(false)}
        onDrop={onDrop}
      >
        Load<span className="visually-hidden"> positions</span> <small>or drop a file here</small>
      </button>
      <input
        ref={input}
        type="file"
        accept=".json,application/json"
        hidden
        aria-label="File of saved positions"
        onChange={(event) => {
          const file = event.target.files?.[0];
          if (file !== undefined) onFile(file);
          // So that the same file can be chosen again.
          event.target.value = "";
        }}
      />
    </>
  );
}

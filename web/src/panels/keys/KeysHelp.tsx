import { useEffect, useState } from "react";
import { useConsole } from "../../state/store";
import { FirstStepsButton } from "../first/FirstSteps";
import { isTyping, keys } from "./keys";
import "./keys.css";

/** A button, and the key `?`, that show what the keys do. Not modal: STOP stays within reach. */
export function KeysHelp() {
  const [open, setOpen] = useState(false);
  const loggedIn = useConsole((state) => state.login.phase === "in");
  useEffect(() => {
    const onKey = (event: KeyboardEvent): void => {
      if (event.key === "Escape") setOpen(false);
      else if (event.key === "?" && !isTyping(event.target)) setOpen((was) => !was);
    };
    window.addEventListener("keydown", onKey);
    return () => window.removeEventListener("keydown", onKey);
  }, []);
  return (
    <>
      <button
        type="button"
        className="button quiet"
        aria-label="Keys"
        aria-expanded={open}
        aria-keyshortcuts="?"
        onClick={() => setOpen(!open)}
      >
        ?
      </button>
      {open && (
        <section className="keys-help" aria-label="What the keys do">
          <table className="table">
            <tbody>
              {keys.map(({ key, where, does }) => (
                <tr key={`${key} ${where}`}>
                  <th scope="row">
                    <kbd>{key}</kbd>
                  </th>
                  <td>{where}</td>
                  <td>{does}</td>
                </tr>
              ))}
            </tbody>
          </table>
          <p>No key enables an axis, unlocks the system or presses the pedal.</p>
          {loggedIn && (
            <p>
              New here? <FirstStepsButton onOpen={() => setOpen(false)} />
            </p>
          )}
          <button type="button" className="button" onClick={() => setOpen(false)}>
            Close
          </button>
        </section>
      )}
    </>
  );
}

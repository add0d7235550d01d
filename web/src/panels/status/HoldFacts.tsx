import { useState } from "react";
import { api, type Holds, type Outcome } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { NoticeText } from "../../design/NoticeText";
import { gateWords } from "../../state/holds";
import { type Notice, noticeOfProblem } from "../../state/notice";
import { useConsole } from "../../state/store";

/** What holds motion still from outside, and the buttons for it. */
export function HoldFacts() {
  const holds = useConsole((state) => state.holds);
  const [refusal, setRefusal] = useState<Notice | null>(null);
  if (holds === null) return null;
  const send = async (ask: () => Promise<Outcome<Holds>>): Promise<void> => {
    const outcome = await ask();
    setRefusal(outcome.ok ? null : noticeOfProblem(outcome.problem));
  };
  const { gate, scan } = holds;
  return (
    <section aria-label="Holds">
      <dl className="facts">
        <dt>Scan</dt>
        <dd>
          <strong>{scan.active ? "held still" : "none"}</strong>{" "}
          <CommandButton
            need="engineer"
            className="small"
            onCommand={() => send(() => api.holdForScan(!scan.active))}
          >
            {scan.active ? "Scan has ended" : "Hold still for a scan"}
          </CommandButton>
        </dd>
        <dt>Breathing gate</dt>
        <dd>
          <strong>{gateWords(holds)?.replace("Breathing gate: ", "") ?? "off"}</strong>{" "}
          <CommandButton
            need="holder"
            className="small"
            onCommand={() => send(() => api.setBreathingGate(!gate.in_use))}
          >
            {gate.in_use ? "Turn the gate off" : "Use the gate"}
          </CommandButton>
        </dd>
      </dl>
      {refusal !== null && (
        <p className="panel-notice" role="alert">
          <NoticeText lead="Refused:" notice={refusal} />
        </p>
      )}
    </section>
  );
}

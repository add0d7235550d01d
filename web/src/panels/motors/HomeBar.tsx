import { useState } from "react";
import { type AxisVerdict, api, type Motor } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { Confirm } from "../../design/Confirm";
import { VerdictList } from "../../design/VerdictList";
import { useRefusal } from "../../kernel/useRefusal";
import "../../kernel/foretelling.css";
import { propose } from "../../state/commands";
import { type Notice, noticeOfProblem } from "../../state/notice";
import { openHoming } from "../../state/proposals";
import { useConsole } from "../../state/store";

/** What concerns several axes at once: homing by steps, and declaring that all stand at home. */
export function HomeBar() {
  const steps = useConsole((state) => state.robot?.home_steps);
  const homing = useConsole((state) => openHoming(state.proposals) !== undefined);
  const busy = homing ? "Homing is open: let it end or abort it first." : null;
  return (
    <div className="home-bar">
      <fieldset className="home-steps">
        <legend>Home</legend>
        <CommandButton need="holder" off={busy} onCommand={() => propose({ kind: "home" })}>
          Home all
        </CommandButton>
        {(steps ?? []).map((step, index) => (
          <CommandButton
            key={step.name}
            need="holder"
            label={`Home step ${index + 1}: ${step.title}`}
            className="quiet"
            off={busy}
            onCommand={() => propose({ kind: "home", step: step.name })}
          >
            <small>{index + 1}</small> {step.title}
          </CommandButton>
        ))}
      </fieldset>
      <ZeroAll off={busy} />
    </div>
  );
}

type ZeroPhase =
  | { readonly phase: "idle" | "asked" }
  | { readonly phase: "answered"; readonly verdicts: readonly AxisVerdict[] }
  | { readonly phase: "refused"; readonly notice: Notice };

function ZeroAll({ off }: { readonly off: string | null }) {
  const [zero, setZero] = useState<ZeroPhase>({ phase: "idle" });
  const motors = useConsole((state) => state.motors).filter((motor) => !motor.has_switch);
  const close = (): void => setZero({ phase: "idle" });
  const send = async (): Promise<void> => {
    const outcome = await api.zeroAll();
    setZero(
      outcome.ok
        ? { phase: "answered", verdicts: outcome.value }
        : { phase: "refused", notice: noticeOfProblem(outcome.problem) },
    );
  };
  return (
    <>
      <CommandButton need="holder" off={off} onCommand={() => setZero({ phase: "asked" })}>
        Zero all
      </CommandButton>
      {zero.phase === "asked" && (
        <Confirm
          title="Declare every axis without a switch at home?"
          action="Set Home of these axes"
          onConfirm={send}
          onCancel={close}
        >
          <p>
            Each of these axes takes its home position for where it stands now. Do this only when that is
            true. An axis with a switch is left alone: home it.
          </p>
          <ul>
            {motors.map((motor) => (
              <ZeroLine key={motor.slot} motor={motor} />
            ))}
          </ul>
        </Confirm>
      )}
      {zero.phase === "answered" && (
        <VerdictList title="Zero all" verdicts={zero.verdicts} notice={null} onClose={close} />
      )}
      {zero.phase === "refused" && (
        <VerdictList title="Zero all" verdicts={[]} notice={zero.notice} onClose={close} />
      )}
    </>
  );
}

function ZeroLine({ motor: { slot, title } }: { readonly motor: Motor }) {
  const refusal = useRefusal((kernel) => kernel.judge("SET_HOME", slot));
  return (
    <li>
      {title}
      {refusal !== null && <span className="foretelling" data-outcome="refused">{` ✕ ${refusal}`}</span>}
    </li>
  );
}

import { useCallback, useState } from "react";
import { api, type Motor } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { Confirm } from "../../design/Confirm";
import { useVerdicts } from "../../design/VerdictList";
import { useRefusal } from "../../kernel/useRefusal";
import "../../kernel/foretelling.css";
import { declare, propose } from "../../state/commands";
import { openHoming } from "../../state/proposals";
import { useConsole } from "../../state/store";
import { DeclaredShift, WhatBecomesInvalid } from "../positions/DeclaredShift";

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

function ZeroAll({ off }: { readonly off: string | null }) {
  const [asked, setAsked] = useState(false);
  const motors = useConsole((state) => state.motors).filter((motor) => !motor.has_switch);
  const { send, list } = useVerdicts("Zero all");
  const close = useCallback(() => setAsked(false), []);
  const zero = (): Promise<void> => {
    close();
    return send(() => declare(api.zeroAll));
  };
  return (
    <>
      <CommandButton need="holder" off={off} onCommand={() => setAsked(true)}>
        Zero all
      </CommandButton>
      {asked && (
        <Confirm
          title="Declare every axis without a switch at home?"
          action="Set Home of these axes"
          onConfirm={zero}
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
          <WhatBecomesInvalid />
        </Confirm>
      )}
      {!asked && list}
    </>
  );
}

function ZeroLine({ motor }: { readonly motor: Motor }) {
  const refusal = useRefusal((kernel) => kernel.judge("SET_HOME", motor.slot));
  return (
    <li>
      <DeclaredShift motor={motor} to={0} />
      {refusal !== null && <span className="foretelling" data-outcome="refused">{` ✕ ${refusal}`}</span>}
    </li>
  );
}

import { useCallback, useState } from "react";
import { api, type Claim, type MotionControl } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { Confirm } from "../../design/Confirm";
import { changeControl } from "../../state/commands";
import { useConsole } from "../../state/store";
import { localTime } from "../../units/time";

/** Who may move the robot, who asks to, and what this session can do about it. */
export function ControlBar() {
  const control = useConsole((state) => state.control);
  const login = useConsole((state) => state.login);
  const replay = useConsole((state) => state.glance?.replay ?? false);
  if (replay) {
    return <div className="control">Nobody is in control: a recording plays</div>;
  }
  if (control === null || login.phase !== "in") {
    return <div className="control">In control: unknown</div>;
  }
  const asks = control.requests.some((claim) => claim.session === login.session);
  return (
    <div className="control">
      <output aria-label="Control">
        <Holder control={control} />
      </output>
      {control.mine ? (
        <CommandButton need="engineer" onCommand={() => changeControl(api.releaseControl)}>
          Release control
        </CommandButton>
      ) : asks ? (
        <CommandButton need="engineer" onCommand={() => changeControl(api.releaseControl)}>
          Withdraw request
        </CommandButton>
      ) : (
        <CommandButton need="engineer" onCommand={() => changeControl(api.requestControl)}>
          {control.holder === null ? "Take control" : "Request control"}
        </CommandButton>
      )}
      {control.holder !== null && !control.mine && login.user.role === "admin" && (
        <TakeOver holder={control.holder} />
      )}
      {control.requests
        .filter((claim) => claim.session !== login.session)
        .map((claim) => (
          <Request key={claim.session} claim={claim} mayGrant={control.mine} />
        ))}
    </div>
  );
}

function Holder({ control }: { readonly control: MotionControl }) {
  if (control.holder === null) return <strong>Nobody is in control</strong>;
  return (
    <strong title={`since ${localTime(control.holder.since)}`}>
      {control.mine ? "You are in control" : `${control.holder.user} is in control`}
    </strong>
  );
}

function Request({ claim, mayGrant }: { readonly claim: Claim; readonly mayGrant: boolean }) {
  return (
    <span className="control-request" role="status">
      <strong>{claim.user}</strong> requests control
      {mayGrant && (
        <CommandButton
          need="holder"
          label={`Hand over to ${claim.user}`}
          onCommand={() => changeControl(() => api.handOverControl(claim.session))}
        >
          Hand over
        </CommandButton>
      )}
    </span>
  );
}

function TakeOver({ holder }: { readonly holder: Claim }) {
  const [asked, setAsked] = useState(false);
  const cancel = useCallback(() => setAsked(false), []);
  const take = async (): Promise<void> => {
    await changeControl(api.takeOverControl);
    setAsked(false);
  };
  return (
    <>
      <CommandButton need="admin" onCommand={() => setAsked(true)}>
        Take control
      </CommandButton>
      {asked && (
        <Confirm
          title={`Take control from ${holder.user}?`}
          action="Take control"
          onConfirm={take}
          onCancel={cancel}
        >
          <p>Motion ends, and every open proposal is aborted.</p>
        </Confirm>
      )}
    </>
  );
}

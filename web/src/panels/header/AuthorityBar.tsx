import { useCallback, useState } from "react";
import { type Authority, api, type Claim } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { Confirm } from "../../design/Confirm";
import { changeAuthority } from "../../state/commands";
import { useConsole } from "../../state/store";
import { localTime } from "../../units/time";

/** Who may move the robot, who asks to, and what this session can do about it. */
export function AuthorityBar() {
  const authority = useConsole((state) => state.authority);
  const login = useConsole((state) => state.login);
  const replay = useConsole((state) => state.glance?.replay ?? false);
  if (replay) {
    return <div className="authority">Authority: none, as a recording plays</div>;
  }
  if (authority === null || login.phase !== "in") {
    return <div className="authority">Authority: unknown</div>;
  }
  const asks = authority.requests.some((claim) => claim.session === login.session);
  return (
    <div className="authority">
      <span className="label">Authority</span>
      <output aria-label="Authority">
        <Holder authority={authority} />
      </output>
      {authority.mine ? (
        <CommandButton need="engineer" onCommand={() => changeAuthority(api.releaseAuthority)}>
          Release
        </CommandButton>
      ) : asks ? (
        <CommandButton need="engineer" onCommand={() => changeAuthority(api.releaseAuthority)}>
          Withdraw request
        </CommandButton>
      ) : (
        <CommandButton need="engineer" onCommand={() => changeAuthority(api.requestAuthority)}>
          Request
        </CommandButton>
      )}
      {authority.holder !== null && !authority.mine && login.user.role === "admin" && (
        <TakeOver holder={authority.holder} />
      )}
      {authority.requests
        .filter((claim) => claim.session !== login.session)
        .map((claim) => (
          <Request key={claim.session} claim={claim} mayGrant={authority.mine} />
        ))}
    </div>
  );
}

function Holder({ authority }: { readonly authority: Authority }) {
  if (authority.holder === null) return <strong>nobody</strong>;
  return (
    <>
      <strong title={`since ${localTime(authority.holder.since)}`}>{authority.holder.user}</strong>
      {authority.mine && " (you)"}
    </>
  );
}

function Request({ claim, mayGrant }: { readonly claim: Claim; readonly mayGrant: boolean }) {
  return (
    <span className="authority-request" role="status">
      <strong>{claim.user}</strong> asks
      {mayGrant && (
        <CommandButton
          need="holder"
          label={`Hand over to ${claim.user}`}
          onCommand={() => changeAuthority(() => api.handOverAuthority(claim.session))}
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
    await changeAuthority(api.takeOverAuthority);
    setAsked(false);
  };
  return (
    <>
      <CommandButton need="admin" onCommand={() => setAsked(true)}>
        Take over
      </CommandButton>
      {asked && (
        <Confirm
          title={`Take the authority from ${holder.user}?`}
          action="Take it"
          onConfirm={take}
          onCancel={cancel}
        >
          <p>Motion ends, and every open proposal is aborted.</p>
        </Confirm>
      )}
    </>
  );
}

import { useState } from "react";
import { api, type Biopsy, type BiopsyNow, type Force, type Outcome } from "../../api/client";
import { CommandButton } from "../../design/CommandButton";
import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import { type Notice, noticeOfProblem } from "../../state/notice";
import { usePolled } from "../../state/usePolled";
import { numbersIn } from "./numbers";
import "./biopsy.css";

const ASK_EVERY_MS = 250;

/** Cooperative Biopsy: forces, membranes, and what the needle does. */
export function BiopsyPanel() {
  const { value, asked, notice, refresh } = usePolled(api.biopsy, ASK_EVERY_MS);
  const [refusal, setRefusal] = useState<Notice | null>(null);
  const send = async (ask: () => Promise<Outcome<unknown>>): Promise<void> => {
    const outcome = await ask();
    setRefusal(outcome.ok ? null : noticeOfProblem(outcome.problem));
    await refresh();
  };
  const shown = refusal ?? notice;
  return (
    <Panel title="Biopsy" className="biopsy-panel" asked={asked}>
      {value !== null && (
        <>
          <Forces biopsy={value} onZero={() => send(api.zeroForces)} />
          <Membranes biopsy={value} onSend={send} />
          {value.now === null ? <Start onSend={send} /> : <Now now={value.now} />}
        </>
      )}
      {shown !== null && (
        <p className="panel-notice" role="alert">
          <NoticeText lead={refusal === null ? "No answer:" : "Refused:"} notice={shown} />
        </p>
      )}
    </Panel>
  );
}

interface ForcesProps {
  readonly biopsy: Biopsy;
  readonly onZero: () => Promise<void>;
}

function Forces({ biopsy, onZero }: ForcesProps) {
  const age = biopsy.force_age_ms;
  return (
    <>
      <table className="table">
        <thead>
          <tr>
            <th scope="col">Force</th>
            <th scope="col" className="number">
              Counts
            </th>
            <th scope="col" className="number">
              N
            </th>
            <th scope="col" className="number">
              Zero
            </th>
          </tr>
        </thead>
        <tbody>
          <ForceLine name="Hand" force={biopsy.hand} />
          <ForceLine name="Needle" force={biopsy.needle} />
        </tbody>
      </table>
      <div className="biopsy-line">
        <output aria-label="Age of the force">
          {age === null ? "no force yet" : `force ${age.toFixed(0)} ms old`}
        </output>
        <CommandButton
          need="holder"
          className="small"
          off={biopsy.open ? "A biopsy is open." : null}
          onCommand={onZero}
        >
          Zero forces
        </CommandButton>
      </div>
    </>
  );
}

function ForceLine({ name, force }: { readonly name: string; readonly force: Force }) {
  return (
    <tr aria-label={`Force of the ${name.toLowerCase()}`}>
      <th scope="row">{name}</th>
      <td className="number">{force.raw_counts ?? "–"}</td>
      <td className="number">{force.force_n?.toFixed(2) ?? "–"}</td>
      <td className="number muted">{force.zero_counts?.toFixed(1) ?? "–"}</td>
    </tr>
  );
}

type Send = (ask: () => Promise<Outcome<unknown>>) => Promise<void>;

function Membranes({ biopsy, onSend }: { readonly biopsy: Biopsy; readonly onSend: Send }) {
  const [text, setText] = useState("");
  const depths = numbersIn(text);
  const open = biopsy.open ? "A biopsy is open." : null;
  const unreadable = depths === null ? "Depths are numbers, such as 25, 50." : null;
  return (
    <>
      <ol className="membranes" aria-label="Membranes">
        {biopsy.membranes.map((membrane) => (
          <li key={membrane.depth_mm} data-state={membrane.state}>
            {membrane.depth_mm} mm: {membrane.state}
            {membrane.found_mm !== null && `, found at ${membrane.found_mm.toFixed(1)} mm`}
          </li>
        ))}
      </ol>
      <div className="biopsy-line">
        <label>
          Membranes, mm
          <input value={text} placeholder="25, 50" onChange={(event) => setText(event.target.value)} />
        </label>
        <CommandButton
          need="holder"
          className="small"
          off={open ?? unreadable}
          onCommand={() => onSend(() => api.setMembranes(depths ?? []))}
        >
          Set membranes
        </CommandButton>
        <CommandButton
          need="holder"
          className="small"
          off={open}
          onCommand={() => onSend(api.resetMembranes)}
        >
          Reset membranes
        </CommandButton>
      </div>
    </>
  );
}

function Start({ onSend }: { readonly onSend: Send }) {
  const [text, setText] = useState("");
  const target = numbersIn(text);
  const wrong = target?.length === 3 ? null : "A target has three numbers, such as 3, -2, 70.";
  return (
    <div className="biopsy-line">
      <label>
        Target x, y, z, mm
        <input value={text} placeholder="3, -2, 70" onChange={(event) => setText(event.target.value)} />
      </label>
      <CommandButton
        need="holder"
        className="small"
        off={wrong}
        onCommand={() => onSend(() => api.propose({ kind: "biopsy", target_mm: target ?? [] }))}
      >
        Propose biopsy
      </CommandButton>
    </div>
  );
}

const DEGREES = 180 / Math.PI;

function Now({ now }: { readonly now: BiopsyNow }) {
  return (
    <dl className="biopsy-now" aria-label="Needle">
      <dt>Depth</dt>
      <dd>
        {now.depth_mm.toFixed(1)} mm, {now.left_mm.toFixed(1)} mm left, {now.speed_mm_s.toFixed(1)} mm/s
      </dd>
      {now.rough && (
        <dd className="bad" role="alert">
          The force varies so much here that membranes cannot be told from tissue: none will be cued. Count on
          your hand and on images.
        </dd>
      )}
      {now.images_disagree && (
        <dd className="bad" role="alert">
          The newest images contradict where needle or target are believed to be: the insertion waits. Look at
          the images. It goes on once newer ones agree and the hand has let go; otherwise end it and retract.
        </dd>
      )}
      {now.waits_for_hand && !now.images_disagree && (
        <dd className="bad" role="alert">
          The force sensor was pressed when the pedal was. Let go of it, or zero the forces, before it is
          followed.
        </dd>
      )}
      <dt>Steering</dt>
      <dd>
        to {(now.wanted_rotation_rad * DEGREES).toFixed(0)}°, alpha {now.alpha.toFixed(2)}, curvature{" "}
        {now.curvature_per_mm.toFixed(4)} / mm
      </dd>
      <dt>Images</dt>
      <dd>
        {now.images} taken, {now.images_refused} refused; tip known within {(2 * now.tip_sd_mm).toFixed(1)} mm
      </dd>
      <dt>Membrane</dt>
      <dd className={now.cue ? "cue" : ""}>{now.cue ? "PUNCTURED" : now.armed ? "listening" : "–"}</dd>
      {!now.reachable && (
        <dd className="bad" role="alert">
          The target is out of reach: the needle will miss it by {now.expected_miss_mm.toFixed(1)} mm.
        </dd>
      )}
    </dl>
  );
}

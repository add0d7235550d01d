import { useEffect, useMemo, useRef, useState } from "react";
import { api, type Proposal, type Reach, type Targeting } from "../../api/client";
import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import { type Notice, noticeOfProblem } from "../../state/notice";
import { isOpen } from "../../state/proposals";
import { proposalHash, useProposalPlace } from "../../state/route";
import { useConsole } from "../../state/store";
import { usePolled } from "../../state/usePolled";
import { LivePage } from "../cover/LivePage";
import { usePlan } from "../proposals/usePlan";
import { type Preset, presets } from "./cameras";
import {
  type Cells,
  cellsOf,
  distance,
  type Scene,
  sceneOf,
  wayOf,
  wordsOf,
  wordsOfCells,
  wordsOfEllipsoid,
} from "./scene";
import { type Inks, Stage3d } from "./stage3d";
import "./view.css";

const ALIGNMENT_EVERY_MS = 200;
const TARGETING_EVERY_MS = 1000;

/** Robot frame, probe, entry and target where they are in the scanner. */
export default function ViewPage() {
  return (
    <LivePage className="view-page">
      <ViewPanel />
    </LivePage>
  );
}

function ViewPanel() {
  const targeting = usePolled(api.targeting, TARGETING_EVERY_MS);
  const alignment = usePolled(api.alignment, ALIGNMENT_EVERY_MS);
  const aim = useSame(targeting.value);
  const poses = useSame(alignment.value);
  const [preset, setPreset] = useState<Preset | undefined>(presets[0]);
  const [robot, setRobot] = useState(true);
  const [reachWanted, setReachWanted] = useState(false);
  const proposals = useConsole((state) => state.proposals);
  const shown = ghostOf(proposals, useProposalPlace());
  const { plan, notice: planNotice } = usePlan(shown);
  const { reach, notice: reachNotice } = useReach(reachWanted, aim);
  const scene = useMemo(
    () =>
      aim === null || poses === null
        ? null
        : sceneOf(aim, poses, { robot, plan: shown === undefined ? null : plan }),
    [aim, poses, robot, plan, shown],
  );
  const cells = useMemo(
    () => (reach === null || aim === null || poses === null ? null : cellsOf(reach, aim, poses)),
    [reach, aim, poses],
  );
  const notice = alignment.notice ?? targeting.notice ?? planNotice ?? reachNotice;
  const tools = (
    <>
      <GhostChooser proposals={proposals} shown={shown} />
      <Toggle title="Robot" pressed={robot} onPress={setRobot} />
      <Toggle title="Workspace" pressed={reachWanted} onPress={setReachWanted} />
      {presets.map((each) => (
        <button key={each.name} type="button" className="button" onClick={() => setPreset({ ...each })}>
          {each.title}
        </button>
      ))}
    </>
  );
  return (
    <Panel title="3D" className="view-panel" asked={alignment.asked} tools={tools}>
      {notice !== null && (
        <p className="panel-notice" role="alert">
          <NoticeText lead="No newer poses:" notice={notice} />
        </p>
      )}
      {scene !== null && preset !== undefined && <Stage scene={scene} cells={cells} preset={preset} />}
      {scene !== null && <Legend scene={scene} cells={cells} />}
    </Panel>
  );
}

/** The value that was there before, for as long as what is polled says the same: nothing is drawn anew for that. */
function useSame<Value>(value: Value): Value {
  const kept = useRef(value);
  if (JSON.stringify(kept.current) !== JSON.stringify(value)) kept.current = value;
  return kept.current;
}

/** The proposal that was asked for, else the newest that is open. */
function ghostOf(proposals: readonly Proposal[], asked: number | null): Proposal | undefined {
  return asked === null ? proposals.find(isOpen) : proposals.find(({ id }) => id === asked);
}

const MOST_OFFERED = 20;

interface GhostChooserProps {
  readonly proposals: readonly Proposal[];
  readonly shown: Proposal | undefined;
}

function GhostChooser({ proposals, shown }: GhostChooserProps) {
  const newest = proposals.slice(0, MOST_OFFERED);
  const offered = shown === undefined || newest.includes(shown) ? newest : [...newest, shown];
  return (
    <label>
      Ghost of{" "}
      <select
        value={shown?.id ?? ""}
        onChange={({ target }) => {
          window.location.hash = target.value === "" ? "#/view" : proposalHash("view", Number(target.value));
        }}
      >
        <option value="">{shown === undefined ? "no proposal" : "the newest that is open"}</option>
        {offered.map(({ id, axes, state }) => (
          <option key={id} value={id}>
            #{id} {axes.length === 1 ? axes[0] : `${axes.length} axes`}, {state}
          </option>
        ))}
      </select>
    </label>
  );
}

interface ToggleProps {
  readonly title: string;
  readonly pressed: boolean;
  readonly onPress: (pressed: boolean) => void;
}

function Toggle({ title, pressed, onPress }: ToggleProps) {
  return (
    <button type="button" className="button" aria-pressed={pressed} onClick={() => onPress(!pressed)}>
      {title}
    </button>
  );
}

const inkNames = [
  "ground",
  "measured",
  "wish",
  "ghost",
  "target",
  "entry",
  "alarm",
  "robot",
  "reach",
] as const;

/** The canvas; where the browser has no WebGL, the words alone. */
interface StageProps {
  readonly scene: Scene;
  readonly cells: Cells | null;
  readonly preset: Preset;
}

function Stage({ scene, cells, preset }: StageProps) {
  const host = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const stage = useRef<Stage3d | null>(null);
  const [failed, setFailed] = useState(false);
  const newest = useRef({ scene, cells, preset });
  newest.current = { scene, cells, preset };

  useEffect(() => {
    const element = host.current;
    if (element === null || canvas.current === null) return;
    const made = Stage3d.on(canvas.current, newest.current.preset, () => inksOf(element));
    if (made === null) {
      setFailed(true);
      return;
    }
    stage.current = made;
    const watch = new ResizeObserver(() => made.resize(element.clientWidth, element.clientHeight));
    watch.observe(element);
    const repaint = (): void => {
      made.show(newest.current.scene);
      made.showReach(newest.current.cells);
    };
    const theme = new MutationObserver(repaint);
    theme.observe(document.documentElement, { attributeFilter: ["data-theme"] });
    const system = matchMedia("(prefers-color-scheme: dark)");
    system.addEventListener("change", repaint);
    repaint();
    return () => {
      watch.disconnect();
      theme.disconnect();
      system.removeEventListener("change", repaint);
      made.dispose();
      stage.current = null;
    };
  }, []);
  useEffect(() => stage.current?.show(scene), [scene]);
  useEffect(() => stage.current?.showReach(cells), [cells]);
  useEffect(() => stage.current?.look(preset), [preset]);

  const words = [wordsOf(scene), ...(cells === null ? [] : [wordsOfCells(cells)])].join("; ");
  if (failed) {
    return (
      <p className="view-words" role="status">
        This browser has no WebGL, so there is no picture. {words}, in mm RAS.
      </p>
    );
  }
  return (
    <div ref={host} className="view-stage">
      <canvas ref={canvas} role="img" aria-label={`3D: ${words}, in mm RAS`} />
      {inkNames.map((name) => (
        <i key={name} className={`ink view-ink-${name}`} />
      ))}
    </div>
  );
}

function inksOf(host: HTMLElement): Inks {
  const ink = (name: keyof Inks): string => {
    const sample = host.querySelector(`.view-ink-${name}`);
    return sample === null ? "" : getComputedStyle(sample).color;
  };
  return Object.fromEntries(inkNames.map((name) => [name, ink(name)])) as unknown as Inks;
}

interface LegendProps {
  readonly scene: Scene;
  readonly cells: Cells | null;
}

function Legend({ scene, cells }: LegendProps) {
  return (
    <div className="view-legend">
      <ul aria-label="What is shown">
        <li data-ink="measured">━ current probe</li>
        <li data-ink="ghost">▒ reachable: where the setpoints of the target lead</li>
        <li data-ink="wish">╌ desired</li>
        {scene.bodies.some(({ kind }) => kind === "current") && (
          <li>▭ robot: lengths of its model, thickness and the plate's place for the eye</li>
        )}
        {scene.ghost !== null && (
          <li data-ink="ghost">
            ▒ ghost of proposal {scene.ghost.id}: robot and tip at its end, ━ way of the tip,{" "}
            {wayOf(scene.ghost).toFixed(1)} mm
          </li>
        )}
        {cells !== null && <li data-ink="reach">▪ {wordsOfCells(cells)} mm</li>}
        {scene.ellipsoid !== null && (
          <li data-ink="ghost">● {wordsOfEllipsoid(scene.ellipsoid)}: where the treatment point may be</li>
        )}
        <li data-ink="entry">◆ entry</li>
        <li data-ink="target">● target</li>
        <li>axes: x red, y green, z blue; large: {scene.axes.map(({ name }) => name).join(", ")}</li>
      </ul>
      {scene.deviation !== null && (
        <p>
          From current to desired:{" "}
          <output aria-label="Distance from current to desired">
            {distance(...scene.deviation).toFixed(2)} mm
          </output>
        </p>
      )}
      {scene.missing.map((text) => (
        <p key={text} className="view-missing">
          ▲ Not shown. {text}
        </p>
      ))}
    </div>
  );
}

interface Reached {
  readonly reach: Reach | null;
  readonly notice: Notice | null;
}

/** Where the robot gets to; asked for when it is wanted, and anew for another probe. */
function useReach(wanted: boolean, targeting: Targeting | null): Reached {
  const [found, setFound] = useState<Reached>({ reach: null, notice: null });
  const probe = targeting && [targeting.robot_to_entry_offset, targeting.treatment_to_robot_at_home].join();
  useEffect(() => {
    if (!wanted || probe === null) return undefined;
    let gone = false;
    void api.reach().then((outcome) => {
      if (gone) return;
      if (!outcome.ok) setFound({ reach: null, notice: noticeOfProblem(outcome.problem) });
      else setFound({ reach: outcome.value, notice: noticeOfReach(outcome.value) });
    });
    return () => {
      gone = true;
    };
  }, [wanted, probe]);
  return wanted ? found : { reach: null, notice: null };
}

function noticeOfReach({ problem }: Reach): Notice | null {
  return problem === null ? null : { code: problem.code, meaning: problem.text, nextStep: "" };
}

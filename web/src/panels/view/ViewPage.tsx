import { useEffect, useMemo, useRef, useState } from "react";
import { api } from "../../api/client";
import { NoticeText } from "../../design/NoticeText";
import { Panel } from "../../design/Panel";
import { useConsole } from "../../state/store";
import { usePolled } from "../../state/usePolled";
import { Cover } from "../cover/Cover";
import { type Preset, presets } from "./cameras";
import { distance, type Scene, sceneOf, wordsOf } from "./scene";
import { type Inks, Stage3d } from "./stage3d";
import "./view.css";

const ALIGNMENT_EVERY_MS = 200;
const TARGETING_EVERY_MS = 1000;

/** Robot frame, probe, entry and target where they are in the scanner. */
export default function ViewPage() {
  const level = useConsole((state) => state.freshness.level);
  return (
    <div className="stage">
      <main className="panels view-page" data-level={level} inert={level === "covered"}>
        <ViewPanel />
      </main>
      <Cover />
    </div>
  );
}

function ViewPanel() {
  const targeting = usePolled(api.targeting, TARGETING_EVERY_MS);
  const alignment = usePolled(api.alignment, ALIGNMENT_EVERY_MS);
  const [preset, setPreset] = useState<Preset | undefined>(presets[0]);
  const scene = useMemo(
    () =>
      targeting.value === null || alignment.value === null ? null : sceneOf(targeting.value, alignment.value),
    [targeting.value, alignment.value],
  );
  const notice = alignment.notice ?? targeting.notice;
  const tools = presets.map((each) => (
    <button key={each.name} type="button" className="button" onClick={() => setPreset({ ...each })}>
      {each.title}
    </button>
  ));
  return (
    <Panel title="3D" className="view-panel" asked={alignment.asked} tools={tools}>
      {notice !== null && (
        <p className="panel-notice" role="alert">
          <NoticeText lead="No newer poses:" notice={notice} />
        </p>
      )}
      {scene !== null && preset !== undefined && <Stage scene={scene} preset={preset} />}
      {scene !== null && <Legend scene={scene} />}
    </Panel>
  );
}

const inkNames = ["ground", "measured", "wish", "ghost", "target", "entry", "alarm"] as const;

/** The canvas; where the browser has no WebGL, the words alone. */
function Stage({ scene, preset }: { readonly scene: Scene; readonly preset: Preset }) {
  const host = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const stage = useRef<Stage3d | null>(null);
  const [failed, setFailed] = useState(false);
  const newest = useRef({ scene, preset });
  newest.current = { scene, preset };

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
    const repaint = (): void => made.show(newest.current.scene);
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
  useEffect(() => stage.current?.look(preset), [preset]);

  if (failed) {
    return (
      <p className="view-words" role="status">
        This browser has no WebGL, so there is no picture. {wordsOf(scene)}, in mm RAS.
      </p>
    );
  }
  return (
    <div ref={host} className="view-stage">
      <canvas ref={canvas} role="img" aria-label={`3D: ${wordsOf(scene)}, in mm RAS`} />
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

function Legend({ scene }: { readonly scene: Scene }) {
  return (
    <div className="view-legend">
      <ul aria-label="What is shown">
        <li data-ink="measured">━ current probe</li>
        <li data-ink="ghost">▒ reachable: where the setpoints of the target lead</li>
        <li data-ink="wish">╌ desired</li>
        <li data-ink="entry">◆ entry</li>
        <li data-ink="target">● target</li>
        <li>axes: x red, y green, z blue; large: scanner (RAS) and zFrame</li>
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

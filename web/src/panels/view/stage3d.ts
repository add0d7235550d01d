/** The scene on a WebGL canvas. It draws when something changed, and at no other time. */
import {
  AmbientLight,
  BoxGeometry,
  BufferGeometry,
  CanvasTexture,
  Color,
  ConeGeometry,
  CylinderGeometry,
  DirectionalLight,
  Group,
  Line,
  LineBasicMaterial,
  LineDashedMaterial,
  type Material,
  Matrix4,
  Mesh,
  MeshStandardMaterial,
  type Object3D,
  PerspectiveCamera,
  Points,
  PointsMaterial,
  Quaternion,
  Scene as Scene3d,
  SphereGeometry,
  Sprite,
  SpriteMaterial,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { FIELD_OF_VIEW_DEG, type Preset, standOf } from "./cameras";
import {
  type Axes,
  type Ball,
  type Body,
  ballAround,
  type Cells,
  type Ellipsoid,
  type Ghost,
  type Mark,
  type Part,
  type Point,
  type Probe,
  type Scene,
} from "./scene";

/** Colours of the style sheet, as the browser computes them. */
export interface Inks {
  readonly ground: string;
  readonly measured: string;
  readonly wish: string;
  readonly ghost: string;
  readonly target: string;
  readonly entry: string;
  readonly alarm: string;
  readonly robot: string;
  readonly reach: string;
}

/** X red, Y green, Z blue in every viewer of the field; who does not tell the colours apart reads the letters. */
const AXIS_COLOURS = ["#c8443a", "#3d8f4f", "#3f74d1"] as const;
const AXIS_LETTERS = ["x", "y", "z"] as const;
const LETTER_PX = 64;
const PROBE_RADIUS_MM = 1.2;
const MARK_RADIUS_MM = 3;
/** Thickness is no part of the model: what a part is, is seen by it. */
const PART_WIDTH_MM: Record<Part["name"], number> = {
  rail: 6,
  slider: 14,
  link: 5,
  plate: 8,
  lateral: 6,
  arm: 5,
  guide: 7,
  carrier: 6,
  probe: 2 * PROBE_RADIUS_MM,
};
const BOXES: ReadonlySet<Part["name"]> = new Set(["rail", "slider", "plate"]);
const GHOST = { transparent: true, opacity: 0.35, depthWrite: false };
const UP = new Vector3(0, 1, 0);

export class Stage3d {
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene3d();
  private readonly camera = new PerspectiveCamera(FIELD_OF_VIEW_DEG, 1, 1, 20_000);
  private readonly controls: OrbitControls;
  private content = new Group();
  private reach = new Group();
  private cells: Cells | null = null;
  private newest: Scene | null = null;
  private ball: Ball | null = null;
  private preset: Preset;
  private asked = false;

  /** Null where the browser has no WebGL. */
  static on(canvas: HTMLCanvasElement, preset: Preset, inks: () => Inks): Stage3d | null {
    const context = canvas.getContext("webgl2", { antialias: true });
    return context === null ? null : new Stage3d(canvas, context, preset, inks);
  }

  private constructor(
    canvas: HTMLCanvasElement,
    context: WebGL2RenderingContext,
    preset: Preset,
    private readonly inks: () => Inks,
  ) {
    this.renderer = new WebGLRenderer({ canvas, context });
    this.renderer.setPixelRatio(Math.min(globalThis.devicePixelRatio, 2));
    this.preset = preset;
    const sun = new DirectionalLight("#ffffff", 1.6);
    sun.position.set(1, 2, 3);
    this.scene.add(new AmbientLight("#ffffff", 1.6), sun, this.content, this.reach);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.draw());
  }

  resize(width: number, height: number): void {
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  show(scene: Scene): void {
    const inks = this.inks();
    release(this.content);
    this.scene.remove(this.content);
    this.content = new Group();
    this.content.add(
      ...scene.axes.map(axesOf),
      ...scene.bodies.map((body) => bodyOf(body, inks)),
      ...(scene.ghost === null ? [] : [ghostOf(scene.ghost, inks)]),
      ...scene.probes.map((probe) => probeOf(probe, inks)),
      ...scene.marks.map((mark) => markOf(mark, inks)),
      ...(scene.ellipsoid === null ? [] : [ellipsoidOf(scene.ellipsoid, inks)]),
      ...(scene.deviation === null ? [] : [lineOf(scene.deviation, dashed(inks.alarm))]),
    );
    this.scene.add(this.content);
    this.scene.background = new Color(inks.ground);
    const first = this.ball === null;
    this.newest = scene;
    this.ball = ballAround(scene, this.cells);
    if (first) this.look(this.preset);
    else this.draw();
  }

  /** Cells are many and change with the probe alone: they are kept from scene to scene. */
  showReach(cells: Cells | null): void {
    release(this.reach);
    this.reach.clear();
    this.cells = cells;
    if (cells !== null) this.reach.add(cloudOf(cells, this.inks().reach));
    if (this.newest !== null) this.ball = ballAround(this.newest, cells);
    this.draw();
  }

  /** Looks at everything from there. */
  look(preset: Preset): void {
    this.preset = preset;
    if (this.ball === null) return;
    this.camera.up.set(...preset.up);
    this.camera.position.set(...standOf(preset, this.ball, this.camera.aspect));
    this.controls.target.set(...this.ball.centre);
    this.controls.update();
    this.draw();
  }

  dispose(): void {
    release(this.content);
    release(this.reach);
    this.controls.dispose();
    this.renderer.dispose();
  }

  /** Once for all changes before the next picture. */
  private draw(): void {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.renderer.render(this.scene, this.camera);
    });
  }
}

function axesOf({ pose, lengthMm }: Axes): Object3D {
  const group = new Group();
  AXIS_COLOURS.forEach((colour, axis) => {
    const end: Point = [axis === 0 ? lengthMm : 0, axis === 1 ? lengthMm : 0, axis === 2 ? lengthMm : 0];
    group.add(lineOf([[0, 0, 0], end], new LineBasicMaterial({ color: colour })));
    const tip = new Mesh(
      new ConeGeometry(lengthMm / 24, lengthMm / 8, 12),
      new MeshStandardMaterial({ color: colour }),
    );
    tip.position.set(...end);
    tip.quaternion.setFromUnitVectors(UP, new Vector3(...end).normalize());
    group.add(tip, letterAt(axis, new Vector3(...end).multiplyScalar(1.16), lengthMm / 5));
  });
  const [m = [], n = [], o = [], p = []] = [0, 4, 8, 12].map((row) => pose.slice(row, row + 4));
  group.applyMatrix4(new Matrix4().fromArray([...m, ...n, ...o, ...p]).transpose());
  return group;
}

/** The letter of an axis, which faces whoever looks. */
function letterAt(axis: number, at: Vector3, sizeMm: number): Object3D {
  const letter = new Sprite(new SpriteMaterial({ map: letterOf(axis), depthTest: false }));
  letter.position.copy(at);
  letter.scale.setScalar(sizeMm);
  return letter;
}

const letters = new Map<number, CanvasTexture>();

/** Drawn once: the scene is made anew with each pose. */
function letterOf(axis: number): CanvasTexture {
  const known = letters.get(axis);
  if (known !== undefined) return known;
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = LETTER_PX;
  const brush = canvas.getContext("2d");
  if (brush !== null) {
    brush.font = `bold ${LETTER_PX}px sans-serif`;
    brush.textAlign = "center";
    brush.textBaseline = "middle";
    brush.fillStyle = AXIS_COLOURS[axis] ?? "";
    brush.fillText(AXIS_LETTERS[axis] ?? "", LETTER_PX / 2, LETTER_PX / 2);
  }
  const drawn = new CanvasTexture(canvas);
  letters.set(axis, drawn);
  return drawn;
}

function probeOf({ kind, cannula, treatment, tip }: Probe, inks: Inks): Object3D {
  const group = new Group();
  const colour = kind === "current" ? inks.measured : kind === "reachable" ? inks.ghost : inks.wish;
  if (kind === "desired") {
    group.add(lineOf([cannula, tip], dashed(colour)));
    return group;
  }
  const ghost = kind === "reachable" ? { transparent: true, opacity: 0.35 } : {};
  group.add(rodOf(cannula, tip, PROBE_RADIUS_MM, new MeshStandardMaterial({ color: colour, ...ghost })));
  group.add(ballAt(treatment, 1.8 * PROBE_RADIUS_MM, new MeshStandardMaterial({ color: colour, ...ghost })));
  return group;
}

function bodyOf({ kind, parts }: Body, inks: Inks): Object3D {
  const group = new Group();
  const look = kind === "ghost" ? { color: inks.ghost, ...GHOST } : { color: inks.robot };
  for (const { name, from, to } of parts) {
    // The current probe is drawn as such, in its own colour.
    if (name === "probe" && kind === "current") continue;
    const width = PART_WIDTH_MM[name];
    const material = new MeshStandardMaterial(look);
    group.add(BOXES.has(name) ? beamOf(from, to, width, material) : rodOf(from, to, width / 2, material));
  }
  return group;
}

function ghostOf({ path, tip }: Ghost, inks: Inks): Object3D {
  const group = new Group();
  const way = new BufferGeometry().setFromPoints(path.map((point) => new Vector3(...point)));
  group.add(new Line(way, new LineBasicMaterial({ color: inks.ghost })));
  group.add(ballAt(tip, 1.5 * PROBE_RADIUS_MM, new MeshStandardMaterial({ color: inks.ghost })));
  return group;
}

function cloudOf({ cellMm, centres }: Cells, colour: string): Object3D {
  const geometry = new BufferGeometry().setFromPoints(centres.map((centre) => new Vector3(...centre)));
  const material = new PointsMaterial({
    color: colour,
    size: cellMm * 0.6,
    transparent: true,
    opacity: 0.5,
    depthWrite: false,
  });
  return new Points(geometry, material);
}

function markOf({ kind, at }: Mark, inks: Inks): Object3D {
  const material = new MeshStandardMaterial({ color: kind === "target" ? inks.target : inks.entry });
  if (kind === "target") return ballAt(at, MARK_RADIUS_MM, material);
  const cone = new Mesh(new ConeGeometry(MARK_RADIUS_MM, 2 * MARK_RADIUS_MM, 4), material);
  cone.position.set(...at);
  return cone;
}

/** Over the mark of the target, which may be larger. */
function ellipsoidOf({ centre, halfAxesMm, directions }: Ellipsoid, inks: Inks): Object3D {
  const look = { color: inks.ghost, transparent: true, opacity: 0.5, depthTest: false };
  const ball = new Mesh(new SphereGeometry(1, 24, 16), new MeshStandardMaterial(look));
  const columns = halfAxesMm.map((mm, axis) =>
    new Vector3().fromArray(directions, 3 * axis).multiplyScalar(mm),
  ) as [Vector3, Vector3, Vector3];
  ball.applyMatrix4(new Matrix4().makeBasis(...columns).setPosition(...centre));
  return ball;
}

function ballAt(at: Point, radiusMm: number, material: Material): Object3D {
  const ball = new Mesh(new SphereGeometry(radiusMm, 24, 16), material);
  ball.position.set(...at);
  return ball;
}

function rodOf(from: Point, to: Point, radiusMm: number, material: Material): Object3D {
  return between(from, to, (mm) => new Mesh(new CylinderGeometry(radiusMm, radiusMm, mm, 16), material));
}

function beamOf(from: Point, to: Point, widthMm: number, material: Material): Object3D {
  return between(from, to, (mm) => new Mesh(new BoxGeometry(widthMm, mm, widthMm), material));
}

/** What is made along y, from one point to another. */
function between(from: Point, to: Point, make: (mm: number) => Mesh): Object3D {
  const [start, end] = [new Vector3(...from), new Vector3(...to)];
  const way = end.clone().sub(start);
  const solid = make(Math.max(way.length(), 1e-3));
  solid.position.copy(start).addScaledVector(way, 0.5);
  solid.quaternion.copy(new Quaternion().setFromUnitVectors(UP, way.normalize()));
  return solid;
}

function dashed(colour: string): LineDashedMaterial {
  return new LineDashedMaterial({ color: colour, dashSize: 3, gapSize: 2 });
}

function lineOf(ends: readonly [Point, Point], material: Material): Line {
  const line = new Line(new BufferGeometry().setFromPoints(ends.map((end) => new Vector3(...end))), material);
  return line.computeLineDistances();
}

function release(group: Group): void {
  group.traverse((each) => {
    if (each instanceof Mesh || each instanceof Line || each instanceof Points) {
      each.geometry.dispose();
      each.material.dispose();
    } else if (each instanceof Sprite) each.material.dispose();
  });
}

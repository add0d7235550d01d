/** Where the camera looks from. Axes of the scanner: x to the right (R), y to the front (A), z to the head (S). */
import type { Ball, Point } from "./scene";

export interface Preset {
  readonly name: string;
  readonly title: string;
  /** From what is looked at towards the camera. */
  readonly from: Point;
  readonly up: Point;
}

export const presets: readonly Preset[] = [
  { name: "free", title: "Oblique", from: [0.62, 0.62, 0.48], up: [0, 0, 1] },
  { name: "axial", title: "Axial, from the feet", from: [0, 0, -1], up: [0, 1, 0] },
  { name: "coronal", title: "Coronal, from the front", from: [0, 1, 0], up: [0, 0, 1] },
  { name: "sagittal", title: "Sagittal, from the right", from: [1, 0, 0], up: [0, 0, 1] },
];

export const FIELD_OF_VIEW_DEG = 35;

/** Where the camera stands so that the whole ball is seen, also in a view that is higher than wide. */
export function standOf(preset: Preset, ball: Ball, aspect: number): Point {
  const half = (FIELD_OF_VIEW_DEG * Math.PI) / 360;
  const narrow = aspect < 1 ? Math.atan(Math.tan(half) * aspect) : half;
  const farMm = ball.radiusMm / Math.sin(narrow);
  const length = Math.hypot(...preset.from);
  const at = (axis: 0 | 1 | 2): number => ball.centre[axis] + (preset.from[axis] / length) * farMm;
  return [at(0), at(1), at(2)];
}

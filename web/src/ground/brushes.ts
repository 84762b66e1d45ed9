/** The sculpting tools: what each does with the pointer, and how strong it is. */

import type { StrokeKind } from '../experiment/experiment.ts';

/** `spray` works as long as it is held, `stamp` once, `line` from press to release. */
export type Gesture = 'spray' | 'stamp' | 'line';

export interface BrushTool {
  readonly kind: StrokeKind;
  readonly gesture: Gesture;
  /** Height changed by a touch at full strength: metres, or a part of the radius. */
  readonly most_m?: number;
  readonly mostRadii?: number;
}

export const BRUSHES = {
  raise: { kind: 'raise', gesture: 'spray', mostRadii: 0.1 },
  lower: { kind: 'lower', gesture: 'spray', mostRadii: 0.1 },
  smooth: { kind: 'smooth', gesture: 'spray', most_m: 0.35 },
  flatten: { kind: 'level', gesture: 'spray', most_m: 0.35 },
  height: { kind: 'level', gesture: 'spray', most_m: 0.35 },
  ramp: { kind: 'ramp', gesture: 'line' },
  roughen: { kind: 'roughen', gesture: 'spray', mostRadii: 0.06 },
  crater: { kind: 'crater', gesture: 'stamp', mostRadii: 1 },
  ditch: { kind: 'ditch', gesture: 'line', mostRadii: 1 },
  boulder: { kind: 'boulder', gesture: 'stamp', mostRadii: 1 },
} as const satisfies Record<string, BrushTool>;

export type BrushName = keyof typeof BRUSHES;

/** A ramp goes all the way to its slope. */
const ALL_M = 100;

/** The largest change of a height by one touch, in whole millimetres, for a strength from 0 to 1. */
export function strength_m(name: BrushName, radius_m: number, strength: number): number {
  const { most_m, mostRadii }: BrushTool = BRUSHES[name];
  if (most_m === undefined && mostRadii === undefined) return ALL_M;
  return Math.round(1000 * strength * ((most_m ?? 0) + (mostRadii ?? 0) * radius_m)) / 1000;
}

/** The colours of the drawings, read from the style sheet so that each is written once, for light and for dark. */

import { parseHex, type Rgb } from './scale.ts';

export interface Theme {
  readonly dark: boolean;
  readonly ink: Rgb;
  readonly muted: Rgb;
  readonly accent: Rgb;
  readonly goal: Rgb;
  readonly danger: Rgb;
  readonly surface: Rgb;
  /** From the lowest to the highest ground. */
  readonly relief: readonly Rgb[];
  /** From level to steep. */
  readonly slope: readonly Rgb[];
  /** Where the robot may stand at any heading, at some, at none. */
  readonly stand: readonly Rgb[];
  readonly rock: Rgb;
  /** What stands on the ground, and what walks on it. */
  readonly object: Rgb;
  readonly mover: Rgb;
  /** The robot where it believes to be. */
  readonly believed: Rgb;
  /** An object in hand. */
  readonly held: Rgb;
  readonly contour: Rgb;
  /** From observed (low variance) to free (high variance). */
  readonly variance: readonly Rgb[];
  readonly returnNear: Rgb;
  readonly returnFar: Rgb;
  /** Returns that the planner sets aside. */
  readonly returnStray: Rgb;
  readonly returnBody: Rgb;
  readonly returnOverhead: Rgb;
}

const scheme = window.matchMedia('(prefers-color-scheme: dark)');

export function readTheme(): Theme {
  const style = getComputedStyle(document.documentElement);
  const colour = (name: string) => parseHex(style.getPropertyValue(`--${name}`));
  return {
    dark: scheme.matches,
    ink: colour('ink'),
    muted: colour('muted'),
    accent: colour('accent'),
    goal: colour('goal'),
    danger: colour('danger'),
    surface: colour('surface'),
    relief: [0, 1, 2, 3, 4].map((step) => colour(`relief-${step}`)),
    slope: [0, 1, 2, 3, 4].map((step) => colour(`slope-${step}`)),
    stand: [0, 1, 2].map((step) => colour(`stand-${step}`)),
    rock: colour('relief-rock'),
    object: colour('object'),
    mover: colour('mover'),
    believed: colour('believed'),
    held: colour('accent-fill'),
    contour: colour('relief-contour'),
    variance: [0, 1, 2].map((step) => colour(`variance-${step}`)),
    returnNear: colour('return-near'),
    returnFar: colour('return-far'),
    returnStray: colour('return-stray'),
    returnBody: colour('return-body'),
    returnOverhead: colour('return-overhead'),
  };
}

/** Calls back now and whenever the system changes between light and dark. */
export function watchTheme(apply: (theme: Theme) => void): void {
  scheme.addEventListener('change', () => apply(readTheme()));
  apply(readTheme());
}

/**
 * What somebody points at, wherever that is: a subgoal or a segment of the newest tick. Each tick finds other subgoals, so
 * what is pointed at is a way to find it in a frame.
 */

import { wrap } from '../base/format.ts';
import type { Frame } from '../protocol/simulationProtocol.ts';

/** Indices in a frame; a subgoal brings its segment along. */
export interface Target {
  readonly subgoal: number | undefined;
  readonly segment: number | undefined;
}

export type Finder = (frame: Frame) => Target | undefined;

/** A subgoal farther than this from where the last one was is another one. */
const SAME_WITHIN_RAD = 0.2;

export class SelectionModel {
  readonly #changed: (frame: Frame, target: Target | undefined) => void;
  #frame: Frame | undefined;
  #hovered: Finder | undefined;
  #pinned: Finder | undefined;

  constructor(changed: (frame: Frame, target: Target | undefined) => void) {
    this.#changed = changed;
  }

  get target(): Target | undefined {
    return this.#frame && (this.#hovered?.(this.#frame) ?? this.#pinned?.(this.#frame));
  }

  get pinned(): boolean {
    return this.#pinned !== undefined;
  }

  /** What was pointed at is looked for in the new frame. */
  show(frame: Frame): void {
    this.#frame = frame;
    this.#tell();
  }

  /** While the pointer or the focus is there. */
  hover(finder: Finder | undefined): void {
    if (!finder && !this.#hovered) return;
    this.#hovered = finder;
    this.#tell();
  }

  /** Keeps what is found now in sight, until something else is pinned or nothing. */
  pin(finder: Finder | undefined): void {
    const target = this.#frame && finder?.(this.#frame);
    this.#pinned = this.#frame && target ? following(this.#frame, target) : undefined;
    this.#tell();
  }

  #tell(): void {
    if (this.#frame) this.#changed(this.#frame, this.target);
  }
}

/** A subgoal with its segment. */
export function subgoalTarget({ subgoals }: Frame, index: number): Target | undefined {
  const one = subgoals[index];
  return one && { subgoal: index, segment: one.segment };
}

/** The segment at an azimuth. */
export function segmentAt({ segments }: Frame, azimuth_rad: number): number | undefined {
  const index = segments.findIndex(({ begin_rad, end_rad }) => {
    const from_rad = wrap(azimuth_rad - begin_rad);
    return (from_rad < 0 ? from_rad + 2 * Math.PI : from_rad) < end_rad - begin_rad;
  });
  return index < 0 ? undefined : index;
}

/** Finds in later frames what lies in the same direction of the world. */
export function following(frame: Frame, target: Target): Finder {
  const subgoal = target.subgoal === undefined ? undefined : frame.subgoals[target.subgoal];
  const segment = target.segment === undefined ? undefined : frame.segments[target.segment];
  const azimuth_rad = subgoal?.azimuth_rad ?? (segment ? (segment.begin_rad + segment.end_rad) / 2 : 0);
  const bearing_rad = frame.pose.yaw + azimuth_rad;
  return (later) => {
    const here_rad = wrap(bearing_rad - later.pose.yaw);
    if (!subgoal) return { subgoal: undefined, segment: segmentAt(later, here_rad) };
    let [best, off_rad] = [-1, SAME_WITHIN_RAD];
    later.subgoals.forEach((one, index) => {
      const apart_rad = Math.abs(wrap(one.azimuth_rad - here_rad));
      if (apart_rad < off_rad) [best, off_rad] = [index, apart_rad];
    });
    return subgoalTarget(later, best);
  };
}

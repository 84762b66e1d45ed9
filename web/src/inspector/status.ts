/** How the trial stands: outcome, clock, decision in words, and what the machine did. */

import { setText } from '../base/dom.ts';
import { clock, fixed, grouped } from '../base/format.ts';
import type { Activity, Frame, Outcome, SessionInfo } from '../protocol/simulationProtocol.ts';
import { perceptionFault, reason } from './reason.ts';

export const OUTCOME_WORDS: Record<Outcome, string> = {
  running: 'Driving',
  reached: 'Goal reached',
  tilt_limit: 'Tipped too far',
  collision: 'Collided',
  high_centred: 'High-centred',
  step: 'Stopped by a step',
  stuck: 'Stuck',
  no_subgoal: 'No safe path found',
  left_terrain: 'Left the terrain',
  timeout: 'Out of time',
};

/** How a trial ended; a planner that saw nothing, or noticed that it gets nowhere, has not looked for a path in vain. */
export function outcomeWords(frame: Pick<Frame, 'outcome' | 'stop_reason'>): string {
  if (frame.outcome !== 'no_subgoal') return OUTCOME_WORDS[frame.outcome];
  if (perceptionFault(frame) !== undefined) return 'Perception failed';
  return OUTCOME_WORDS[frame.stop_reason?.startsWith('no progress') ? 'stuck' : 'no_subgoal'];
}

const ACTIVITY_WORDS: Record<Activity, string> = {
  driving: 'Driving',
  arrived: 'Driving',
  backtracking: 'Backtracking',
  searching: 'Searching',
  stopped: 'Standing',
};

/** How the trial stands, in two or three words. */
export function standing(frame: Frame, playing: boolean): string {
  const { outcome, activity, thought } = frame;
  if (!playing && thought === 'what_if') return 'What if';
  if (outcome !== 'running') return outcomeWords(frame);
  return playing ? ACTIVITY_WORDS[activity] : 'Paused';
}

export interface StatusElements {
  readonly outcome: HTMLElement;
  readonly time: HTMLElement;
  readonly speed: HTMLElement;
  readonly reason: HTMLElement;
  readonly returns: HTMLElement;
  readonly digest: HTMLElement;
  /** Announced to screen readers, only when a trial ends. */
  readonly announcement: HTMLElement;
}

export class StatusPanel {
  readonly #elements: StatusElements;
  #outcome: Outcome | undefined;
  #info: SessionInfo | undefined;

  constructor(elements: StatusElements) {
    this.#elements = elements;
  }

  session(info: SessionInfo): void {
    this.#info = info;
  }

  show(frame: Frame, playing: boolean): void {
    const { outcome, time, speed, returns, digest, announcement } = this.#elements;
    const words = standing(frame, playing);
    setText(outcome, words);
    outcome.dataset.outcome = frame.outcome === 'running' && !playing ? 'paused' : frame.outcome;
    setText(time, clock(frame.time_s));
    setText(speed, `${fixed(frame.v_m_s, 2)} m/s`);
    const why = this.#info ? reason(frame, this.#info) : '';
    setText(this.#elements.reason, why);
    setText(returns, grouped(frame.returns));
    setText(digest, frame.digest);
    if (this.#outcome !== frame.outcome) {
      this.#outcome = frame.outcome;
      setText(announcement, frame.outcome === 'running' ? '' : `${words}. ${why}`);
    }
  }
}

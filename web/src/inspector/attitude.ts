/** Roll and pitch: the robot's outline against its limits, with the largest angle so far. */

import { html, setText, svg } from '../base/dom.ts';
import { degrees, fixed } from '../base/format.ts';

/** Part of the limit from which on the instrument warns. */
const WARN = 0.8;
const RADIUS = 58;
/** The dial ends here on either side, in degrees. */
const SPAN_DEG = 55;

interface Look {
  readonly name: string;
  /** Outline of the robot, drawn level, around its contact with the ground. */
  readonly outline: () => SVGElement[];
  /** Sign of the turn on the screen: SVG turns clockwise. */
  readonly turn: 1 | -1;
}

export const ROLL: Look = { name: 'Roll', outline: rear, turn: 1 };
export const PITCH: Look = { name: 'Pitch', outline: side, turn: -1 };

export class AttitudeInstrument {
  readonly element: HTMLElement;
  readonly #look: Look;
  readonly #robot: SVGGElement;
  readonly #needle: SVGPathElement;
  readonly #extent: SVGPathElement;
  readonly #limits: SVGGElement;
  readonly #value = html('span', 'instrument-value');
  readonly #note = html('span', 'instrument-note');
  #limit_rad = 1;

  constructor(look: Look) {
    this.#look = look;
    this.#robot = svg('g', { class: 'instrument-robot' }, look.outline());
    this.#needle = svg('path', { class: 'instrument-needle', d: `M ${RADIUS - 9} 0 h 12 M ${9 - RADIUS} 0 h -12` });
    this.#extent = svg('path', { class: 'instrument-extent' });
    this.#limits = svg('g', { class: 'instrument-limits' });
    const dial = svg('svg', { viewBox: '-74 -52 148 104', 'aria-hidden': 'true', class: 'instrument-dial' }, [
      svg('path', { class: 'instrument-level', d: 'M -50 20 H 50' }),
      svg('path', { class: 'instrument-arc', d: arc(-SPAN_DEG, SPAN_DEG) }),
      this.#extent,
      this.#limits,
      this.#robot,
      this.#needle,
    ]);
    this.element = html('div', 'instrument', [
      html('h3', 'instrument-name', [look.name]),
      dial,
      html('p', 'instrument-reading', [this.#value, this.#note]),
    ]);
  }

  limit(limit_rad: number): void {
    this.#limit_rad = limit_rad;
    const limit_deg = (limit_rad * 180) / Math.PI;
    const mark = (angle_deg: number) => svg('path', { d: tick(angle_deg), class: 'instrument-limit' });
    this.#limits.replaceChildren(
      svg('path', { class: 'instrument-forbidden', d: arc(limit_deg, SPAN_DEG) }),
      svg('path', { class: 'instrument-forbidden', d: arc(-SPAN_DEG, -limit_deg) }),
      mark(limit_deg),
      mark(-limit_deg),
    );
  }

  /** `largest_rad` is the largest so far; nothing where that is not known. */
  show(angle_rad: number, largest_rad: number | undefined): void {
    const turn = `rotate(${((this.#look.turn * angle_rad * 180) / Math.PI).toFixed(2)})`;
    this.#robot.setAttribute('transform', turn);
    this.#needle.setAttribute('transform', turn);
    const reach_deg = Math.min(((largest_rad ?? 0) * 180) / Math.PI, SPAN_DEG);
    this.#extent.setAttribute('d', arc(-reach_deg, reach_deg));
    const part = Math.abs(angle_rad) / this.#limit_rad;
    this.element.dataset.state = part >= 1 ? 'over' : part >= WARN ? 'near' : 'safe';
    setText(this.#value, degrees(angle_rad, 1));
    const limit = degrees(this.#limit_rad);
    setText(this.#note, largest_rad === undefined ? `limit ${limit}` : `max ${degrees(largest_rad)} / ${limit}`);
    this.element.title = `${this.#look.name} ${fixed(angle_rad, 3)} rad, limit ${fixed(this.#limit_rad, 3)} rad`;
  }
}

function at(angle_deg: number, radius: number): string {
  // Angles run from the right-hand horizontal; positive turns up.
  const angle = (angle_deg * Math.PI) / 180;
  return `${(radius * Math.cos(angle)).toFixed(2)} ${(-radius * Math.sin(angle)).toFixed(2)}`;
}

/** Arcs on both sides of the dial, from one angle to another, mirrored like the ends of a balance. */
function arc(from_deg: number, to_deg: number): string {
  const right = `M ${at(from_deg, RADIUS)} A ${RADIUS} ${RADIUS} 0 0 0 ${at(to_deg, RADIUS)}`;
  const left = `M ${at(180 + from_deg, RADIUS)} A ${RADIUS} ${RADIUS} 0 0 0 ${at(180 + to_deg, RADIUS)}`;
  return `${right} ${left}`;
}

function tick(angle_deg: number): string {
  const line = (angle: number) => `M ${at(angle, RADIUS - 6)} L ${at(angle, RADIUS + 6)}`;
  return `${line(angle_deg)} ${line(180 + angle_deg)}`;
}

/** Seen from behind: wheels left and right, mast with the sensor. */
function rear(): SVGElement[] {
  return [
    svg('rect', { x: -28, y: -2, width: 10, height: 22, rx: 3, class: 'part-wheel' }),
    svg('rect', { x: 18, y: -2, width: 10, height: 22, rx: 3, class: 'part-wheel' }),
    svg('rect', { x: -18, y: -4, width: 36, height: 16, rx: 2, class: 'part-body' }),
    svg('rect', { x: -22, y: -8, width: 44, height: 4, rx: 2, class: 'part-deck' }),
    svg('path', { d: 'M -9 -8 V -26 M 9 -8 V -26 M -11 -26 H 11', class: 'part-mast' }),
    svg('rect', { x: -5, y: -35, width: 10, height: 8, rx: 2, class: 'part-sensor' }),
  ];
}

/** Seen from the right, driving to the right: positive pitch lifts the nose. */
function side(): SVGElement[] {
  return [
    svg('path', { d: 'M -34 -4 H 30 L 34 2 V 10 L 30 13 H -30 L -34 10 Z', class: 'part-body' }),
    svg('rect', { x: -32, y: -8, width: 60, height: 4, rx: 2, class: 'part-deck' }),
    svg('circle', { cx: -19, cy: 9, r: 11, class: 'part-wheel' }),
    svg('circle', { cx: 19, cy: 9, r: 11, class: 'part-wheel' }),
    svg('circle', { cx: -19, cy: 9, r: 4, class: 'part-deck' }),
    svg('circle', { cx: 19, cy: 9, r: 4, class: 'part-deck' }),
    svg('path', { d: 'M -7 -8 V -26 M 7 -8 V -26 M -9 -26 H 9', class: 'part-mast' }),
    svg('rect', { x: -5, y: -35, width: 10, height: 8, rx: 2, class: 'part-sensor' }),
  ];
}

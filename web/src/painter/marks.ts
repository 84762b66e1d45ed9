/** What somebody points at: a bright rim and a pin on a subgoal, the line to it, and its segment as a thick arc. */

import { BackSide, CylinderGeometry, Group, Mesh, MeshBasicMaterial, SphereGeometry } from 'three';
import type { Theme } from '../colours/theme.ts';
import { segmentArc } from '../scene/segmentArc.ts';
import type { Target } from '../scene/selection.ts';
import type { Seen } from './painterProtocol.ts';
import { colour } from './relief.ts';
import { MARKS_ORDER } from './subgoals.ts';
import { ThickLines } from './thickLines.ts';

const RIM_M = 0.4;
const PIN_M = 1.6;

export class Marks {
  readonly group = new Group();
  readonly #look = new MeshBasicMaterial({ side: BackSide });
  readonly #rim = new Mesh(new SphereGeometry(RIM_M, 24, 16), this.#look);
  readonly #pin = new Mesh(
    new CylinderGeometry(0.03, 0.03, PIN_M, 6).rotateX(Math.PI / 2).translate(0, 0, PIN_M / 2),
    new MeshBasicMaterial(),
  );
  readonly #arc = new ThickLines(256, 9, 0.75);

  constructor(theme: Theme) {
    this.group.add(this.#rim, this.#pin, this.#arc.line);
    for (const mark of [this.#rim, this.#pin, this.#arc.line]) mark.renderOrder = MARKS_ORDER;
    for (const { material } of [this.#rim, this.#pin]) material.transparent = true;
    this.group.visible = false;
    this.theme(theme);
  }

  theme(theme: Theme): void {
    this.#look.color.copy(colour(theme.accent));
    this.#pin.material.color.copy(colour(theme.accent));
  }

  show(seen: Seen, target: Target | undefined, radius_m: number, height: (x: number, y: number) => number): void {
    this.group.visible = target !== undefined;
    const subgoal = target?.subgoal === undefined ? undefined : seen.subgoals[target.subgoal];
    const segment = target?.segment === undefined ? undefined : seen.segments[target.segment];
    for (const mark of [this.#rim, this.#pin]) mark.visible = subgoal !== undefined;
    if (subgoal) {
      const z = Math.max(subgoal.z, height(subgoal.x, subgoal.y) + 0.2);
      this.#rim.position.set(subgoal.x, subgoal.y, z);
      this.#pin.position.set(subgoal.x, subgoal.y, z);
    }
    this.#arc.clear();
    if (segment) this.#arc.add(segmentArc(segment, seen.sensor, radius_m), this.#look.color);
    this.#arc.done();
  }
}

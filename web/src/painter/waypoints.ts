/** The waypoints before the goal, as numbered signs that face the viewer. */

import { CanvasTexture, CylinderGeometry, Group, Mesh, MeshBasicMaterial, Sprite, SpriteMaterial } from 'three';
import { css } from '../colours/scale.ts';
import type { Theme } from '../colours/theme.ts';
import type { Place } from '../experiment/place.ts';
import type { Vector } from '../ground/heightField.ts';
import { colour } from './relief.ts';

const SIGN_PX = 128;
const SIGN_M = 0.9;
const POLE_M = 2.2;
const PASSED_OPACITY = 0.35;
/** From farther away a sign grows with the distance. */
const FULL_SIZE_WITHIN_M = 40;

type Height = (x: number, y: number) => number;

interface Sign {
  readonly place: Place;
  readonly group: Group;
  readonly face: SpriteMaterial;
}

export class Waypoints {
  readonly group = new Group();
  readonly #pole = new CylinderGeometry(0.05, 0.05, POLE_M, 8).rotateX(Math.PI / 2).translate(0, 0, POLE_M / 2);
  readonly #poleLook = new MeshBasicMaterial();
  #theme: Theme | undefined;
  #signs: Sign[] = [];
  #passed = 0;

  theme(theme: Theme): void {
    this.#theme = theme;
    this.#poleLook.color.copy(colour(theme.ink));
    for (const [index, { face }] of this.#signs.entries()) this.#paint(face, index + 1);
  }

  show(places: readonly Place[], height: Height): void {
    for (const { group, face } of this.#signs) {
      this.group.remove(group);
      face.map?.dispose();
      face.dispose();
    }
    this.#signs = places.map((place, index) => {
      const face = new SpriteMaterial({ depthTest: false, transparent: true });
      this.#paint(face, index + 1);
      const sprite = new Sprite(face);
      sprite.position.z = POLE_M + SIGN_M / 2;
      sprite.scale.setScalar(SIGN_M);
      const group = new Group();
      group.add(new Mesh(this.#pole, this.#poleLook), sprite);
      this.group.add(group);
      return { place, group, face };
    });
    this.passed(this.#passed);
    this.settle(height);
  }

  /** Stands the signs on the ground again, after it has changed. */
  settle(height: Height): void {
    for (const { place, group } of this.#signs) group.position.set(place.x, place.y, height(place.x, place.y));
  }

  /** Those behind the robot fade. */
  passed(count: number): void {
    this.#passed = count;
    for (const [index, { face }] of this.#signs.entries()) face.opacity = index < count ? PASSED_OPACITY : 1;
  }

  /** Keeps the signs in sight from afar. */
  face({ x, y, z }: Vector): void {
    for (const { group } of this.#signs) {
      const { position } = group;
      const away_m = Math.hypot(x - position.x, y - position.y, z - position.z);
      group.scale.setScalar(Math.max(1, away_m / FULL_SIZE_WITHIN_M));
    }
  }

  #paint(face: SpriteMaterial, number: number): void {
    const canvas = new OffscreenCanvas(SIGN_PX, SIGN_PX);
    const context = canvas.getContext('2d');
    if (!context || !this.#theme) return;
    const middle = SIGN_PX / 2;
    context.beginPath();
    context.arc(middle, middle, middle - 7, 0, 2 * Math.PI);
    context.fillStyle = css(this.#theme.goal);
    context.fill();
    context.lineWidth = 9;
    context.strokeStyle = css(this.#theme.surface);
    context.stroke();
    context.fillStyle = css(this.#theme.surface);
    context.font = `600 ${number < 10 ? 74 : 58}px system-ui, sans-serif`;
    context.textAlign = 'center';
    context.textBaseline = 'middle';
    context.fillText(String(number), middle, middle + 4);
    face.map?.dispose();
    face.map = new CanvasTexture(canvas);
    face.needsUpdate = true;
  }
}

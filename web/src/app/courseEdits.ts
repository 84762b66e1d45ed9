/** What somebody does to the course: where to drive, from where, over what ground and past what. */

import type { Editor } from '../editor/editor.ts';
import type { Stroke } from '../experiment/experiment.ts';
import type { WorldObject } from '../experiment/objects.ts';
import type { Goal, Heading, Place } from '../experiment/place.ts';
import type { Frame, SessionInfo } from '../protocol/simulationProtocol.ts';

export interface Now {
  info(): SessionInfo | undefined;
  frame(): Frame | undefined;
  /** Somebody is at work: nothing is to happen by itself. */
  edited(): void;
}

export class CourseEdits {
  readonly #editor: Editor;
  readonly #now: Now;

  constructor(editor: Editor, now: Now) {
    [this.#editor, this.#now] = [editor, now];
  }

  /** The goal, with waypoints to drive to before it. */
  async setGoal(goal: Goal, waypoints: readonly Place[] = []): Promise<void> {
    this.#now.edited();
    await this.#editor.setRoute(() => ({ waypoints, goal }));
  }

  /** The heading to end with at the goal; any heading without one. */
  async setGoalHeading(heading_rad: number | undefined): Promise<void> {
    const info = this.#now.info();
    if (!info) return;
    const { x, y } = info.goal;
    const goal = heading_rad === undefined ? { x, y } : { x, y, heading_rad };
    // What the robot has been to stays behind it.
    await this.setGoal(goal, info.waypoints.slice(this.#now.frame()?.waypoints_passed ?? 0));
  }

  /** A waypoint before the goal, after those there are; a robot at its goal goes on to it. */
  async addWaypoint(place: Place): Promise<void> {
    this.#now.edited();
    await this.#editor.setRoute(() => {
      const [info, frame] = [this.#now.info(), this.#now.frame()];
      const reached = frame?.outcome === 'reached' && frame.tick === frame.timeline.end;
      if (!info || reached) return { waypoints: [], goal: place };
      // What the robot has been to stays behind it.
      return { waypoints: [...info.waypoints.slice(frame?.waypoints_passed ?? 0), place], goal: info.goal };
    });
  }

  async setStart(start: Heading): Promise<void> {
    this.#now.edited();
    await this.#editor.setStart(start);
  }

  /** Other objects in place of those there are, which `change` is given. */
  async setObjects(change: (objects: readonly WorldObject[]) => readonly WorldObject[]): Promise<void> {
    this.#now.edited();
    await this.#editor.setObjects(change);
  }

  /** A whole stroke at once. */
  sculpt({ points_cm, ...brush }: Stroke): Promise<void> {
    const stroke = this.#editor.stroke(brush);
    for (let at = 0; at + 1 < points_cm.length; at += 2) {
      stroke.touch({ x: (points_cm[at] ?? 0) / 100, y: (points_cm[at + 1] ?? 0) / 100 });
    }
    return stroke.end();
  }
}

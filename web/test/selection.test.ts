import assert from 'node:assert/strict';
import { test } from 'node:test';
import { neighbour } from '../src/inspector/varianceImage.ts';
import type { Frame, Segment, Subgoal } from '../src/protocol/simulationProtocol.ts';
import { SelectionModel, segmentAt, subgoalTarget, type Target } from '../src/scene/selection.ts';

const segments = [
  { begin_rad: -3, end_rad: 0 },
  { begin_rad: 0, end_rad: 3 },
  { begin_rad: 3, end_rad: 2 * Math.PI - 3 },
] as Segment[];
const frame = (yaw: number, azimuths_rad: number[]): Frame => {
  const subgoals = azimuths_rad.map((azimuth_rad, index) => ({ azimuth_rad, segment: 0, chosen: index === 1 }));
  // A selection reads no more of a frame.
  return { pose: { yaw }, segments, subgoals: subgoals as Subgoal[] } as unknown as Frame;
};

test('every azimuth has its segment, also behind the robot', () => {
  const found = [-2.9, -0.1, 0.1, 2.9, 3.1, -3.1].map((azimuth_rad) => segmentAt(frame(0, []), azimuth_rad));
  assert.deepEqual(found, [0, 0, 1, 1, 2, 2]);
});

test('what is pinned stays marked while the robot turns, and is let go of', () => {
  const marks: (Target | undefined)[] = [];
  const selection = new SelectionModel((_, target) => marks.push(target));
  selection.show(frame(0, [0.5, 1.0]));
  selection.pin((now) => subgoalTarget(now, 1));
  assert.deepEqual(marks.at(-1), { subgoal: 1, segment: 0 });
  // A quarter turn to the left later, the same direction of the world is first.
  selection.show(frame(1.5, [-0.52, 0.9, 2]));
  assert.deepEqual(marks.at(-1), { subgoal: 0, segment: 0 });
  selection.show(frame(1.5, [0.9, 2]));
  assert.equal(marks.at(-1), undefined);
  selection.hover((now) => subgoalTarget(now, 0));
  assert.equal(marks.at(-1)?.subgoal, 0);
  selection.hover(undefined);
  selection.show(frame(1.5, [-0.5]));
  assert.equal(marks.at(-1)?.subgoal, 0);
  selection.pin(undefined);
  assert.equal(marks.at(-1), undefined);
});

test('stepping begins at the choice and goes around from left to right', () => {
  const now = frame(0, [-1, 0.5, 2]);
  const walk = [1, 2, 3, 4].reduce<(number | undefined)[]>((seen) => {
    const last = seen.at(-1);
    return [...seen, neighbour(now, last === undefined ? undefined : { subgoal: last, segment: 0 }, 1, false)?.subgoal];
  }, []);
  assert.deepEqual(walk, [1, 0, 2, 1]);
  assert.equal(neighbour(now, { subgoal: 2, segment: 0 }, -1, false)?.subgoal, 0);
  assert.equal(neighbour(now, undefined, 1, true)?.segment, 1);
  assert.equal(neighbour(frame(0, []), undefined, 1, false), undefined);
});

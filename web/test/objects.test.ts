import assert from 'node:assert/strict';
import { test } from 'node:test';
import {
  endsOf,
  makeObject,
  moved,
  objectName,
  PALETTE,
  placeOf,
  resized,
  tidyObject,
  turned,
  turns,
  walkOf,
  withEnd,
} from '../src/experiment/objects.ts';
import { readObjects } from '../src/experiment/readObjects.ts';
import type { Solid } from '../src/protocol/simulationProtocol.ts';
import { nearestSolid } from '../src/view/nearestSolid.ts';
import { OBJECTS } from './example.ts';

test('what the palette makes is valid, and stays so moved, turned and sized', () => {
  for (const kind of PALETTE) {
    let object = makeObject(kind, { x: 1, y: 1 }, 0.7);
    object = resized(turned(moved(object, { x: -3, y: 40 }), 1), 3);
    const tidy = tidyObject(object, 20, 30);
    assert.deepEqual(readObjects([tidy]), [tidy], kind);
    const { x, y } = placeOf(tidy);
    assert.ok(x >= 0 && x <= 20 && y >= 0 && y <= 30, kind);
  }
});

test('a wall and a way go from end to end, or else across the heading', () => {
  const wall = makeObject('wall', { x: 1, y: 2 }, 0, { x: 5, y: 2 });
  assert.deepEqual(endsOf(wall), [
    { x: 1, y: 2 },
    { x: 5, y: 2 },
  ]);
  assert.deepEqual(endsOf(withEnd(wall, 0, { x: 3, y: 3 }))[0], { x: 3, y: 3 });
  assert.deepEqual(walkOf(makeObject('person', { x: 1, y: 2 }, 0)).at(-1), { x: 1, y: 7 });
  assert.deepEqual(placeOf(makeObject('wall', { x: 10, y: 10 }, 0)), { x: 10, y: 10 });
});

test('turning keeps the middle, and takes the walk along', () => {
  const [person, , rock, wall] = OBJECTS;
  assert.ok(person && rock && wall);
  const turnedWall = tidyObject(turned(wall, Math.PI / 2), 99, 99);
  assert.deepEqual(turnedWall, { ...wall, from: [2.5, 0.5], to: [2.5, 3.5] });
  assert.deepEqual(tidyObject(turned(person, -Math.PI / 2), 99, 99), {
    ...person,
    walk: { path: [[9, 1]], speed_m_s: 0.8 },
  });
  assert.deepEqual([turns(person), turns(rock), turns(wall)], [true, false, true]);
  assert.equal(objectName(person, 0), 'Person 1');
});

test('the nearest object under the pointer is met; a finger meets a thin one beside it', () => {
  const post = (object: number, y: number): Solid => ({
    object,
    shape: 'cylinder',
    centre_m: [0, y, 0.5],
    size_m: [0.2, 0.2, 1],
    sin_cos_yaw: [0, 1],
  });
  const at = (x: number, room: number) =>
    nearestSolid([post(0, 20), post(1, 10)], { x, y: 0, z: 0.5 }, { x: 0, y: 1, z: 0 }, room);
  assert.equal(at(0, 0), 1);
  assert.equal(at(0.3, 0), undefined);
  assert.equal(at(0.3, 0.03), 1);
});

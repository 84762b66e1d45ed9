import assert from 'node:assert/strict';
import { test } from 'node:test';
import type { Vector } from '../src/ground/heightField.ts';
import { sensorAt } from '../src/scene/sensor.ts';

const LEVEL = { x: 3, y: 4, z: 1, roll: 0, pitch: 0, yaw: 0 };

function near(actual: Vector, expected: Vector): void {
  const away = Math.hypot(actual.x - expected.x, actual.y - expected.y, actual.z - expected.z);
  assert.ok(away < 1e-12, `${JSON.stringify(actual)} is not ${JSON.stringify(expected)}`);
}

const up = (height_m: number) => ({ forward_m: 0, left_m: 0, height_m });

test('the sensor stands over the robot, and tips with it', () => {
  const half = Math.sqrt(0.5);
  near(sensorAt(LEVEL, up(0.8)), { x: 3, y: 4, z: 1.8 });
  // Nose up: backwards. Left side up: to the right.
  near(sensorAt({ ...LEVEL, pitch: Math.PI / 4 }, up(1)), { x: 3 - half, y: 4, z: 1 + half });
  near(sensorAt({ ...LEVEL, roll: Math.PI / 4 }, up(1)), { x: 3, y: 4 - half, z: 1 + half });
  near(sensorAt({ ...LEVEL, pitch: Math.PI / 4, yaw: Math.PI / 2 }, up(1)), { x: 3, y: 4 - half, z: 1 + half });
});

test('a sensor ahead and to the left turns with the robot', () => {
  const half = Math.sqrt(0.5);
  const offset = { forward_m: 0.4, left_m: 0.2, height_m: 0 };
  near(sensorAt({ ...LEVEL, yaw: Math.PI / 2 }, offset), { x: 2.8, y: 4.4, z: 1 });
  near(sensorAt({ ...LEVEL, pitch: Math.PI / 4 }, offset), { x: 3 + 0.4 * half, y: 4.2, z: 1 + 0.4 * half });
  near(sensorAt({ ...LEVEL, roll: Math.PI / 4 }, offset), { x: 3.4, y: 4 + 0.2 * half, z: 1 + 0.2 * half });
});

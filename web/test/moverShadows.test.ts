import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Matrix4, Vector3 } from 'three';
import { MoverShadows } from '../src/painter/moverShadows.ts';
import type { Solid } from '../src/protocol/simulationProtocol.ts';

const WALKER: Solid = {
  object: 0,
  shape: 'cylinder',
  centre_m: [10, 20, 1.85],
  size_m: [0.5, 0.5, 1.7],
  sin_cos_yaw: [0, 1],
};

test('who walks has a shadow on the ground, away from the sun in the north-west', () => {
  const shadows = new MoverShadows();
  assert.equal(shadows.mesh.visible, false);
  shadows.show([WALKER], () => 1);
  assert.deepEqual([shadows.mesh.visible, shadows.mesh.count], [true, 1]);
  const placed = new Matrix4();
  shadows.mesh.getMatrixAt(0, placed);
  const [along, across, up] = [new Vector3(), new Vector3(), new Vector3()];
  placed.extractBasis(along, across, up);
  const middle = new Vector3().setFromMatrixPosition(placed);
  assert.ok(middle.x > 10.5 && middle.y < 19.5 && Math.abs(middle.z - 1.03) < 1e-6, JSON.stringify(middle));
  // Its upper side shows: else it would not be drawn.
  assert.ok(up.z > 0.99 && along.x > 0 && along.y < 0);
  assert.ok(along.length() > 2 && Math.abs(across.length() - 0.5) < 1e-6);
  shadows.show([], () => 1);
  assert.equal(shadows.mesh.visible, false);
});

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { PerspectiveCamera, Vector3 } from 'three';
import { FIELD_OF_VIEW_DEG, OVERVIEW_ELEVATION_RAD, overviewDistance_m } from '../src/view/viewpoint.ts';

test('the overview shows every corner of the ground, on a phone too', () => {
  for (const aspect of [0.5, 0.86, 1, 1.5, 2.4]) {
    for (const [width_m, depth_m] of [
      [60, 60],
      [90, 40],
    ] as const) {
      const camera = new PerspectiveCamera(FIELD_OF_VIEW_DEG, aspect, 0.1, 1000);
      const distance_m = overviewDistance_m({ width_m, depth_m }, aspect);
      camera.up.set(0, 0, 1);
      const [back_m, up_m] = [Math.cos(OVERVIEW_ELEVATION_RAD), Math.sin(OVERVIEW_ELEVATION_RAD)];
      camera.position.set(0, -distance_m * back_m, distance_m * up_m);
      camera.lookAt(0, 0, 0);
      camera.updateMatrixWorld();
      for (const x of [-width_m / 2, width_m / 2]) {
        for (const y of [-depth_m / 2, depth_m / 2]) {
          const seen = new Vector3(x, y, 0).project(camera);
          assert.ok(Math.max(Math.abs(seen.x), Math.abs(seen.y)) < 1, `${x}, ${y} at ${aspect}: ${seen.toArray()}`);
        }
      }
    }
  }
});

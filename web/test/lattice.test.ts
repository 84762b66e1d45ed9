import assert from 'node:assert/strict';
import { test } from 'node:test';
import { azimuthOf, columnOf, columnsApart, elevationOf, rowOf, TOP_RAD } from '../src/inspector/lattice.ts';

test('columns and rows lead back to themselves, around the circle and up to the edges', () => {
  for (let column = 0; column < 360; column += 1) {
    assert.equal(columnOf(azimuthOf(column, 360), 360), column);
    assert.equal(columnOf(azimuthOf(column, 360) + 2 * Math.PI, 360), column);
  }
  assert.equal(columnOf(Math.PI - 1e-6, 360), 0);
  assert.equal(columnsApart(358, 1, 360), 3);
  assert.equal(columnsApart(1, 358, 360), 3);
  for (let row = 0; row < 31; row += 1) assert.equal(rowOf(elevationOf(row, 31), 31), row);
  assert.equal(elevationOf(15, 31), 0);
  assert.equal(elevationOf(30, 31), TOP_RAD);
  assert.equal(rowOf(1, 31), 30);
  assert.equal(rowOf(-1, 31), 0);
});

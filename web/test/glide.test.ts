import assert from 'node:assert/strict';
import { test } from 'node:test';
import type { Pose } from '../src/protocol/simulationProtocol.ts';
import { Glide } from '../src/view/glide.ts';

const pose = (x: number, yaw = 0): Pose => ({ x, y: 0, z: 0, roll: 0, pitch: 0, yaw });

test('glides evenly to the newest pose and waits there', () => {
  const glide = new Glide();
  glide.to(pose(0), 0, 100);
  glide.to(pose(1), 1000, 100);
  assert.equal(glide.at(1050)?.x, 0.5);
  assert.equal(glide.at(1400)?.x, 1);
});

test('a pose that comes early is approached from where the robot is drawn', () => {
  const glide = new Glide();
  glide.to(pose(0), 0, 100);
  glide.to(pose(1), 1000, 100);
  glide.to(pose(2), 1050, 100);
  assert.equal(glide.at(1050)?.x, 0.5);
  assert.equal(glide.at(1150)?.x, 2);
});

test('headings turn the short way round, and a new start is there at once', () => {
  const glide = new Glide();
  glide.to(pose(0, 3.1), 0, 100);
  glide.to(pose(0, -3.1), 1000, 100);
  assert.ok(Math.abs((glide.at(1050)?.yaw ?? 0) - Math.PI) < 1e-9);
  glide.to(pose(30), 2000, 100);
  assert.equal(glide.at(2000)?.x, 30);
});

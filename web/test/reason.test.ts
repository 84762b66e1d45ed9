import assert from 'node:assert/strict';
import { test } from 'node:test';
import { reason } from '../src/inspector/reason.ts';
import { standing } from '../src/inspector/status.ts';
import type { Frame, SessionInfo, Subgoal } from '../src/protocol/simulationProtocol.ts';

const info = { limits: { roll_rad: 0.524, pitch_rad: 0.785 } } as SessionInfo;
const candidate = (azimuth_rad: number, chosen: boolean): Subgoal => ({
  azimuth_rad,
  elevation_rad: 0,
  x: 0,
  y: 0,
  z: 0,
  chosen,
  refusal: undefined,
  segment: 0,
  forecast: undefined,
  cost: { direction: 0.1, distance: 0.1, steepness: 0.1, commitment: 0, correction: 0, total: 0.3 },
});
const frame = (part: Partial<Frame>): Frame =>
  ({ tick: 5, outcome: 'running', activity: 'driving', subgoals: [], metrics: {}, ...part }) as Frame;

test('says which way and out of how many', () => {
  const subgoals = [candidate(0.35, true), candidate(-1, false)];
  assert.equal(reason(frame({ subgoals }), info), 'Heads 20° left: the cheapest of 2 candidates.');
  assert.equal(reason(frame({ subgoals: [candidate(0, true)] }), info), 'Straight ahead: the only candidate.');
});

test('names the angle that broke its limit', () => {
  const metrics = { max_abs_roll_rad: 0.53, max_abs_pitch_rad: 0.2 } as Frame['metrics'];
  assert.match(reason(frame({ outcome: 'tilt_limit', metrics }), info), /^Roll came to 30\.4°; the limit is 30\.0°/);
  const steep = { max_abs_roll_rad: 0.1, max_abs_pitch_rad: 0.8 } as Frame['metrics'];
  assert.match(reason(frame({ outcome: 'tilt_limit', metrics: steep }), info), /^Pitch came to 45\.8°/);
});

test('names what the body touched, and where', () => {
  const touched = frame({ outcome: 'collision', stop_reason: 'the body ran into post 1 at (3.00, 4.00) m' });
  assert.equal(reason(touched, info), 'The body ran into post 1 at (3.00, 4.00) m.');
  assert.equal(standing(touched, true), 'Collided');
  assert.equal(standing(frame({ outcome: 'high_centred' }), true), 'High-centred');
  assert.equal(standing(frame({ outcome: 'step' }), true), 'Stopped by a step');
});

test('passes on why the planner stopped', () => {
  const stopped = frame({ outcome: 'no_subgoal', stop_reason: 'no subgoal found after looking around' });
  assert.equal(reason(stopped, info), 'No subgoal found after looking around.');
  assert.equal(standing(stopped, true), 'No safe path found');
  const unseen = frame({ outcome: 'no_subgoal', stop_reason: 'no perception: no inducing inputs' });
  assert.equal(reason(unseen, info), 'The Gaussian process has no solution for this scan: no inducing inputs.');
  assert.equal(standing(unseen, true), 'Perception failed');
});

test('says what it does without a candidate', () => {
  const does = (activity: Frame['activity']) => reason(frame({ activity }), info);
  assert.match(does('backtracking'), /backtracks along its own path/);
  assert.match(does('searching'), /turns on the spot/);
  assert.equal(does('stopped'), 'Stands still.');
});

test('the chip says what the robot does while it runs, and how the trial ended', () => {
  assert.equal(standing(frame({ activity: 'driving' }), true), 'Driving');
  assert.equal(standing(frame({ activity: 'backtracking' }), true), 'Backtracking');
  assert.equal(standing(frame({ activity: 'searching' }), true), 'Searching');
  assert.equal(standing(frame({ activity: 'searching' }), false), 'Paused');
  assert.equal(standing(frame({ outcome: 'stuck', activity: 'stopped' }), true), 'Stuck');
  const nowhere = frame({ outcome: 'no_subgoal', stop_reason: 'no progress: 30 s of driving', activity: 'stopped' });
  assert.equal(standing(nowhere, true), 'Stuck');
});

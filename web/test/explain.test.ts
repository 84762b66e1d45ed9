import assert from 'node:assert/strict';
import { test } from 'node:test';
import { segmentReason, segmentTitle, subgoalReason, subgoalTitle } from '../src/inspector/explain.ts';
import type { Frame, Segment, SessionInfo, Subgoal } from '../src/protocol/simulationProtocol.ts';

const demands = { robot_width_m: 0.685, safety_margin_m: 0.3, max_slope_rad: 0.5, subgoals_on_unknown: true };
const info = { demands, occupancy_radius_m: 7 } as SessionInfo;
const segment: Segment = {
  begin_rad: 0.1,
  end_rad: 0.2,
  elevation_rad: -0.1,
  height_m: 0.1,
  width_m: 0.7,
  verdict: 'too_narrow',
};
const subgoal: Subgoal = {
  azimuth_rad: 0.35,
  elevation_rad: 0,
  x: 0,
  y: 0,
  z: 1.5,
  chosen: false,
  refusal: undefined,
  segment: 0,
  forecast: undefined,
  cost: undefined,
};
const frame = { pose: { z: 1 } } as Frame;

test('a refusal names the number that failed and the one that was asked for', () => {
  assert.equal(
    segmentReason(segment, info),
    '0.70 m wide; the robot needs more than 0.99 m (robot 0.69 m, margin 0.30 m).',
  );
  const steep = segmentReason({ ...segment, width_m: 5, height_m: -4, verdict: 'too_steep' }, info);
  assert.match(steep, /^4\.00 m below the robot’s feet at 7 m; at most 3\.36 m \(29°\)/);
  const unknown: Segment = { ...segment, elevation_rad: undefined, height_m: undefined, verdict: 'unknown' };
  assert.match(segmentReason(unknown, info), /0\.70 m wide; subgoals need more than 0\.99 m/);
  assert.match(segmentReason({ ...unknown, width_m: 4 }, info), /ground that earlier scans saw/);
  const strict = { ...info, demands: { ...demands, subgoals_on_unknown: false } };
  assert.match(segmentReason({ ...unknown, width_m: 4 }, strict), /carries no subgoals/);
  assert.match(segmentReason({ ...unknown, verdict: 'wall' }, info), /Occupied up to the highest beam/);
  assert.match(segmentReason({ ...segment, width_m: 5, verdict: 'valid' }, info), /^5\.0 m wide, 0\.10 m above/);
});

test('a segment is named from its left end to its right end', () => {
  assert.equal(segmentTitle(segment), '11° to 6° left');
  assert.equal(segmentTitle({ ...segment, begin_rad: -0.1 }), '11° left to 6° right');
  assert.equal(segmentTitle({ ...segment, begin_rad: 3, end_rad: 3.4 }), '165° right to 172° left');
  assert.equal(segmentTitle({ ...segment, begin_rad: -3, end_rad: -3 + 2 * Math.PI }), 'All around');
});

test('a subgoal says what its path promises, or how high it lies where only that counts', () => {
  assert.equal(subgoalTitle(subgoal), 'Subgoal 20° left');
  assert.equal(subgoalTitle({ ...subgoal, segment: undefined }), 'The goal itself');
  assert.match(subgoalReason(subgoal, frame), /^0\.50 m higher than the robot/);
  const forecast = {
    reach_m: 4.2,
    path_m: 4.6,
    climb_m: 0.31,
    mean_risk: 0.1,
    max_roll_rad: 0.2,
    max_pitch_rad: 0.1,
    end: 'tilt',
  } as const;
  assert.match(
    subgoalReason({ ...subgoal, forecast }, frame),
    /4\.6 m of path to 4\.2 m away, 0\.31 m up and down, roll up to 11°, pitch up to 6°; then/,
  );
  assert.match(subgoalReason({ ...subgoal, forecast, refusal: 'tilt' }, frame), /^Refused: after 4\.2 m/);
});

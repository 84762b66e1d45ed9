/** Why the robot does not go to a place: what is true of it, and what the planner made of its direction. */

import { degrees, fixed, wrap } from '../base/format.ts';
import type { Place } from '../experiment/place.ts';
import { direction } from '../inspector/decision.ts';
import { segmentReason, VERDICT_WORDS } from '../inspector/explain.ts';
import type { Frame, PlaceReport, SessionInfo, Subgoal } from '../protocol/simulationProtocol.ts';
import { segmentAt } from '../scene/selection.ts';
import { dearerBy } from './dearer.ts';

/** A return this near shows the ground of a place. */
const SEEN_WITHIN_M = 0.5;
/** A subgoal in this direction stands for the place. */
const SAME_DIRECTION_RAD = 0.12;

const WINDS = ['east', 'north-east', 'north', 'north-west', 'west', 'south-west', 'south', 'south-east'] as const;

/** In sentences, the nearest obstacle to going there first. */
export function whyThere(place: Place, report: PlaceReport, frame: Frame, info: SessionInfo): string {
  const { pose } = frame;
  const azimuth_rad = wrap(Math.atan2(place.y - pose.y, place.x - pose.x) - pose.yaw);
  const distance_m = Math.hypot(place.x - pose.x, place.y - pose.y);
  const parts = [
    `${fixed(distance_m, 1)} m away, ${direction(azimuth_rad)}.`,
    ofGround(report),
    seen(report, distance_m, info),
    ofDirection(azimuth_rad, frame, info),
  ];
  return parts.filter(Boolean).join(' ');
}

function ofGround({ headings }: PlaceReport): string {
  if (headings.length === 0) return 'A wheel would be off the terrain.';
  const touching = headings.filter(({ touches }) => touches);
  const steep = headings.filter(({ is_too_steep }) => is_too_steep);
  const sentences: string[] = [];
  if (steep.length > 0) {
    const worst = steep.reduce((a, b) => (tilt(b) > tilt(a) ? b : a));
    const how = Math.abs(worst.pitch_rad) > Math.abs(worst.roll_rad) ? 'pitch' : 'roll';
    sentences.push(
      `In truth too steep ${ofHeadings(
        steep.map(({ heading_rad }) => heading_rad),
        headings.length,
      )}: up to ${degrees(tilt(worst))} of ${how}.`,
    );
  } else sentences.push('In truth level enough at any heading.');
  if (touching.length > 0)
    sentences.push(
      `The body would ${touching[0]?.touches} ${ofHeadings(
        touching.map(({ heading_rad }) => heading_rad),
        headings.length,
      )}.`,
    );
  return sentences.join(' ');
}

function tilt({ roll_rad, pitch_rad }: PlaceReport['headings'][number]): number {
  return Math.max(Math.abs(roll_rad), Math.abs(pitch_rad));
}

function ofHeadings(headings_rad: readonly number[], all: number): string {
  if (headings_rad.length === all) return 'at every heading';
  const winds = new Set(
    headings_rad.map((heading_rad) => WINDS[Math.round((4 * heading_rad) / Math.PI) % WINDS.length]),
  );
  const facing = winds.size > 3 ? `${headings_rad.length} of ${all} headings` : `facing ${[...winds].join(', ')}`;
  return winds.size > 3 ? `at ${facing}` : facing;
}

function seen({ nearest_return_m }: PlaceReport, distance_m: number, { occupancy_radius_m }: SessionInfo): string {
  if (nearest_return_m === undefined || nearest_return_m > SEEN_WITHIN_M) return 'This scan did not see it.';
  return distance_m > occupancy_radius_m
    ? `It is seen, but the skyline is taken at ${fixed(occupancy_radius_m, 0)} m.`
    : '';
}

/** What the planner decided of the direction. */
function ofDirection(azimuth_rad: number, frame: Frame, info: SessionInfo): string {
  const off = (one: Subgoal) => Math.abs(wrap(one.azimuth_rad - azimuth_rad));
  const chosen = frame.subgoals.find((one) => one.chosen);
  const near = frame.subgoals.filter((one) => off(one) < SAME_DIRECTION_RAD).sort((a, b) => off(a) - off(b));
  if (near.some((one) => one.chosen)) return 'The robot heads in this direction.';
  const one = near[0];
  const segment = frame.segments[segmentAt(frame, azimuth_rad) ?? -1];
  if (!one) {
    return segment
      ? `No subgoal stands in this direction; its segment is ${VERDICT_WORDS[segment.verdict]}: ${segmentReason(segment, info)}`
      : 'No subgoal stands in this direction.';
  }
  if (one.refusal === 'tilt') return 'The path to the subgoal there would tilt the robot too far.';
  if (one.refusal === 'unseen') return 'No scan has seen the ground on the way to the subgoal there.';
  if (!one.cost || !chosen?.cost) return 'The goal itself was nearer than the ground in sight.';
  return `The subgoal there is dearer than the chosen one by ${dearerBy(one.cost, chosen.cost)}.`;
}

/** The paper, step by step, on the live scene. */

import { degrees, fixed, grouped } from '../base/format.ts';
import type { Frame, SessionInfo } from '../protocol/simulationProtocol.ts';
import type { Layers } from '../scene/layers.ts';
import { type Finder, subgoalTarget } from '../scene/selection.ts';
import type { CameraMode } from '../view/viewpoint.ts';

export interface Step {
  readonly title: string;
  readonly text: (frame: Frame, info: SessionInfo) => string;
  readonly camera: CameraMode;
  /** What differs from the bare scene. */
  readonly layers: Partial<Layers>;
  /** Whether the variance image is large. */
  readonly image?: true;
  /** Whether the Gaussian process is open to be changed by hand. */
  readonly byHand?: true;
  /** Whether the robot drives meanwhile. */
  readonly drives?: true;
  readonly marks?: Finder;
}

/** The scene that every step starts from. */
export const BARE: Layers = {
  points: 'none',
  observed: false,
  occupancy: false,
  variance: false,
  segments: false,
  subgoals: false,
  path: false,
};

export const STEPS: readonly Step[] = [
  {
    title: 'A goal, and no global map',
    text: (_, { limits, period_s }) =>
      `The robot knows its own pose and where the flag is, but nothing of the ground between. It must never roll beyond ${degrees(limits.roll_rad)} or pitch beyond ${degrees(limits.pitch_rad)}. So every ${fixed(period_s, 2)} s it takes a scan and decides anew where to go. It keeps only the ground that it has seen nearby.`,
    camera: 'free',
    layers: {},
  },
  {
    title: 'It scans the ground',
    text: ({ returns }, { occupancy_radius_m, image }) =>
      `A LiDAR on its mast sends out ${image.rings} rings of beams; each ring has its own colour here. ${grouped(returns)} beams of this scan came back. The method uses those from within ${metres(occupancy_radius_m)}, inside the dashed circle.`,
    camera: 'chase',
    layers: { points: 'ring' },
  },
  {
    title: 'The occupancy surface',
    text: (_, { occupancy_radius_m }) =>
      `Every return is projected along its beam onto a surface around the sensor, with the occupancy ${metres(occupancy_radius_m)} minus its range: violet for near ground, yellow for ground almost out of reach. It is drawn innermost; the next pages put other surfaces around it.`,
    camera: 'chase',
    layers: { points: 'use', observed: true },
  },
  {
    title: 'A Gaussian process fills the gaps',
    text: () =>
      'A sparse Gaussian process learns the occupancy over azimuth and elevation from these returns, and predicts it in every direction between them: the outer of the two surfaces.',
    camera: 'chase',
    layers: { observed: true, occupancy: true },
  },
  {
    title: 'Where it is unsure, space is free',
    text: () =>
      'The process also says how sure it is. Before any scan its variance is the same everywhere. Each return lowers it around itself, as far as the kernel reaches: dark. Where no beam came back nothing has lowered it: light, and taken for free space. This outer surface, and not the predicted occupancy, is what the method reads the terrain from.',
    camera: 'chase',
    layers: { observed: true, variance: true },
  },
  {
    title: 'Unrolled, it shows the skyline',
    text: ({ threshold }, { preset }) =>
      `Below the view, the same variance is unrolled, with what lies ahead in the middle. Where it passes the threshold V_th, ${fixed(threshold, 2)} ${preset === 'paper' ? 'as in the paper' : 'here and 0.70 in the paper'}, the ground ends and free space begins. This line is the terrain’s elevation profile.`,
    camera: 'chase',
    layers: { variance: true },
    image: true,
  },
  {
    title: 'One azimuth, cut open',
    text: ({ threshold }) =>
      `Beside the image, one azimuth is unrolled: point at another in the image. Dots are its returns; line and band are the mean and its deviation σ; ticks are the inducing inputs, the directions through which the process sees all returns. On the right is the variance: low among the returns, rising above the last. Where it crosses V_th, ${fixed(threshold, 2)}, the skyline lies. Drag V_th: a higher one takes more for ground and lifts the skyline. The dotted one is the true one.`,
    camera: 'chase',
    layers: {},
    image: true,
    byHand: true,
  },
  {
    title: 'Why it is not left to learn',
    text: (_, { learning, preset }) =>
      `The paper learns kernel and noise on every scan, by climbing a bound on the likelihood. Press “Learned…” and drag the steps: the bound rises, the kernel widens, and the skyline leaves the ground, because the process assumes a mean of zero and a scan lies metres above it. “Drive with these” shows what that does to a drive. ${learning === 'fixed' ? `So ${preset === 'paper' ? 'also the literal planner here' : 'this planner'} learns only if told to under Learning, and within bounds.` : 'Learning is on now, and holds the values within bounds.'} “Default” takes it back.`,
    camera: 'chase',
    layers: {},
    image: true,
    byHand: true,
  },
  {
    title: 'Level segments',
    text: (_, { demands, occupancy_radius_m }) =>
      `The profile is cut into segments of one level each. One is good for subgoals when it is wider than the robot and a margin, ${fixed(demands.robot_width_m + demands.safety_margin_m, 2)} m together, and at most ${fixed(occupancy_radius_m * Math.sin(demands.max_slope_rad), 1)} m above or below the robot. Point at any to read why it was taken or refused.`,
    camera: 'chase',
    layers: { variance: true, segments: true },
    image: true,
    marks: ({ segments }) => {
      const refused = segments.findIndex(({ verdict }) => verdict !== 'valid');
      return { subgoal: undefined, segment: Math.max(refused, 0) };
    },
  },
  {
    title: 'The cheapest subgoal wins',
    text: (_, { preset }) =>
      `Subgoals stand on the segments. Each has a cost: for turning towards it, for the distance that then remains to the goal, and for steepness.${preset === 'paper' ? '' : ' The best planner here also plans a path to each, refuses paths that would tilt the robot too far, and adds costs for giving up the target it had and for detours found on the way.'} Yellow costs least; the ringed one is chosen.`,
    camera: 'top',
    layers: { subgoals: true, path: true },
    marks: (frame) =>
      subgoalTarget(
        frame,
        frame.subgoals.findIndex(({ chosen }) => chosen),
      ),
  },
  {
    title: 'Drive, and scan again',
    text: (_, { preset }) =>
      `${preset === 'paper' ? 'A PID controller turns the robot towards the subgoal and drives.' : 'The robot drives the best trajectory of the next two seconds along its path; the paper has a PID controller there.'} Then comes the next scan, and all of this happens again. Now it is yours: press Done, then raise a hill in its path, or give it another goal.`,
    camera: 'chase',
    layers: { points: 'use', subgoals: true },
    drives: true,
  },
];

function metres(length_m: number): string {
  return `${fixed(length_m, Number.isInteger(length_m) ? 0 : 1)} m`;
}

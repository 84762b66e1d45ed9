export interface FrameBuffers {
    /**
     * LiDAR returns in the world frame: x, y, z of `Frame.returns` points.
     */
    points: Float32Array<ArrayBuffer>;
    /**
     * What the planner took each of them for: 0 surface, 1 invalid, 2 far, 3 the robot itself, 4 stray,
     * 5 overhead.
     */
    return_kinds: Uint8Array<ArrayBuffer>;
    /**
     * Observed occupancy in metres, azimuth-major from straight behind over the right, lowest ring first;
     * NaN without a return.
     */
    observed: Float32Array<ArrayBuffer>;
    /**
     * Predicted occupancy in metres, azimuth-major likewise, the lowest row first.
     */
    occupancy: Float32Array<ArrayBuffer>;
    /**
     * Predictive variance as a share of the prior's, on the same lattice.
     */
    variance: Float32Array<ArrayBuffer>;
    /**
     * Elevation of the skyline in each column; NaN where there is none.
     */
    profile: Float32Array<ArrayBuffer>;
    /**
     * The skyline before somebody made the planner think again, likewise; NaN throughout where nobody did.
     */
    former: Float32Array<ArrayBuffer>;
    /**
     * The true skyline where it was asked for, NaN elsewhere: what endlessly many beams would show of
     * the bare ground.
     */
    truth: Float32Array<ArrayBuffer>;
    /**
     * What each column shows: 0 ground, 1 unknown, 2 wall.
     */
    kinds: Uint8Array<ArrayBuffer>;
}

export interface Segment {
    /**
     * Azimuth in the sensor frame, in [-π, π).
     */
    begin_rad: number;
    /**
     * At least `begin_rad`; beyond π where the segment crosses the azimuth behind the robot.
     */
    end_rad: number;
    /**
     * Nothing where the ground is unknown, and so is the height.
     */
    elevation_rad: number | undefined;
    /**
     * Height over the ground under the robot.
     */
    height_m: number | undefined;
    width_m: number;
    verdict: Verdict;
}

export interface Subgoal {
    /**
     * Direction in the sensor frame.
     */
    azimuth_rad: number;
    elevation_rad: number;
    /**
     * Position in the world.
     */
    x: number;
    y: number;
    z: number;
    chosen: boolean;
    /**
     * Why it is no candidate, where it is none.
     */
    refusal: Refusal | undefined;
    /**
     * Index of its segment; nothing for a place that is not on the skyline.
     */
    segment: number | undefined;
    /**
     * Nothing where the cost judges steepness by the paper's height alone.
     */
    forecast: Forecast | undefined;
    /**
     * Nothing for the refused and for the goal itself.
     */
    cost: Cost | undefined;
}

export interface PathPoint {
    x: number;
    y: number;
    /**
     * Whether the robot gets there in reverse.
     */
    reverse: boolean;
}

export interface SetAside {
    /**
     * Rain, dust, insects, multipath.
     */
    stray: number;
    /**
     * The robot itself.
     */
    body: number;
    /**
     * What the robot can pass below.
     */
    overhead: number;
}

export interface SensorPose {
    position: Point;
    x_axis: Point;
    y_axis: Point;
    z_axis: Point;
}

export interface Point {
    x: number;
    y: number;
    z: number;
}

export interface Pose {
    x: number;
    y: number;
    /**
     * Height of the ground contact under the body's centre.
     */
    z: number;
    roll: number;
    pitch: number;
    yaw: number;
}

export interface Velocity {
    v_m_s: number;
    omega_rad_s: number;
}

export interface TiltLimits {
    roll_rad: number;
    pitch_rad: number;
}

export interface Mount {
    /**
     * Ahead of the point on the ground between the wheels.
     */
    forward_m: number;
    left_m: number;
    /**
     * Above the ground contact, along the body's z axis.
     */
    height_m: number;
    /**
     * Left side up; π upside down. The mount is turned by yaw, pitch, roll.
     */
    roll_rad: number;
    /**
     * Nose-up.
     */
    pitch_rad: number;
    yaw_rad: number;
}

export interface ImageSize {
    columns: number;
    rows: number;
    rings: number;
}

export interface SegmentDemands {
    /**
     * Wider than the robot's width and the margin on it together.
     */
    robot_width_m: number;
    safety_margin_m: number;
    /**
     * The skyline no higher and no lower than this, seen from the sensor's foot.
     */
    max_slope_rad: number;
    /**
     * Whether columns without a return may carry subgoals, on ground that earlier scans saw.
     */
    subgoals_on_unknown: boolean;
}

export interface Cost {
    direction: number;
    distance: number;
    steepness: number;
    commitment: number;
    /**
     * What was learned about the way on from there.
     */
    correction: number;
    /**
     * Their sum.
     */
    total: number;
}

export interface Forecast {
    /**
     * Straight distance from the robot to where the path ends.
     */
    reach_m: number;
    /**
     * Length of the path.
     */
    path_m: number;
    /**
     * What the path goes up and down, together.
     */
    climb_m: number;
    /**
     * Mean of (slope / slope at the limit)² over the path.
     */
    mean_risk: number;
    max_roll_rad: number;
    max_pitch_rad: number;
    end: ReachEnd;
}

export type Activity = "driving" | "arrived" | "searching" | "stopped" | "backtracking";
export type Verdict = "valid" | "too_narrow" | "too_steep" | "unknown" | "wall";
export type Refusal = "tilt" | "unseen";
export type ReachEnd = "whole" | "tilt" | "unseen";
export interface RecordingFile { readonly name: string; readonly size: number; read(at: number, bytes: number): Uint8Array; }
export interface Change { at_s: number; text: string; }
export type ChangeList = Change[];
export interface Surroundings { columns: number; rows: number; cell_m: number; origin: [number, number]; heights_m: Float32Array<ArrayBuffer>; }
export interface RecordedGoal { x: number; y: number; heading_rad: number | undefined; }
export interface RecordedScene { has_decisions: boolean; is_paper: boolean; limits: TiltLimits; occupancy_radius_m: number; mount: Mount; image: ImageSize; demands: SegmentDemands; }
export interface Decided { until_s: number; end_s: number; has_ended: boolean; fault: string | undefined; is_cut: boolean; answers: number; different_answers: number; different_ticks: number; lost: number; goals: number; complaints: readonly (readonly [string, number, string])[]; }
export interface RecordedFrame { time_s: number; pose: Pose | undefined; state: string; reason: string | undefined; cause: string | undefined; command: Velocity; activity: Activity | undefined; stop_reason: string | undefined; goal: RecordedGoal | undefined; scan_age_s: number | undefined; returns: number; set_aside: SetAside; sensor: SensorPose; threshold: number; segments: Segment[]; subgoals: Subgoal[]; path: PathPoint[]; surfaces: boolean; surroundings: Surroundings; differences: string[]; }
export class Recording { constructor(file: RecordingFile); changes(known: number): ChangeList; decide_on(entries: number): Decided; differences_s(known: number): Float64Array; scans_s(known: number): Float64Array; scene(): RecordedScene; show(at_s: number, since_s: number, buffers: FrameBuffers, surfaces: boolean): RecordedFrame; trail_m(known: number): Float32Array; trail_s(known: number): Float64Array; }
export default function init(): Promise<unknown>;

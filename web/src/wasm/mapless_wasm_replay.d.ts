/* tslint:disable */
/* eslint-disable */

/** A file of which any part can be read at once. */
export interface RecordingFile {
    readonly name: string;
    /** In bytes. */
    readonly size: number;
    /** So many bytes from there on, or fewer at the end. */
    read(at: number, bytes: number): Uint8Array;
}


/**
 * A change of the supervisor's state, or of the goal.
 */
export interface Change {
    at_s: number;
    text: string;
}

/**
 * A place on the path to the chosen subgoal.
 */
export interface PathPoint {
    x: number;
    y: number;
    /**
     * Whether the robot gets there in reverse.
     */
    reverse: boolean;
}

/**
 * A place where the robot could go next: on the skyline, where it already heads, at the frontier of what was
 * seen, or the goal itself once it is in sight.
 */
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

/**
 * A point or a direction in the world: x east, y north, z up.
 */
export interface Point {
    x: number;
    y: number;
    z: number;
}

/**
 * A role that several topics of a recording may have.
 */
export interface TopicChoice {
    /**
     * `scan`, `odometry`, `imu`, `emergency_stop`, `reset`, `goal_pose` or `clock`.
     */
    role: string;
    /**
     * The type of their messages.
     */
    schema: string;
    /**
     * Those with the most messages first.
     */
    candidates: TopicCandidate[];
}

/**
 * A run of neighbouring columns at one level of the skyline.
 */
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

/**
 * A square of heights around the robot: row by row, each from west to east, the southern row first.
 */
export interface Surroundings {
    columns: number;
    rows: number;
    cell_m: number;
    /**
     * The south-western corner.
     */
    origin: [number, number];
    heights_m: Float32Array<ArrayBuffer>;
}

/**
 * A topic that a role may have.
 */
export interface TopicCandidate {
    topic: string;
    /**
     * How many messages it has, if the file tells.
     */
    messages: number | undefined;
}

/**
 * Changes, in their order.
 */
export type ChangeList = Change[];

/**
 * Choices, in the order of their roles.
 */
export type TopicChoices = TopicChoice[];

/**
 * Every transition from one state to another, in the order of the states.
 */
export type SupervisorTransitions = SupervisorTransition[];

/**
 * Everything that a moment saw, decided and did.
 */
export interface RecordedFrame {
    time_s: number;
    /**
     * Nothing until odometry and IMU came.
     */
    pose: Pose | undefined;
    /**
     * The supervisor's state: `Standby`, `Driving`, `Paused`, `Aborted` or `Latched`.
     */
    state: string;
    /**
     * Why the robot was stopped, if it was.
     */
    reason: string | undefined;
    /**
     * What is wrong now, if anything is.
     */
    cause: string | undefined;
    /**
     * What the robot was told to do.
     */
    command: Velocity;
    /**
     * What the planner does; nothing while it has no goal.
     */
    activity: Activity | undefined;
    /**
     * Why the planner stopped, if it did.
     */
    stop_reason: string | undefined;
    goal: RecordedGoal | undefined;
    /**
     * How old the scan in view is; nothing before the first.
     */
    scan_age_s: number | undefined;
    returns: number;
    set_aside: SetAside;
    sensor: SensorPose;
    threshold: number;
    segments: Segment[];
    subgoals: Subgoal[];
    path: PathPoint[];
    /**
     * Whether the surfaces in the buffers are predicted ones.
     */
    surfaces: boolean;
    surroundings: Surroundings;
    /**
     * What was decided otherwise than recorded since the frame before: name, recorded value, value now.
     */
    differences: string[];
}

/**
 * Forward speed and counter-clockwise turn rate.
 */
export interface Velocity {
    v_m_s: number;
    omega_rad_s: number;
}

/**
 * From one state to another.
 */
export interface SupervisorTransition {
    from: string;
    to: string;
    /**
     * What leads there: `Goal`, `NoGoal`, `Pause`, `Abort`, `Latch`, `Clear` or `Reset`.
     */
    events: string[];
}

/**
 * How far the recording was decided again.
 */
export interface Decided {
    /**
     * Until when.
     */
    until_s: number;
    /**
     * When the recording ends, as far as that is known.
     */
    end_s: number;
    /**
     * Whether everything was decided.
     */
    has_ended: boolean;
    /**
     * Why the file cannot be read to its end, if so.
     */
    fault: string | undefined;
    /**
     * Whether the file ends before its end was marked.
     */
    is_cut: boolean;
    answers: number;
    different_answers: number;
    different_ticks: number;
    /**
     * Entries that could not be recorded.
     */
    lost: number;
    /**
     * Goals in it.
     */
    goals: number;
    /**
     * What was wrong with messages: about what, how often, and the last word on it.
     */
    complaints: readonly (readonly [string, number, string])[];
}

/**
 * How far the robot may tilt.
 */
export interface TiltLimits {
    roll_rad: number;
    pitch_rad: number;
}

/**
 * How many returns of the last scan the planner set aside, by kind.
 */
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

/**
 * Lattice of the predicted surfaces; the observed one has a row for each ring of the sensor.
 */
export interface ImageSize {
    columns: number;
    rows: number;
    rings: number;
}

/**
 * Names of topics by their roles.
 */
export type NamedTopics = Readonly<Record<string, string>>;

/**
 * The weighted terms of a subgoal's cost. The paper has the first three.
 */
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

/**
 * Typed arrays that a frame fills, each as far as it goes.
 */
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

/**
 * What a recording was made with, as far as the page shows it.
 */
export interface RecordedScene {
    /**
     * Whether the robot's own decisions are in it; those of other files are made anew.
     */
    has_decisions: boolean;
    /**
     * Whether the subgoals' cost is the paper's.
     */
    is_paper: boolean;
    limits: TiltLimits;
    occupancy_radius_m: number;
    mount: Mount;
    image: ImageSize;
    demands: SegmentDemands;
}

/**
 * What a segment must be to carry subgoals.
 */
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

/**
 * What the path to a subgoal promises, from the ground that the last scans saw.
 */
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

/**
 * What the planner does at present.
 */
export type Activity = "driving" | "arrived" | "searching" | "stopped" | "backtracking";

/**
 * Where the robot is: x east, y north, z up; pitch positive nose-up, roll positive with the left side up.
 */
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

/**
 * Where the robot was to go.
 */
export interface RecordedGoal {
    x: number;
    y: number;
    /**
     * Any heading without it.
     */
    heading_rad: number | undefined;
}

/**
 * Where the sensor is, and the directions of its axes: x forward, y to the left, z up.
 */
export interface SensorPose {
    position: Point;
    x_axis: Point;
    y_axis: Point;
    z_axis: Point;
}

/**
 * Where the sensor sits on the robot and how it is turned there, as the planner is told.
 */
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

/**
 * Whether subgoals may stand on a segment, and if not, why.
 */
export type Verdict = "valid" | "too_narrow" | "too_steep" | "unknown" | "wall";

/**
 * Why a forecast ends where it does.
 */
export type ReachEnd = "whole" | "tilt" | "unseen";

/**
 * Why a subgoal is no candidate.
 */
export type Refusal = "tilt" | "unseen";


/**
 * A recording, and where in it somebody looks.
 */
export class Recording {
    free(): void;
    [Symbol.dispose](): void;
    /**
     * Changes of the supervisor's state and of the goal, after the first `known`.
     *
     * # Errors
     * None that is known.
     */
    changes(known: number): ChangeList;
    /**
     * Decides so many more entries again; how far that is.
     *
     * # Errors
     * None that is known.
     */
    decide_on(entries: number): Decided;
    /**
     * Times of decisions that differ from the recorded ones, seconds, after the first `known`.
     */
    differences_s(known: number): Float64Array;
    /**
     * Opens a recording of the node, or a robot's own with the topics that must be named. `faults` go wrong
     * beyond what went wrong on the robot, as `no_scan@1.5+0.4`: kind, begin and length in seconds.
     *
     * # Errors
     * A file that is neither, with its name and what was expected; a fault that is none.
     */
    constructor(file: RecordingFile, topics: NamedTopics, faults: string[]);
    /**
     * Times of the planner's answers and, while it had no goal, of scans, seconds, after the first `known`.
     */
    scans_s(known: number): Float64Array;
    /**
     * What it was made with, where somebody looks.
     *
     * # Errors
     * A recording without a single entry.
     */
    scene(): RecordedScene;
    /**
     * Goes to a moment, or to where everything was decided again if that is earlier, and shows it. Decisions
     * that differ are told of the time from `since_s` to there.
     *
     * # Errors
     * A file that cannot be read any more, or without a single entry.
     */
    show(at_s: number, since_s: number, buffers: FrameBuffers, surfaces: boolean): RecordedFrame;
    /**
     * The places that belong to those times: x, y, z, metres.
     */
    trail_m(known: number): Float32Array;
    /**
     * The trajectory as far as it was decided, after its first `known` places: the time of each, seconds.
     */
    trail_s(known: number): Float64Array;
}

/**
 * What a replay found.
 */
export class Replayed {
    private constructor();
    free(): void;
    [Symbol.dispose](): void;
    /**
     * Answers of the planner.
     */
    readonly answers: number;
    /**
     * Decisions that differ from the recorded ones.
     */
    readonly differences: number;
    /**
     * The digest of all decisions.
     */
    readonly digest: string;
    /**
     * The time of the last entry, seconds.
     */
    readonly until_s: number;
}

/**
 * The kinds of faults that a recording can be opened with.
 */
export function fault_kinds(): string[];

/**
 * Replays a recording of the node.
 *
 * # Errors
 * A fault of the file, with its name and place and what was expected there.
 */
export function replay_recording(file: string, bytes: Uint8Array | number[]): Replayed;

/**
 * Runs once when the page loads the module.
 */
export function start(): void;

/**
 * The supervisor's states and what leads from one to another.
 *
 * # Errors
 * None that is known.
 */
export function supervisor_transitions(): SupervisorTransitions;

/**
 * The roles for which a topic must be named before the recording can be opened; mostly none.
 *
 * # Errors
 * A file that is no recording, with its name and what was expected.
 */
export function topic_choices(file: RecordingFile): TopicChoices;

export type InitInput = RequestInfo | URL | Response | BufferSource | WebAssembly.Module;

export interface InitOutput {
    readonly memory: WebAssembly.Memory;
    readonly __wbg_recording_free: (a: number, b: number) => void;
    readonly __wbg_replayed_free: (a: number, b: number) => void;
    readonly fault_kinds: () => [number, number];
    readonly recording_changes: (a: number, b: number) => [number, number, number];
    readonly recording_decide_on: (a: number, b: number) => [number, number, number];
    readonly recording_differences_s: (a: number, b: number) => any;
    readonly recording_new: (a: any, b: any, c: number, d: number) => [number, number, number];
    readonly recording_scans_s: (a: number, b: number) => any;
    readonly recording_scene: (a: number) => [number, number, number];
    readonly recording_show: (a: number, b: number, c: number, d: any, e: number) => [number, number, number];
    readonly recording_trail_m: (a: number, b: number) => any;
    readonly recording_trail_s: (a: number, b: number) => any;
    readonly replay_recording: (a: number, b: number, c: number, d: number) => [number, number, number];
    readonly replayed_answers: (a: number) => number;
    readonly replayed_differences: (a: number) => number;
    readonly replayed_digest: (a: number) => [number, number];
    readonly replayed_until_s: (a: number) => number;
    readonly start: () => void;
    readonly supervisor_transitions: () => [number, number, number];
    readonly topic_choices: (a: any) => [number, number, number];
    readonly __wbindgen_malloc: (a: number, b: number) => number;
    readonly __wbindgen_realloc: (a: number, b: number, c: number, d: number) => number;
    readonly __wbindgen_free: (a: number, b: number, c: number) => void;
    readonly __wbindgen_exn_store: (a: number) => void;
    readonly __externref_table_alloc: () => number;
    readonly __wbindgen_externrefs: WebAssembly.Table;
    readonly __externref_drop_slice: (a: number, b: number) => void;
    readonly __externref_table_dealloc: (a: number) => void;
    readonly __wbindgen_start: () => void;
}

export type SyncInitInput = BufferSource | WebAssembly.Module;

/**
 * Instantiates the given `module`, which can either be bytes or
 * a precompiled `WebAssembly.Module`.
 *
 * @param {{ module: SyncInitInput }} module - Passing `SyncInitInput` directly is deprecated.
 *
 * @returns {InitOutput}
 */
export function initSync(module: { module: SyncInitInput } | SyncInitInput): InitOutput;

/**
 * If `module_or_path` is {RequestInfo} or {URL}, makes a request and
 * for everything else, calls `WebAssembly.instantiate` directly.
 *
 * @param {{ module_or_path: InitInput | Promise<InitInput> }} module_or_path - Passing `InitInput` directly is deprecated.
 *
 * @returns {Promise<InitOutput>}
 */
export default function __wbg_init (module_or_path?: { module_or_path: InitInput | Promise<InitInput> } | InitInput | Promise<InitInput>): Promise<InitOutput>;

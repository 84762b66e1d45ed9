/* tslint:disable */
/* eslint-disable */

/** A walk from the object's place along points and back again, over and over. */
export interface Walk {
    path: [number, number][];
    speed_m_s: number;
    /** It stands until the robot is this near. */
    starts_within_m?: number;
}

/** Something that stands on the ground and is not ground, as in scenario files. */
export type WorldObject =
| { kind: 'post'; at: [number, number]; radius_m: number; height_m: number; walk?: Walk }
| { kind: 'box'; at: [number, number]; size_m: [number, number, number]; yaw_rad?: number; raised_m?: number; walk?: Walk }
| { kind: 'rock'; at: [number, number]; radius_m: number; sunk_m?: number }
| { kind: 'wall'; from: [number, number]; to: [number, number]; height_m: number; thickness_m?: number }
| { kind: 'gate'; at: [number, number]; yaw_rad: number; width_m: number; height_m: number }
| { kind: 'roof'; at: [number, number]; size_m: [number, number, number]; yaw_rad?: number; height_m: number };


/**
 * A file by its name, which messages about it begin with.
 */
export interface TextFile {
    name: string;
    text: string;
}

/**
 * A place and which way the robot faces there.
 */
export interface Heading {
    x: number;
    y: number;
    /**
     * Counter-clockwise from east.
     */
    heading_rad: number;
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
 * A place seen from above.
 */
export interface Place {
    x: number;
    y: number;
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
 * A regular grid of heights: row by row, each from west to east, the southern row first.
 */
export interface Ground {
    columns: number;
    rows: number;
    cell_m: number;
    heights_m: Float32Array<ArrayBuffer>;
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
 * A shape that an object is made of.
 */
export interface Solid {
    /**
     * Index of the object.
     */
    object: number;
    /**
     * `box`, `cylinder` or `ball`.
     */
    shape: 'box' | 'cylinder' | 'ball';
    /**
     * Centre in the world.
     */
    centre_m: [number, number, number];
    /**
     * Length, width and height; of a cylinder and of a ball, the diameter stands for the first two.
     */
    size_m: [number, number, number];
    /**
     * Sine and cosine of the direction of its length, counter-clockwise from east.
     */
    sin_cos_yaw: [number, number];
}

/**
 * A terrain by the file that describes it.
 */
export interface TerrainFiles {
    name: string;
    bytes: Uint8Array;
    /**
     * The heights of the file that the recipe imports, where it imports one: read as `import_of` says.
     */
    imported?: Ground;
}

/**
 * A terrain for a picture.
 */
export interface TerrainPreview {
    /**
     * Coarsely.
     */
    ground: Ground;
    /**
     * The shapes of what stands and walks on it.
     */
    solids: SolidList;
}

/**
 * All that a session is opened with.
 */
export interface SessionOptions {
    scenario: TextFile;
    terrain: TerrainFiles;
    preset: Preset;
    /**
     * The scenario's own without it.
     */
    learning?: Learning;
    /**
     * The scenario's own without it.
     */
    seed?: number;
    /**
     * Set from the beginning: see `Session.set_parameters`.
     */
    overrides?: Overrides;
}

/**
 * Everything that one tick saw, decided and did. At tick 0 there is a scan but no decision yet.
 */
export interface Frame {
    tick: number;
    time_s: number;
    /**
     * Whether what is sensed and decided here is the run's.
     */
    thought: Thought;
    outcome: Outcome;
    activity: Activity;
    /**
     * Why the planner stopped, or what the body touched, where the trial ended so.
     */
    stop_reason: string | undefined;
    pose: Pose;
    /**
     * Where the robot believes to be; absent where nothing is wrong with that.
     */
    believed: Pose | undefined;
    v_m_s: number;
    omega_rad_s: number;
    command: Velocity;
    /**
     * Points in `FrameBuffers.points`.
     */
    returns: number;
    set_aside: SetAside;
    /**
     * Where the ground in the first scan does not fit the mount of the sensor: what to do about it.
     */
    mount_misfit: string | undefined;
    /**
     * Where the scan was taken.
     */
    sensor: SensorPose;
    /**
     * Share of the prior variance above which space counts as free.
     */
    threshold: number;
    segments: Segment[];
    subgoals: Subgoal[];
    /**
     * The path to the chosen subgoal, from where the robot stands; empty without one, and where subgoals are
     * judged by the paper's height alone.
     */
    path: PathPoint[];
    metrics: Metrics;
    /**
     * From where the robot truly is, seen from above.
     */
    distance_to_goal_m: number;
    /**
     * Digest of the whole trajectory so far; the command line prints the same one.
     */
    digest: string;
    timeline: Timeline;
    waypoints_passed: number;
    /**
     * The shapes that walk, where they are now.
     */
    movers: Solid[];
}

/**
 * Forward speed and counter-clockwise turn rate.
 */
export interface Velocity {
    v_m_s: number;
    omega_rad_s: number;
}

/**
 * How a trial stands: `running`, or how it ended.
 */
export type Outcome = "running" | "reached" | "tilt_limit" | "collision" | "high_centred" | "step" | "stuck" | "no_subgoal" | "left_terrain" | "timeout";

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
 * How the robot would stand with one heading, by the true ground.
 */
export interface HeadingThere {
    heading_rad: number;
    roll_rad: number;
    pitch_rad: number;
    is_too_steep: boolean;
    /**
     * What the body would do there, as `run into an object`, if anything.
     */
    touches: string | undefined;
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
 * Objects, as in scenario files.
 */
export type ObjectList = WorldObject[];

/**
 * One step of learning.
 */
export interface ClimbStep {
    /**
     * Nats.
     */
    bound: number;
    variance_m2: number;
    /**
     * Over azimuth and elevation.
     */
    length_scales_rad: [number, number];
    alpha: number;
    noise_variance_m2: number;
}

/**
 * One tick: where the robot was when the scan was taken, what the planner decided on it, and what came of
 * it.
 */
export interface Tick {
    tick: number;
    time_s: number;
    pose: Pose;
    v_m_s: number;
    omega_rad_s: number;
    command: Velocity;
    /**
     * Where the planner heads, if it does.
     */
    subgoal: Place | undefined;
    activity: Activity;
    /**
     * From the start to this tick.
     */
    metrics: Metrics;
    /**
     * How long scanning, planning and moving took; NaN outside a worker.
     */
    scan_ms: number;
    planner_ms: number;
    motion_ms: number;
    after: Standing;
    /**
     * Whether the route is another one now: what was changed at this tick before is changed again as it is
     * repeated.
     */
    rerouted: boolean;
}

/**
 * One tool in one go. The names are those of a recipe's `[[stroke]]`.
 */
export interface Stroke {
    kind: StrokeKind;
    radius_m: number;
    /**
     * The largest change of a height by one touch.
     */
    strength_m: number;
    /**
     * Of `level`.
     */
    height_m?: number;
    /**
     * Of `roughen`.
     */
    seed?: number;
    /**
     * x, y of each touch in whole centimetres; `ramp` and `ditch` go from each place to the next.
     */
    points_cm: readonly number[];
}

/**
 * Parameters by the names and tables of scenario files: nothing but `planner`, `sensor`, `robot` and
 * `reality`, and within them what differs.
 */
export type Overrides = { readonly [key: string]: OverrideValue | Overrides };

/**
 * Parameters that belong together.
 */
export interface ParameterGroup {
    /**
     * The table of a scenario file that they stand in.
     */
    table: string;
    title: string;
    parameters: Parameter[];
}

/**
 * Shapes.
 */
export type SolidList = Solid[];

/**
 * The file that a recipe imports, and how to read it.
 */
export interface ImportRequest {
    file: string;
    /**
     * In place of the file's own.
     */
    cell_m?: number;
    /**
     * Of black and white.
     */
    height_min_m?: number;
    height_max_m?: number;
    /**
     * `refuse`, `fill` or `crop`.
     */
    holes: string;
}

/**
 * The heights of a rectangle of the grid, row by row from its south-western corner.
 */
export interface GroundPatch {
    column: number;
    row: number;
    columns: number;
    rows: number;
    heights_m: Float32Array<ArrayBuffer>;
}

/**
 * The paper's six metrics, with the names that the command line prints.
 */
export interface Metrics {
    distance_m: number;
    max_abs_roll_rad: number;
    max_abs_pitch_rad: number;
    mean_vibration_rad_s: number;
    mean_elevation_rate_cm_s: number;
    curvature_change_rad_m: number;
}

/**
 * The process over the scan, with these inducing inputs.
 */
export interface Inside {
    /**
     * Column and row of each inducing input, those left out among them.
     */
    inducing: Uint16Array<ArrayBuffer>;
    /**
     * As in `FrameBuffers`.
     */
    occupancy: Float32Array<ArrayBuffer>;
    /**
     * As in `FrameBuffers`.
     */
    variance: Float32Array<ArrayBuffer>;
    /**
     * As in `FrameBuffers`.
     */
    profile: Float32Array<ArrayBuffer>;
}

/**
 * The value of a parameter.
 */
export type OverrideValue = number | string | boolean | readonly (OverrideValue | Overrides)[];

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
 * Two level places of a terrain far from each other.
 */
export interface LevelPlaces {
    start: Place;
    goal: Place;
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
 * What a checked scenario file says.
 */
export interface ScenarioRead {
    terrain: string;
    start: Heading;
    waypoints: Place[];
    goal: Goal;
    seed: number;
    /**
     * Its tables `planner`, `sensor`, `robot` and `reality` as written, where they are there.
     */
    overrides: Overrides;
    /**
     * Absent where the scenario stands on what its terrain lists.
     */
    objects?: ObjectList;
}

/**
 * What a parameter's value may be.
 */
export type ParameterKind = "number" | "whole" | "pair" | "switch" | "choice";

/**
 * What a preset gives for a parameter.
 */
export interface PresetValue {
    preset: string;
    value: OverrideValue;
}

/**
 * What a scenario is made of, after its files were read.
 */
export interface Scene {
    /**
     * Of the sensor's noise.
     */
    seed: number;
    start: Heading;
    /**
     * Driven to one after the other, before the goal.
     */
    waypoints: Place[];
    goal: Goal;
    /**
     * Time between two ticks.
     */
    period_s: number;
    limits: TiltLimits;
    /**
     * Radius of the occupancy surface: what lies farther is not looked at.
     */
    occupancy_radius_m: number;
    mount: Mount;
    image: ImageSize;
    demands: SegmentDemands;
    /**
     * The preset whose values `reality` has, `own` where they are those of none.
     */
    reality: 'ideal' | 'field' | 'harsh' | 'own';
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
 * What each touch does.
 */
export type StrokeKind = "raise" | "lower" | "smooth" | "level" | "roughen" | "crater" | "boulder" | "ramp" | "ditch";

/**
 * What is true of a place, and what the scan in view saw of it.
 */
export interface PlaceReport {
    /**
     * Seen from above, from the place to the nearest return; absent without returns.
     */
    nearest_return_m: number | undefined;
    /**
     * Evenly around the circle, from east counter-clockwise; empty off the terrain.
     */
    headings: HeadingThere[];
}

/**
 * What people are told of a parameter.
 */
export interface Parameter {
    name: string;
    /**
     * Empty for shares, counts and choices.
     */
    unit: string;
    /**
     * What it does.
     */
    text: string;
    kind: ParameterKind;
    /**
     * Of a number, a whole number or a pair: lowest and highest.
     */
    range: readonly [low: number, high: number] | undefined;
    /**
     * Of a choice.
     */
    choices: string[] | undefined;
    /**
     * What holds where nothing is overridden.
     */
    value: OverrideValue;
    /**
     * What the paper gives, where it gives one.
     */
    paper: OverrideValue | undefined;
    /**
     * What the presets of `reality` give; empty outside it.
     */
    presets: readonly PresetValue[];
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
 * What the planner thinks with.
 */
export interface ThinkingWith {
    overrides: Overrides;
    preset: Preset;
    /**
     * The scenario's own without it.
     */
    learning?: Learning;
}

/**
 * What to look at.
 */
export interface InsideQuestion {
    /**
     * The planner's own without it.
     */
    placement?: Placement;
    /**
     * The inducing inputs to leave out, by their numbers in the answer without this.
     */
    without: readonly number[];
}

/**
 * When the planner learns the hyperparameters of its Gaussian process.
 */
export type Learning = "fixed" | "once" | "every_scan";

/**
 * Where in time one can go, in ticks.
 */
export interface Timeline {
    first: number;
    end: number;
    /**
     * Where the route was changed.
     */
    changes: readonly number[];
}

/**
 * Where the inducing inputs are.
 */
export type Placement = "lattice" | "farthest_points" | "strided";

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
 * Where the robot stands, and whether the trial goes on: it does while the outcome is `running`.
 */
export interface Standing {
    tick: number;
    x: number;
    y: number;
    z: number;
    outcome: Outcome;
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
 * Where to drive at last.
 */
export interface Goal {
    x: number;
    y: number;
    /**
     * The heading to end with, counter-clockwise from east; any heading without it.
     */
    heading_rad?: number;
}

/**
 * Where to drive: to each waypoint in turn, then to the goal.
 */
export interface Route {
    waypoints: readonly Place[];
    goal: Goal;
}

/**
 * Whether a frame shows what the run decided.
 */
export type Thought = "run" | "again" | "what_if";

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
 * `default` is the best mapless planner known to the project, `paper` the literal text of the paper.
 */
export type Preset = "default" | "paper";


/**
 * A running trial.
 */
export class Session {
    free(): void;
    [Symbol.dispose](): void;
    /**
     * The climb of the bound on this scan with nothing to hold the hyperparameters, the start first.
     *
     * # Errors
     * The bound has no value, as without returns.
     */
    climb(): ClimbStep[];
    /**
     * Digest of the trajectory so far.
     */
    digest(): string;
    /**
     * Shows what the run decided again.
     */
    forget_thought(): void;
    /**
     * The present state. Fills `buffers`; the surfaces only where `surfaces` is set, since predicting them
     * takes longer than deciding, and the true skyline only where `truth` is.
     *
     * # Errors
     * A start whose ground has gone.
     */
    frame(buffers: FrameBuffers, surfaces: boolean, truth: boolean): Frame;
    /**
     * Goes back to `tick`, or to the nearest one that can be gone to; gives that. The session may stand
     * shortly before it: running forward from there repeats what happened.
     */
    go_back(tick: number): number;
    /**
     * Goes on from here with the parameters that were thought with last; without such, nothing changes. The
     * timeline begins anew.
     */
    go_on_so(): void;
    /**
     * The whole ground.
     *
     * # Errors
     * None, unless JavaScript runs out of memory.
     */
    ground(): Ground;
    /**
     * The covariance of every direction of the surfaces with one of them, as a share of the signal variance.
     */
    kernel_from(column: number, row: number): Float32Array;
    /**
     * Predicts the surfaces of the scan that is shown with inducing inputs of one's own choice. Nothing
     * changes for the run.
     *
     * # Errors
     * No posterior with these inducing inputs.
     */
    look_inside(question: InsideQuestion): Inside;
    /**
     * Loads a scenario.
     *
     * # Errors
     * A fault in one of the files or of an option, with place, value and expectation.
     */
    constructor(options: SessionOptions);
    /**
     * The objects on the ground.
     *
     * # Errors
     * None, unless JavaScript runs out of memory.
     */
    objects(): ObjectList;
    /**
     * Every parameter, with the value that holds unless it is overridden.
     *
     * # Errors
     * A value that does not fit the preset.
     */
    parameters(): ParameterGroup[];
    /**
     * Tells of a place on the ground.
     *
     * # Errors
     * None, unless JavaScript runs out of memory.
     */
    place_report(place: Place): PlaceReport;
    /**
     * Puts other heights in place of those in a rectangle.
     *
     * # Errors
     * Heights that do not fit; nothing then changes.
     */
    replace_ground(patch: GroundPatch): void;
    /**
     * Back to the start, with ground, start and route as they are now.
     *
     * # Errors
     * A start whose ground has gone.
     */
    restart(): void;
    /**
     * What changes only between trials and with the route.
     *
     * # Errors
     * A seed beyond the whole numbers of JavaScript.
     */
    scene(): Scene;
    /**
     * Applies a stroke; gives the rectangle that changed, or nothing when the stroke is off the terrain.
     *
     * # Errors
     * A stroke that makes no sense; nothing then changes.
     */
    sculpt(stroke: Stroke): GroundPatch | undefined;
    /**
     * Puts other objects on the ground in place of all there are, with the same consequences as a stroke.
     *
     * # Errors
     * An object that makes no sense, with its place and what was expected; nothing then changes.
     */
    set_objects(objects: ObjectList): void;
    /**
     * Begins anew with these overrides in place of all others. Ground, start and route stay as they are, and
     * so does the seed unless another is given.
     *
     * # Errors
     * A value that makes no sense, with its place and what was expected; nothing then changes.
     */
    set_parameters(overrides: Overrides, seed?: number | null): void;
    /**
     * Sets another route and drives on.
     *
     * # Errors
     * A place off the terrain; nothing then changes.
     */
    set_route(route: Route): void;
    /**
     * Begins anew from another start.
     *
     * # Errors
     * A start off the terrain; nothing then changes.
     */
    set_start(start: Heading): void;
    /**
     * The shapes that the objects are made of, where they are now.
     *
     * # Errors
     * None, unless JavaScript runs out of memory.
     */
    solids(): SolidList;
    /**
     * Where the robot stands.
     *
     * # Errors
     * None, unless JavaScript runs out of memory.
     */
    standing(): Standing;
    /**
     * Senses and decides again where the robot stands, with other parameters where they are given; frames
     * show that until the run goes on. The run itself stays as it was.
     *
     * # Errors
     * A value that makes no sense or cannot change under way, with its place and what was expected; nothing
     * then changes.
     */
    think_again(_with?: ThinkingWith | null): void;
    /**
     * Runs one tick: senses, plans, acts.
     *
     * # Errors
     * A start whose ground has gone.
     */
    tick(): Tick;
}

/**
 * The recipe of a generated terrain of a family, such as `hard` or `rocks`.
 *
 * # Errors
 * An unknown family.
 */
export function generated_recipe(family: string, seed: number): string;

/**
 * What a recipe imports; nothing where it imports nothing.
 *
 * # Errors
 * A fault of the recipe, with place, value and expectation.
 */
export function import_of(file: string, recipe: string): ImportRequest | undefined;

/**
 * Two level places of a terrain far from each other and from its objects, for a start and a goal.
 *
 * # Errors
 * A fault of the terrain, with place, value and expectation.
 */
export function level_places(terrain: TerrainFiles): LevelPlaces;

/**
 * Reads a scenario file.
 *
 * # Errors
 * The scenario's fault, with file, place, value and expectation.
 */
export function read_scenario(file: string, text: string): ScenarioRead;

/**
 * Runs once when the page loads the module.
 */
export function start(): void;

/**
 * A terrain for a picture: its objects, and a coarse grid with at most `most` samples along a side.
 *
 * # Errors
 * A fault of the terrain, with place, value and expectation.
 */
export function terrain_preview(terrain: TerrainFiles, most: number): TerrainPreview;

export type InitInput = RequestInfo | URL | Response | BufferSource | WebAssembly.Module;

export interface InitOutput {
    readonly memory: WebAssembly.Memory;
    readonly __wbg_session_free: (a: number, b: number) => void;
    readonly generated_recipe: (a: number, b: number, c: number) => [number, number, number, number];
    readonly import_of: (a: number, b: number, c: number, d: number) => [number, number, number];
    readonly level_places: (a: any) => [number, number, number];
    readonly read_scenario: (a: number, b: number, c: number, d: number) => [number, number, number];
    readonly session_climb: (a: number) => [number, number, number, number];
    readonly session_digest: (a: number) => [number, number];
    readonly session_forget_thought: (a: number) => void;
    readonly session_frame: (a: number, b: any, c: number, d: number) => [number, number, number];
    readonly session_go_back: (a: number, b: number) => number;
    readonly session_go_on_so: (a: number) => void;
    readonly session_ground: (a: number) => [number, number, number];
    readonly session_kernel_from: (a: number, b: number, c: number) => any;
    readonly session_look_inside: (a: number, b: any) => [number, number, number];
    readonly session_new: (a: any) => [number, number, number];
    readonly session_objects: (a: number) => [number, number, number];
    readonly session_parameters: (a: number) => [number, number, number, number];
    readonly session_place_report: (a: number, b: any) => [number, number, number];
    readonly session_replace_ground: (a: number, b: any) => [number, number];
    readonly session_restart: (a: number) => [number, number];
    readonly session_scene: (a: number) => [number, number, number];
    readonly session_sculpt: (a: number, b: any) => [number, number, number];
    readonly session_set_objects: (a: number, b: any) => [number, number];
    readonly session_set_parameters: (a: number, b: any, c: number) => [number, number];
    readonly session_set_route: (a: number, b: any) => [number, number];
    readonly session_set_start: (a: number, b: any) => [number, number];
    readonly session_solids: (a: number) => [number, number, number];
    readonly session_standing: (a: number) => [number, number, number];
    readonly session_think_again: (a: number, b: number) => [number, number];
    readonly session_tick: (a: number) => [number, number, number];
    readonly start: () => void;
    readonly terrain_preview: (a: any, b: number) => [number, number, number];
    readonly __wbindgen_malloc: (a: number, b: number) => number;
    readonly __wbindgen_realloc: (a: number, b: number, c: number, d: number) => number;
    readonly __wbindgen_free: (a: number, b: number, c: number) => void;
    readonly __wbindgen_exn_store: (a: number) => void;
    readonly __externref_table_alloc: () => number;
    readonly __wbindgen_externrefs: WebAssembly.Table;
    readonly __externref_table_dealloc: (a: number) => void;
    readonly __externref_drop_slice: (a: number, b: number) => void;
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

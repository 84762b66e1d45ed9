/* tslint:disable */
/* eslint-disable */
/**
 * A generated task.
 */
export interface GeneratedTask {
    /**
     * Its scenario file, whose terrain is at `terrain.toml`.
     */
    scenario: string;
    /**
     * The recipe of that.
     */
    recipe: string;
}

/**
 * All that a trial is begun with, on a ground.
 */
export interface RunnerOptions {
    /**
     * The text of a scenario file, whose terrain is left unread.
     */
    scenario: string;
    /**
     * Set from the beginning.
     */
    overrides: Overrides;
    /**
     * The name of a navigator.
     */
    planner: string;
    seed: number;
}

/**
 * All that such a trial is begun with, on a ground.
 */
export interface GuestOptions {
    /**
     * The text of a scenario file, whose terrain is left unread.
     */
    scenario: string;
    /**
     * Set from the beginning.
     */
    overrides: Overrides;
    seed: number;
}

/**
 * How a trial stands.
 */
export interface TrialStatus {
    tick: number;
    time_s: number;
    pose: Pose;
    metrics: Metrics;
    outcome: Outcome;
}

/**
 * How a trial stands: `running`, or how it ended.
 */
export type Outcome = "running" | "reached" | "tilt_limit" | "collision" | "high_centred" | "step" | "stuck" | "no_subgoal" | "left_terrain" | "timeout";

/**
 * Mean and sample standard deviation; NaN where there is none.
 */
export interface Spread {
    mean: number;
    deviation: number;
}

/**
 * Parameters by the names and tables of scenario files: nothing but `planner`, `sensor`, `robot` and
 * `reality`, and within them what differs.
 */
export type Overrides = { readonly [key: string]: OverrideValue | Overrides };

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
 * The value of a parameter.
 */
export type OverrideValue = number | string | boolean | readonly (OverrideValue | Overrides)[];

/**
 * What the planner is asked on each scan, besides its points.
 */
export interface GuestQuestion {
    time_s: number;
    /**
     * Since the last question.
     */
    elapsed_s: number;
    /**
     * As the robot believes.
     */
    pose: Pose;
    /**
     * The next waypoint, or the goal.
     */
    goal: GuestGoal;
}

/**
 * What the planner is told once: the tables `sensor` and `robot` of scenario files.
 */
export interface GuestModel {
    sensor: Readonly<Record<string, number>>;
    robot: Readonly<Record<string, number>>;
    /**
     * The goal is reached within this distance.
     */
    goal_tolerance_m: number;
}

/**
 * Where a rate lies.
 */
export interface Interval {
    low: number;
    high: number;
}

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
 * Where to.
 */
export interface GuestGoal {
    x: number;
    y: number;
    /**
     * The heading to end with; any where there is none.
     */
    heading_rad: number | undefined;
}


/**
 * The ground that trials run on, as the page has it now.
 */
export class Ground {
    free(): void;
    [Symbol.dispose](): void;
    /**
     * A height field, row by row from the south-west.
     *
     * # Errors
     * Heights that make no field.
     */
    constructor(columns: number, rows: number, cell_m: number, heights_m: Float32Array | number[]);
}

/**
 * One trial of somebody's own planner. Each tick is `look`, then `question`, `points` and `answer` if that
 * gave true, then `act`.
 */
export class GuestRunner {
    free(): void;
    [Symbol.dispose](): void;
    /**
     * Drives on until the next scan; returns whether the trial goes on.
     */
    act(): boolean;
    /**
     * Takes the answer.
     *
     * # Errors
     * Nothing is to be decided now, or the command is not finite.
     */
    answer(linear_m_s: number, angular_rad_s: number): void;
    /**
     * Digest of the trajectory so far.
     */
    digest(): string;
    /**
     * Takes a scan; returns whether there is something to decide.
     */
    look(): boolean;
    /**
     * Sensor and robot.
     *
     * # Errors
     * None, unless JavaScript runs out of memory.
     */
    model(): GuestModel;
    /**
     * Puts the scenario's robot on the ground.
     *
     * # Errors
     * A fault in the scenario or a value that makes no sense, with its place and what was expected.
     */
    constructor(ground: Ground, options: GuestOptions);
    /**
     * x, y, z of each return of the scan, in the sensor frame.
     */
    points(): Float32Array;
    /**
     * What is to be decided on.
     *
     * # Errors
     * Nothing is to be decided now.
     */
    question(): GuestQuestion;
    /**
     * How the trial stands.
     *
     * # Errors
     * None, unless JavaScript runs out of memory.
     */
    status(): TrialStatus;
}

/**
 * One trial of one navigator.
 */
export class Runner {
    free(): void;
    [Symbol.dispose](): void;
    /**
     * Digest of the trajectory so far.
     */
    digest(): string;
    /**
     * Puts the scenario's robot on the ground with a navigator.
     *
     * # Errors
     * A fault in the scenario or a value that makes no sense, with its place and what was expected.
     */
    constructor(ground: Ground, options: RunnerOptions);
    /**
     * How the trial stands.
     *
     * # Errors
     * None, unless JavaScript runs out of memory.
     */
    status(): TrialStatus;
    /**
     * One planning period; returns whether the trial goes on.
     */
    tick(): boolean;
}

/**
 * The generated task of a name such as `hard-1-0007`.
 *
 * # Errors
 * What names no task; a task that the oracle cannot solve however often it is drawn.
 */
export function generated_task(name: string): GeneratedTask;

/**
 * Mean and sample standard deviation; NaN where there is none.
 *
 * # Errors
 * None, unless JavaScript runs out of memory.
 */
export function mean_and_deviation(values: Float64Array | number[]): Spread;

/**
 * The names of all navigators.
 */
export function planners(): string[];

/**
 * Runs once when the page loads the module.
 */
export function start(): void;

/**
 * Wilson's 95 % interval of the rate behind `successes` of `trials`.
 *
 * # Errors
 * None, unless JavaScript runs out of memory.
 */
export function wilson(successes: number, trials: number): Interval;

export type InitInput = RequestInfo | URL | Response | BufferSource | WebAssembly.Module;

export interface InitOutput {
    readonly memory: WebAssembly.Memory;
    readonly __wbg_ground_free: (a: number, b: number) => void;
    readonly __wbg_guestrunner_free: (a: number, b: number) => void;
    readonly __wbg_runner_free: (a: number, b: number) => void;
    readonly generated_task: (a: number, b: number) => [number, number, number];
    readonly ground_new: (a: number, b: number, c: number, d: number, e: number) => [number, number, number];
    readonly guestrunner_act: (a: number) => number;
    readonly guestrunner_answer: (a: number, b: number, c: number) => [number, number];
    readonly guestrunner_digest: (a: number) => [number, number];
    readonly guestrunner_look: (a: number) => number;
    readonly guestrunner_model: (a: number) => [number, number, number];
    readonly guestrunner_new: (a: number, b: any) => [number, number, number];
    readonly guestrunner_points: (a: number) => [number, number];
    readonly guestrunner_question: (a: number) => [number, number, number];
    readonly guestrunner_status: (a: number) => [number, number, number];
    readonly mean_and_deviation: (a: number, b: number) => [number, number, number];
    readonly planners: () => [number, number];
    readonly runner_digest: (a: number) => [number, number];
    readonly runner_new: (a: number, b: any) => [number, number, number];
    readonly runner_status: (a: number) => [number, number, number];
    readonly runner_tick: (a: number) => number;
    readonly start: () => void;
    readonly wilson: (a: number, b: number) => [number, number, number];
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

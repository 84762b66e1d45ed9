/** How the planner is set up. */

import type { Overrides } from './overrides.ts';

/** `default` is the best mapless planner known to the project, `paper` the literal text of the paper. */
export type Preset = 'default' | 'paper';

/** When the planner learns the hyperparameters of its Gaussian process. */
export type Learning = 'fixed' | 'once' | 'every_scan';

export interface Setting {
  readonly preset: Preset;
  readonly learning: Learning;
}

/** What stays as it is from one scenario to the next. */
export interface Setup extends Setting {
  readonly overrides: Overrides;
}

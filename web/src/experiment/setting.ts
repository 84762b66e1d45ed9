/** How the planner is set up. */

import type { Learning, Preset } from '../wasm/mapless_wasm.js';
import type { Overrides } from './overrides.ts';

export type { Learning, Preset };

export interface Setting {
  readonly preset: Preset;
  readonly learning: Learning;
}

/** What stays as it is from one scenario to the next. */
export interface Setup extends Setting {
  readonly overrides: Overrides;
}

/** What can drive beside the page's own planner: names, words and colours that colour-blind readers tell apart. */

import { OWN_PLANNER } from '../trials/trialsProtocol.ts';

export interface Rival {
  /** Its planner, or what tells it from those that have another's. */
  readonly planner: string;
  readonly name: string;
  readonly meaning: string;
  readonly colour: string;
}

/** The same planner with the same seed, where nothing goes wrong. */
export const IDEAL_RIVAL: Rival = {
  planner: 'ideal',
  name: 'Ideal',
  meaning: 'the planner in view in an ideal world',
  colour: '#5f9e00',
};

/** The same planner without what was learned or set by hand of its Gaussian process. */
export const FIXED_RIVAL: Rival = {
  planner: 'fixed',
  name: 'Fixed',
  meaning: 'the planner in view with its own, fixed hyperparameters',
  colour: '#8c564b',
};

export const RIVALS: readonly Rival[] = [
  { planner: 'default', name: 'Best', meaning: 'the best mapless planner of this project', colour: '#b58900' },
  { planner: 'paper', name: 'Paper', meaning: 'the paper’s text taken literally', colour: '#d55e00' },
  { planner: 'flat', name: 'Flat', meaning: 'the paper without its steepness cost', colour: '#cc79a7' },
  { planner: 'direct', name: 'Direct', meaning: 'straight at the goal', colour: '#7f7f7f' },
  { planner: 'vgf', name: 'VGF', meaning: 'the paper’s baseline, with a map, as published', colour: '#009e73' },
  { planner: 'vgf_tuned', name: 'VGF tuned', meaning: 'the same with a better search', colour: '#56b4e9' },
  { planner: 'putn', name: 'PUTN', meaning: 'plane-fitting RRT*, with a map', colour: '#7b5cd6' },
  { planner: 'oracle', name: 'Oracle', meaning: 'the shortest safe path over the known ground', colour: '#0072b2' },
  IDEAL_RIVAL,
  FIXED_RIVAL,
];

/** Somebody's own planner. */
export const OWN_RIVAL: Rival = {
  planner: OWN_PLANNER,
  name: 'Yours',
  meaning: 'your own planner, written or opened below',
  colour: '#f0e442',
};

/** Parameter sets that are kept; what they mean follows from what is in view. */
export const SET_RIVALS: readonly Rival[] = [
  { planner: 'set A', name: 'A', meaning: '', colour: '#c2185b' },
  { planner: 'set B', name: 'B', meaning: '', colour: '#17becf' },
];

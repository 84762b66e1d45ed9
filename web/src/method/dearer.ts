/** What makes one subgoal dearer than another. */

import { fixed } from '../base/format.ts';
import { type Cost, TERMS } from '../protocol/simulationProtocol.ts';

/** By how much, and the term that adds most to it. */
export function dearerBy(theirs: Cost, ours: Cost): string {
  const differences = TERMS.map((name) => [name, theirs[name] - ours[name]] as const);
  const [term, most] = differences.reduce((a, b) => (b[1] > a[1] ? b : a));
  return `${fixed(theirs.total - ours.total, 3)}, above all for ${term} (${fixed(most, 3)})`;
}

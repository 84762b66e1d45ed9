/** Where what holds departs from what the paper gives. */

import { override } from './overrides.ts';
import type { Parameter, ParameterGroup } from './parameters.ts';
import type { Setup } from './setting.ts';

/** Chosen by itself, beside the parameters. */
const LEARNING = 'planner.perception.learning';

interface Departure {
  readonly table: string;
  readonly parameter: Parameter;
}

/** Every parameter with a value of the paper that has another now; `parameters` has the values that hold unless overridden. */
export function departures(
  parameters: readonly ParameterGroup[],
  { overrides, learning }: Pick<Setup, 'overrides' | 'learning'>,
): readonly Departure[] {
  return parameters.flatMap(({ table, parameters: all }) =>
    all.flatMap((parameter) => {
      const { name, value, paper } = parameter;
      if (paper === undefined) return [];
      const chosen = table === LEARNING && name === 'mode' ? learning : override(overrides, table, name);
      return JSON.stringify(chosen ?? value) === JSON.stringify(paper) ? [] : [{ table, parameter }];
    }),
  );
}

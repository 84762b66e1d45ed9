/** How one setup differs from another, in words. */

import { override } from './overrides.ts';
import { label, type Parameter, type ParameterGroup, shown } from './parameters.ts';
import { realityOf } from './reality.ts';
import type { Setup } from './setting.ts';

/** Each value of `setup` that is another in `view`, with that in brackets; `parameters` has what holds in view where nothing is overridden. */
export function differences(setup: Setup, view: Setup, parameters: readonly ParameterGroup[]): readonly string[] {
  const of = (one: Setup, table: string, parameter: Parameter) =>
    override(one.overrides, table, parameter.name) ?? usual(one, view, parameter);
  const values = parameters.flatMap(({ table, parameters: all }) =>
    all.flatMap((parameter): [string, string, string][] => {
      const { name, unit } = parameter;
      const set = [setup, view].some(({ overrides }) => override(overrides, table, name) !== undefined);
      if (!set) return [];
      const words = [setup, view].map((one) => {
        const value = of(one, table, parameter);
        return value === undefined ? 'as its planner has it' : `${shown(value, unit)} ${unit}`.trim();
      });
      return [[table === 'reality' ? 'reality' : label(name), words[0] ?? '', words[1] ?? '']];
    }),
  );
  const chosen: [string, string, string][] = [
    ['planner', setup.preset, view.preset],
    ['learning', shown(setup.learning), shown(view.learning)],
  ];
  return [...chosen, ...values].flatMap(([name, one, other]) => (one === other ? [] : [`${name} ${one} (${other})`]));
}

/** What holds where it is not overridden; nothing of another planner than that in view is known. */
function usual(setup: Setup, view: Setup, { presets, value }: Parameter) {
  const inReality = presets.find(({ preset }) => preset === realityOf(setup.overrides));
  return inReality?.value ?? (setup.preset === view.preset ? value : undefined);
}

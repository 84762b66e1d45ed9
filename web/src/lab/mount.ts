/** The mount of the sensor as a group of its own in the table of parameters, with mounts to choose from. */

import { button, html } from '../base/dom.ts';
import { type Overrides, type OverrideValue, withOverride } from '../experiment/overrides.ts';
import type { ParameterGroup } from '../experiment/parameters.ts';
import type { Mount } from '../protocol/simulationProtocol.ts';

const TITLE = 'Sensor mount';
const NAMES: readonly string[] = [
  'height_m',
  'forward_m',
  'left_m',
  'roll_rad',
  'pitch_rad',
  'yaw_rad',
] satisfies (keyof Mount)[];

/** What a mount to try sets; the rest is as the scenario has it. */
export type MountPreset = Partial<Mount>;

const LEVEL: MountPreset = { roll_rad: 0, pitch_rad: 0 };

const PRESETS: readonly (readonly [string, MountPreset])[] = [
  ['Level', LEVEL],
  ['15° down', { ...LEVEL, pitch_rad: -0.2618 }],
  ['Upside down', { ...LEVEL, roll_rad: Math.PI }],
  ['Mast of 1.7 m', { ...LEVEL, height_m: 1.7 }],
];

/** The group in two where it has the mount in it. */
export function mountOf(group: ParameterGroup): ParameterGroup[] {
  if (group.table !== 'sensor') return [group];
  const isMount = ({ name }: { name: string }) => NAMES.includes(name);
  return [
    { ...group, parameters: group.parameters.filter((one) => !isMount(one)) },
    { ...group, title: TITLE, parameters: group.parameters.filter(isMount) },
  ];
}

/** Mounts the sensor so; whatever else is overridden stays. `group` has the values of the scenario itself. */
export function withMount(overrides: Overrides, mount: MountPreset, group: ParameterGroup): Overrides {
  const values: Record<string, OverrideValue | undefined> = mount;
  return group.parameters.reduce(
    (all, { name, value }) => withOverride(all, group.table, name, values[name] === value ? undefined : values[name]),
    overrides,
  );
}

/** A row of buttons, for the group of the mount. */
export function presetButtons(group: ParameterGroup, choose: (mount: MountPreset) => void): HTMLElement[] {
  if (group.title !== TITLE) return [];
  const buttons = PRESETS.map(([name, mount]) => button('plain', name, () => choose(mount)));
  return [html('div', 'lab-row presets', buttons)];
}

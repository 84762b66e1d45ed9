/** The popover that chooses what the 3D view shows. */

import { byId, html, setText } from '../base/dom.ts';
import { fixed } from '../base/format.ts';
import { FARTHEST_RANGE_M, FIRST_LAYERS, type Layers, POINT_COLOURS, type PointColours } from '../scene/layers.ts';

const POINT_WORDS: Record<PointColours, string> = {
  use: 'used or not',
  range: 'range',
  height: 'height',
  ring: 'ring',
  none: 'hidden',
};

type Switch = Exclude<keyof Layers, 'points'>;
const SWITCHES: readonly (readonly [Switch, string, string, string])[] = [
  [
    'observed',
    'Observed occupancy',
    'inner',
    'Where beams hit within the radius of the occupancy surface, and how near.',
  ],
  ['occupancy', 'Reconstructed occupancy', 'middle', 'The mean that the Gaussian process predicts from it.'],
  [
    'variance',
    'Variance',
    'outer',
    'How unsure the prediction is: dark where ground was seen, light where space is free.',
  ],
  ['segments', 'Segments', '', 'Level pieces of the skyline; those that carry no subgoals in red.'],
  ['subgoals', 'Subgoals', '', 'Places to go next, coloured by cost.'],
  ['path', 'Path', '', 'The cheapest path to the chosen subgoal that the best planner found; red in reverse.'],
];

export class LayersPanel {
  readonly #panel = byId('layers', HTMLElement);
  readonly #button = byId('layers-open', HTMLButtonElement);
  readonly #points = html('select');
  readonly #scale = html('div', 'layers-scale');
  readonly #ends = [html('span'), html('span')] as const;
  readonly #boxes = new Map<Switch, HTMLInputElement>();
  readonly #changed: (layers: Layers) => void;
  #heights_m: readonly [number, number] = [0, 0];
  #layers = FIRST_LAYERS;

  constructor(changed: (layers: Layers) => void) {
    this.#changed = changed;
    for (const by of POINT_COLOURS) {
      const option = html('option', '', [POINT_WORDS[by]]);
      option.value = by;
      this.#points.append(option);
    }
    this.#points.addEventListener('change', () => {
      const points = POINT_COLOURS.find((by) => by === this.#points.value) ?? 'use';
      this.set({ ...this.#layers, points });
    });
    this.#scale.append(this.#ends[0], html('i', 'layers-ramp key-viridis'), this.#ends[1]);
    this.#panel.prepend(
      html('legend', 'layers-title', ['Layers']),
      html('label', 'layers-points', [html('span', '', ['Point cloud by']), this.#points]),
      this.#scale,
      html(
        'ul',
        'layers-list',
        SWITCHES.map((one) => html('li', '', [this.#switch(...one)])),
      ),
    );
    // The popover stands beside the camera's buttons; narrow screens show it as a sheet (see the style).
    this.#panel.addEventListener('beforetoggle', () => {
      const box = (this.#button.parentElement ?? this.#button).getBoundingClientRect();
      this.#panel.style.setProperty('--from-top', `${box.top.toFixed(0)}px`);
      this.#panel.style.setProperty(
        '--from-right',
        `${(document.documentElement.clientWidth - box.left + 8).toFixed(0)}px`,
      );
    });
    this.#show(FIRST_LAYERS);
  }

  toggle(): void {
    this.#panel.togglePopover();
  }

  get layers(): Layers {
    return this.#layers;
  }

  /** Shows other layers, here and in the view. */
  set(layers: Layers): void {
    this.#show(layers);
    this.#changed(layers);
  }

  /** The lowest and the highest ground, for the scale. */
  heights(min_m: number, max_m: number): void {
    this.#heights_m = [min_m, max_m];
    this.#show(this.#layers);
  }

  #show(layers: Layers): void {
    this.#layers = layers;
    this.#points.value = layers.points;
    for (const [key, box] of this.#boxes) box.checked = layers[key];
    const { points } = layers;
    this.#scale.hidden = points === 'use' || points === 'none';
    const [min, max] = this.#heights_m;
    const ends = { range: ['0 m', `${FARTHEST_RANGE_M} m`], height: [`${fixed(min, 1)} m`, `${fixed(max, 1)} m`] };
    const [low = '−15°', high = '+15°'] = points === 'range' || points === 'height' ? ends[points] : [];
    setText(this.#ends[0], low);
    setText(this.#ends[1], high);
  }

  #switch(key: Switch, name: string, place: string, meaning: string): HTMLElement {
    const box = html('input');
    box.type = 'checkbox';
    box.addEventListener('change', () => this.set({ ...this.#layers, [key]: box.checked }));
    this.#boxes.set(key, box);
    const label = html('label', 'layers-switch', [box, html('span', '', [name]), html('i', `layers-key layer-${key}`)]);
    if (place) label.insertBefore(html('span', 'layers-place', [place]), label.lastChild);
    label.title = meaning;
    return label;
  }
}

/** The six metrics of the paper, as they stand, beside the paper's own. */

import { html, setText } from '../base/dom.ts';
import { fixed } from '../base/format.ts';
import type { Metrics } from '../protocol/simulationProtocol.ts';
import type { Published } from '../run/published.ts';

export interface MetricRow {
  readonly key: keyof Metrics;
  readonly name: string;
  readonly symbol: string;
  readonly unit: string;
  readonly decimals: number;
  readonly meaning: string;
}

export const METRIC_ROWS: readonly MetricRow[] = [
  {
    key: 'distance_m',
    name: 'Distance',
    symbol: 'D',
    unit: 'm',
    decimals: 1,
    meaning: 'Length of the path driven from the start.',
  },
  {
    key: 'mean_elevation_rate_cm_s',
    name: 'Elevation rate',
    symbol: 'ż',
    unit: 'cm/s',
    decimals: 1,
    meaning: 'Mean rate of climbing or descending.',
  },
  {
    key: 'max_abs_roll_rad',
    name: 'Largest roll',
    symbol: '|φ|',
    unit: 'rad',
    decimals: 3,
    meaning: 'Largest roll angle so far, either side.',
  },
  {
    key: 'max_abs_pitch_rad',
    name: 'Largest pitch',
    symbol: '|ψ|',
    unit: 'rad',
    decimals: 3,
    meaning: 'Largest pitch angle so far, up or down.',
  },
  {
    key: 'mean_vibration_rad_s',
    name: 'Vibration',
    symbol: 'v_b',
    unit: 'rad/s',
    decimals: 3,
    meaning: 'Mean of the rates of roll and pitch together.',
  },
  {
    key: 'curvature_change_rad_m',
    name: 'Curvature change',
    symbol: 'C',
    unit: 'rad/m',
    decimals: 3,
    meaning: 'Mean change of the path’s curvature: how much it weaves.',
  },
];

export class MetricsPanel {
  readonly #values = new Map<keyof Metrics, HTMLElement>();
  readonly #papers = new Map<keyof Metrics, HTMLElement>();

  constructor(list: HTMLElement) {
    for (const row of METRIC_ROWS) {
      const value = html('span', 'metric-value', ['–']);
      const paper = html('dd', 'metric-paper');
      this.#values.set(row.key, value);
      this.#papers.set(row.key, paper);
      const item = html('div', 'metric', [
        html('dt', 'metric-name', [row.name]),
        html('dd', 'metric-reading', [value, html('span', 'metric-unit', [` ${row.unit}`])]),
        paper,
      ]);
      item.title = `${row.symbol}: ${row.meaning}`;
      list.append(item);
    }
  }

  /** What the paper reports for its own route, on which the scenario is modelled. */
  paper(paper: Published | undefined): void {
    for (const { key, decimals } of METRIC_ROWS) {
      const element = this.#papers.get(key);
      const spread = paper?.deviation ? ` ± ${fixed(paper.deviation[key], decimals)}` : '';
      if (element) setText(element, paper ? `paper ${fixed(paper.mean[key], decimals)}${spread}` : '');
    }
  }

  show(metrics: Metrics): void {
    for (const row of METRIC_ROWS) {
      const element = this.#values.get(row.key);
      if (element) setText(element, fixed(metrics[row.key], row.decimals));
    }
  }
}

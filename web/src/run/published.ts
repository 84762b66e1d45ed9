/** What the paper reports for a route. */

import file from '../../../terrains/published.json';
import type { Metrics } from '../protocol/simulationProtocol.ts';

export interface Published {
  readonly mean: Metrics;
  /** Where the paper gives it. */
  readonly deviation: Metrics | undefined;
}

/** The paper's numbers for its own method on the route that a scenario is modelled on. */
export function published(scenario: string): Published | undefined {
  const row = file.rows.find(({ route, method }) => route === scenario && method === 'paper');
  if (!row) return undefined;
  return { mean: metrics(row.mean), deviation: row.deviation ? metrics(row.deviation) : undefined };
}

function metrics(values: readonly number[]): Metrics {
  return Object.fromEntries(file.metrics.map((name, index) => [name, values[index]])) as unknown as Metrics;
}

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { rowsOf } from '../src/files/csv.ts';
import { openCampaign } from '../src/trials/campaignFile.ts';
import { campaignRows } from '../src/trials/campaignRows.ts';

test('fields with commas, quotes and lines are read as they were', () => {
  assert.deepEqual(rowsOf('a,b\r\n"1,\n2","say ""x"""\n,\n'), [
    { a: '1,\n2', b: 'say "x"' },
    { a: '', b: '' },
  ]);
  assert.deepEqual(rowsOf('a,b\n1,'), [{ a: '1', b: '' }]);
  assert.throws(() => rowsOf('a,b\n1\n'), /row 2: 1 fields: expected 2/);
  assert.throws(() => rowsOf('a\n"x'), /row 2: a quote that does not close/);
});

/** What `mapless report` keeps of a campaign. */
const SAMPLE = 'docs/results/ablation.parquet';

const knows = (route: string) => route !== 'own';
const HEAD = 'planner,route,truth,parameters,reality,seed,outcome,distance_m';

test('a row knows how the page drives it, or why not', () => {
  const path = 'planner.perception.kernel.length_scales_rad=[0.12, 0.05] planner.decision.cost_model=paper';
  const lines = [
    HEAD,
    `default,ht,none,"${path}",,7,reached,9.5`,
    'vgf,ht,none,,,1,stuck,',
    'paper,own,none,,,1,reached,1',
    'default,hard-1-0007,ground,,,1,reached,1',
    'paper,hard-1-0007,none,,wet,1,reached,1',
  ];
  const rows = campaignRows(rowsOf(lines.join('\n')), knows);
  const planner = { perception: { kernel: { length_scales_rad: [0.12, 0.05] } }, decision: { cost_model: 'paper' } };
  assert.deepEqual(rows[0]?.replay, { scenario: 'ht', preset: 'default', seed: 7, overrides: { planner } });
  assert.equal(rows[0]?.metrics.distance_m, 9.5);
  assert.ok(Number.isNaN(rows[1]?.metrics.distance_m));
  const why = rows.slice(1).map(({ replay }) => String(replay));
  for (const [at, words] of [
    'default and paper',
    'does not come with',
    'perception override',
    'its reality',
  ].entries()) {
    assert.match(why[at] ?? '', new RegExp(words));
  }
  assert.equal(rows[3]?.variant, 'truth=ground');
});

test('a table of something else is refused with its name and what it lacks', async () => {
  const opened = (name: string, content: string | Buffer) =>
    openCampaign(name, new Uint8Array(Buffer.from(content)), knows);
  await assert.rejects(opened('x.csv', 'time_s,x_m\n0,1\n'), /^Error: x\.csv: no column planner, route, seed, outcome/);
  await assert.rejects(opened('x.csv', HEAD), /x\.csv: no rows/);
  await assert.rejects(opened('x.parquet', 'PAR1'), /^Error: x\.parquet: /);
  await assert.rejects(opened('x.parquet', HEAD.repeat(9)), /^Error: x\.parquet: damaged \(.*\): expected Parquet/);
});

test('Parquet, as the command line writes it, has the rows of the same CSV', async () => {
  const parquet = await openCampaign('a.parquet', new Uint8Array(readFileSync(SAMPLE)), () => true);
  assert.ok(parquet.length > 100);
  const reached = parquet.find(({ outcome }) => outcome === 'reached');
  assert.ok(Number.isInteger(reached?.seed) && (reached?.metrics.distance_m ?? 0) > 1);
  assert.match(reached?.digest ?? '', /^[0-9a-f]{16}/);
  // What a trial does not have is no number.
  for (const { outcome, metrics } of parquet) if (outcome === 'error') assert.ok(Number.isNaN(metrics.distance_m));
});

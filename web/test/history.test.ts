import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Editor } from '../src/editor/editor.ts';
import type { WorldObject } from '../src/experiment/objects.ts';
import type { Command, Ground, GroundPatch, Source } from '../src/protocol/simulationProtocol.ts';
import { EXPERIMENT } from './example.ts';

/** A core whose strokes raise whole rows by one metre, and which notes what it is asked. */
class Core {
  readonly asked: string[] = [];
  readonly editor: Editor;
  info: ReturnType<ConstructorParameters<typeof Editor>[0]['info']>;
  readonly field: Ground = { columns: 4, rows: 4, cell_m: 1, heights_m: new Float32Array(16) };

  constructor() {
    this.editor = new Editor({
      request: (command) => this.#carryOut(command),
      ground: () => this.field,
      info: () => this.info,
      mayThink: () => false,
      changed: () => {},
    });
  }

  async #carryOut(command: Command): Promise<void> {
    await Promise.resolve();
    this.asked.push(command.type);
    if (command.type === 'load' && 'experiment' in command.source) {
      this.editor.loaded({ experiment: command.source.experiment, scenario: SOURCE.experiment });
    }
    if (command.type === 'goal' && command.goal.x < 0) throw new Error('goal off the terrain');
    if (command.type === 'sculpt') {
      for (let at = 0; at < command.stroke.points_cm.length; at += 2) {
        const row = (command.stroke.points_cm[at + 1] ?? 0) / 100;
        const heights_m = this.field.heights_m.slice(4 * row, 4 * row + 4).map((height) => height + 1);
        this.#put({ column: 0, row, columns: 4, rows: 1, heights_m });
      }
    }
    if (command.type === 'replace') this.#put(command.patch);
  }

  #put(patch: GroundPatch): void {
    this.field.heights_m.set(patch.heights_m, 4 * patch.row);
    this.editor.patched(patch);
  }

  stroke(...rows: number[]): Promise<void> {
    const stroke = this.editor.stroke({ kind: 'raise', radius_m: 1, strength_m: 1 });
    for (const y of rows) stroke.touch({ x: 0, y });
    return stroke.end();
  }

  heights(): number[] {
    return [0, 4, 8, 12].map((at) => this.field.heights_m[at] ?? Number.NaN);
  }
}

const SOURCE = { experiment: { ...EXPERIMENT, strokes: [] } } satisfies Source;

async function opened(): Promise<Core> {
  const core = new Core();
  await core.editor.open(SOURCE, false, false);
  core.asked.length = 0;
  return core;
}

test('strokes are undone and redone by putting heights back, in any number and in order', async () => {
  const core = await opened();
  await core.stroke(1, 2);
  await core.stroke(2, 3, 2);
  assert.deepEqual(core.heights(), [0, 1, 3, 1]);
  assert.equal(core.editor.experiment?.strokes[1]?.points_cm.length, 6);
  await core.editor.undo();
  assert.deepEqual(core.heights(), [0, 1, 1, 0]);
  await core.editor.undo();
  assert.deepEqual(core.heights(), [0, 0, 0, 0]);
  assert.equal(core.editor.canUndo, false);
  await core.editor.undo();
  await core.editor.redo();
  await core.editor.redo();
  assert.deepEqual(core.heights(), [0, 1, 3, 1]);
  assert.equal(core.editor.canRedo, false);
  assert.ok(
    core.asked.slice(2).every((type) => type === 'sculpt' || type === 'replace'),
    core.asked.join(),
  );
});

test('goal, start and strokes share one history', async () => {
  const core = await opened();
  await core.editor.setRoute(() => ({ waypoints: [], goal: { x: 8.123456, y: 2 } }));
  assert.deepEqual(core.editor.experiment?.goal, { x: 8.12, y: 2 });
  await core.editor.setRoute(() => ({ waypoints: [], goal: { x: 8.12, y: 2, heading_rad: 0.12345 } }));
  assert.deepEqual(core.editor.experiment?.goal, { x: 8.12, y: 2, heading_rad: 0.123 });
  await core.stroke(1);
  await core.editor.setStart({ x: 1, y: 1, heading_rad: 0.12345 });
  core.asked.length = 0;
  await core.editor.undo();
  await core.editor.undo();
  await core.editor.undo();
  assert.deepEqual(core.editor.experiment?.goal, { x: 8.12, y: 2 });
  await core.editor.undo();
  assert.deepEqual(core.asked, ['start', 'replace', 'goal', 'goal']);
  assert.deepEqual(core.editor.experiment, SOURCE.experiment);
});

test('another start, route or ground is not the scenario’s any more, until it is taken back', async () => {
  const core = await opened();
  assert.equal(core.editor.asItComes, true);
  for (const change of [
    () => core.stroke(1),
    () => core.editor.setStart({ x: 12.01, y: 12, heading_rad: 1.5 }),
    () => core.editor.setRoute(() => ({ waypoints: [], goal: EXPERIMENT.goal })),
    () => core.editor.setRoute(() => ({ waypoints: EXPERIMENT.waypoints, goal: { x: 14, y: 57.01 } })),
    () => core.editor.setRoute(() => ({ ...EXPERIMENT, goal: { ...EXPERIMENT.goal, heading_rad: 1 } })),
  ]) {
    await change();
    assert.equal(core.editor.asItComes, false);
    await core.editor.undo();
    assert.equal(core.editor.asItComes, true);
  }
  await core.editor.change({ preset: 'paper' });
  assert.equal(core.editor.asItComes, true);
});

test('objects share the history, and are taken back without loading where it is known what stood there', async () => {
  const core = new Core();
  const post = { kind: 'post', at: [1.004, 2], radius_m: 0.2, height_m: 1 } as const satisfies WorldObject;
  core.info = { objects: [], waypoints: [], goal: EXPERIMENT.goal, runsWith: undefined };
  await core.editor.open(SOURCE, false, false);
  core.asked.length = 0;
  await core.editor.setObjects((objects) => [...objects, { ...post, at: [...post.at] }]);
  assert.deepEqual(core.editor.experiment?.objects, [{ ...post, at: [1, 2] }]);
  assert.equal(core.editor.asItComes, false);
  await core.editor.undo();
  assert.equal(core.editor.experiment?.objects, undefined);
  assert.equal(core.editor.asItComes, true);
  await core.editor.redo();
  assert.deepEqual(core.asked, ['objects', 'objects', 'objects']);
  // Of an experiment that says its objects it is not known what stands there without them.
  await core.editor.open({ experiment: { ...SOURCE.experiment, objects: [] } }, true, false);
  core.asked.length = 0;
  await core.editor.undo();
  await core.editor.undo();
  assert.deepEqual(core.asked, ['objects', 'load']);
});

test('settings and other terrains are undone by loading', async () => {
  const core = await opened();
  await core.stroke(1);
  await core.editor.change({ preset: 'paper' });
  await core.editor.open({ experiment: { ...EXPERIMENT, name: 'other' } }, true, false);
  core.asked.length = 0;
  await core.editor.undo();
  assert.equal(core.editor.experiment?.preset, 'paper');
  await core.editor.undo();
  assert.equal(core.editor.experiment?.preset, 'default');
  assert.equal(core.editor.experiment?.strokes.length, 1);
  assert.deepEqual(core.asked, ['load', 'load']);
});

test('what the core refuses leaves no trace, and what follows goes on', async () => {
  const core = await opened();
  const before = core.editor.experiment;
  await assert.rejects(
    core.editor.setRoute(() => ({ waypoints: [], goal: { x: -1, y: 0 } })),
    /off the terrain/,
  );
  assert.equal(core.editor.experiment, before);
  await core.stroke(1);
  assert.equal(core.editor.experiment?.strokes.length, 1);
});

test('a new change gives up what was undone; everything waits for the stroke in hand', async () => {
  const core = await opened();
  await core.stroke(1);
  await core.editor.undo();
  await core.stroke(3);
  assert.equal(core.editor.canRedo, false);
  const stroke = core.editor.stroke({ kind: 'raise', radius_m: 1, strength_m: 1 });
  stroke.touch({ x: 0, y: 0 });
  const undone = core.editor.undo();
  stroke.touch({ x: 0, y: 0 });
  await stroke.end();
  await undone;
  assert.deepEqual(core.heights(), [0, 0, 0, 1]);
});

test('undoing leads from an experiment of somebody else back to one’s own', async () => {
  const core = new Core();
  const own = { ...EXPERIMENT, name: 'own' };
  core.editor.loaded({ experiment: EXPERIMENT, scenario: undefined });
  await core.editor.begin(
    Promise.resolve({ from: 'link', own: { id: 'a', experiment: own }, unread: undefined, moment_s: undefined }),
  );
  assert.equal(core.editor.experiment?.name, EXPERIMENT.name);
  await core.editor.undo();
  assert.equal(core.editor.experiment, own);
});

test('what begins anew does so with the route of the experiment, also from an earlier one', async () => {
  const core = await opened();
  const { waypoints, goal } = EXPERIMENT;
  core.info = { objects: [], waypoints: [...waypoints], goal, runsWith: undefined };
  await core.editor.restart();
  core.info = { objects: [], waypoints: [], goal, runsWith: undefined };
  await core.editor.setOverrides({ sensor: { columns: 900 } });
  assert.deepEqual(core.asked, ['restart', 'goal', 'parameters']);
  assert.deepEqual(core.editor.experiment?.overrides, { sensor: { columns: 900 } });
});

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { costColour, luminance, parseHex, ramp } from '../src/colours/scale.ts';

test('cheaper subgoals are lighter, all along the scale', () => {
  const lights = Array.from({ length: 41 }, (_, step) => luminance(costColour(step / 40, 0, 1)));
  for (let index = 1; index < lights.length; index += 1) {
    assert.ok((lights[index] ?? 0) < (lights[index - 1] ?? 0), `step ${index}`);
  }
});

test('a single candidate has the colour of the cheapest', () => {
  assert.deepEqual(costColour(3, 3, 3), costColour(0, 0, 1));
});

test('the ends of a ramp hold beyond it', () => {
  const stops = [
    [0, 0, 0],
    [200, 100, 50],
  ] as const;
  assert.deepEqual(ramp(stops, -4), [0, 0, 0]);
  assert.deepEqual(ramp(stops, 0.5), [100, 50, 25]);
  assert.deepEqual(ramp(stops, 9), [200, 100, 50]);
});

test('colours are read from short and long hexadecimal', () => {
  assert.deepEqual(parseHex(' #fa0 '), [255, 170, 0]);
  assert.deepEqual(parseHex('#0c4f74'), [12, 79, 116]);
  assert.throws(() => parseHex('rgb(1 2 3)'), /rgb\(1 2 3\)/);
});

// Jolt Physics beside our scans, wasm against wasm in Node: `peer.mjs FOLDER` reads the inputs that `mapless-bench FOLDER` wrote and
// answers as `mapless-bench` does. FOLDER/jolt has the package.
//
// Jolt keeps heights in 8 bits within blocks of 2 × 2 samples and splits each cell into two triangles. Each ray is a call of its own from
// JavaScript: the binding has none for many rays. The benchmark `calls` is those calls alone, with rays 1 mm long that meet nothing.

import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join, resolve } from 'node:path';
import { createInterface } from 'node:readline';
import { pathToFileURL } from 'node:url';

const folder = resolve(process.argv[2]);
const { resolve: locate } = createRequire(join(folder, 'jolt', 'package.json'));
const { default: start } = await import(pathToFileURL(locate('jolt-physics')));
const version = JSON.parse(readFileSync(locate('jolt-physics/package.json'), 'utf8')).version;
const jolt = await start();

/** Numbers of single precision in a file of the folder. */
function floats(name) {
  const { buffer, byteOffset, byteLength } = readFileSync(join(folder, `${name}.f32`));
  return new Float32Array(buffer.slice(byteOffset, byteOffset + byteLength));
}

/** A world without anything in it. */
function emptyWorld() {
  const settings = new jolt.JoltSettings();
  settings.mMaxWorkerThreads = 0;
  const layers = new jolt.BroadPhaseLayerInterfaceTable(1, 1);
  layers.MapObjectToBroadPhaseLayer(0, new jolt.BroadPhaseLayer(0));
  settings.mObjectLayerPairFilter = new jolt.ObjectLayerPairFilterTable(1);
  settings.mBroadPhaseLayerInterface = layers;
  settings.mObjectVsBroadPhaseLayerFilter = new jolt.ObjectVsBroadPhaseLayerFilterTable(layers, 1, settings.mObjectLayerPairFilter, 1);
  return new jolt.JoltInterface(settings).GetPhysicsSystem().GetBodyInterface();
}

/** The ground `name` as Jolt's shape of a height field. Jolt's y is up; its x and z are our east and north. */
function ground(name, { samples, cell_m }) {
  const settings = new jolt.HeightFieldShapeSettings();
  settings.mSampleCount = samples;
  settings.mScale = new jolt.Vec3(cell_m, 1, cell_m);
  settings.mBlockSize = 2;
  settings.mBitsPerSample = 8;
  settings.mHeightSamples.resize(samples * samples);
  const heights = floats(name);
  jolt.HEAPF32.set(heights, jolt.getPointer(settings.mHeightSamples.data()) / Float32Array.BYTES_PER_ELEMENT);
  const made = settings.Create();
  if (made.HasError()) throw new Error(`${name}: ${made.GetError().c_str()}`);
  const body = new jolt.BodyCreationSettings(made.Get(), new jolt.RVec3(0, 0, 0), new jolt.Quat(0, 0, 0, 1), jolt.EMotionType_Static, 0);
  return emptyWorld().CreateBody(body).GetTransformedShape();
}

/** The first hits of all beams. */
class Scanning {
  #shape;
  #directions = floats('directions');
  #length_m;
  #ray;
  #hit = new jolt.RayCastResult();
  #nothing;
  #ranges_m;

  constructor(name, inputs, length_m) {
    const [x, y, z] = inputs.sensors_m[name];
    this.#shape = ground(name, inputs);
    this.#length_m = length_m;
    this.#ray = new jolt.RRayCast(new jolt.RVec3(x, z, y), new jolt.Vec3(0, 0, 0));
    this.#nothing = this.#hit.mFraction;
    this.#ranges_m = new Float64Array(this.#directions.length / 3);
  }

  run() {
    const direction = this.#ray.mDirection;
    const [directions, length_m, ray, hit] = [this.#directions, this.#length_m, this.#ray, this.#hit];
    for (let beam = 0; beam < this.#ranges_m.length; beam += 1) {
      direction.Set(directions[3 * beam] * length_m, directions[3 * beam + 2] * length_m, directions[3 * beam + 1] * length_m);
      hit.mFraction = this.#nothing;
      this.#shape.CastRay(ray, hit);
      this.#ranges_m[beam] = hit.mFraction * length_m;
    }
  }

  values() {
    return { range_m: [...this.#ranges_m].map((range_m) => (range_m <= this.#length_m ? range_m : null)) };
  }
}

const works = new Map();

/** The piece of work `name`, run once. */
function work(name) {
  if (!works.has(name)) {
    const inputs = JSON.parse(readFileSync(join(folder, 'inputs.json'), 'utf8'));
    const scanning = name === 'calls' ? new Scanning('scan-level-1000', inputs, 1e-3) : new Scanning(name, inputs, inputs.max_range_m);
    scanning.run();
    works.set(name, scanning);
  }
  return works.get(name);
}

function answer(request) {
  const [name, what] = request.split(' ');
  if (name === 'versions') return { versions: { 'jolt-physics': version } };
  if (what === 'values') return { values: work(name).values() };
  const piece = work(name);
  const ms = [];
  for (let repetition = 0; repetition < Number(what); repetition += 1) {
    const begin = performance.now();
    piece.run();
    ms.push(performance.now() - begin);
  }
  return { ms };
}

for await (const request of createInterface({ input: process.stdin })) console.log(JSON.stringify(answer(request)));

/** A run as an MCAP file with the schemas of Foxglove, in JSON. Loaded only when somebody asks for one. */

import { FrameTransform, PointCloud, PoseInFrame } from '@foxglove/schemas/jsonschema';
import { type IWritable, McapWriter } from '@mcap/core';
import { ROW } from '../run/record.ts';
import { type Run, whatWasRun } from './exportedRun.ts';

/** A tick's row as it stands in the record, for plots of any of its numbers. */
const TICK = {
  title: 'mapless.Tick',
  type: 'object',
  properties: Object.fromEntries(ROW.map((name) => [name, { type: 'number' }])),
};

/** `foxglove.PackedElementField` FLOAT32. */
const FLOAT32 = 7;

export async function mcapFile(run: Run): Promise<Blob> {
  const { info, frame, record } = run;
  const file = new Parts();
  const writer = new McapWriter({ writable: file });
  await writer.start({ profile: '', library: 'mapless' });
  const pose = await channel(writer, '/pose', PoseInFrame);
  const transform = await channel(writer, '/tf', FrameTransform);
  const subgoal = await channel(writer, '/subgoal', PoseInFrame);
  const goal = await channel(writer, '/goal', PoseInFrame);
  const points = await channel(writer, '/points', PointCloud);
  const tick = await channel(writer, '/tick', TICK);

  const { x, y, heading_rad = 0 } = info.goal;
  const begin_s = record.length > 0 ? record.get(0, 'time_s') : frame.time_s;
  await goal(begin_s, inWorld(begin_s, { x, y, z: run.goal_z_m }, orientation(0, 0, heading_rad)));
  for (let row = 0; row < record.before(frame.tick); row += 1) {
    const value = (name: (typeof ROW)[number]) => record.get(row, name);
    const time_s = value('time_s');
    const position = { x: value('x'), y: value('y'), z: value('z') };
    const rotation = orientation(value('roll'), value('pitch'), value('yaw'));
    await transform(time_s, {
      timestamp: stamp(time_s),
      parent_frame_id: 'world',
      child_frame_id: 'base_link',
      translation: position,
      rotation,
    });
    await pose(time_s, inWorld(time_s, position, rotation));
    const place = { x: value('subgoal_x'), y: value('subgoal_y'), z: position.z };
    if (!Number.isNaN(place.x)) await subgoal(time_s, inWorld(time_s, place, LEVEL));
    await tick(time_s, Object.fromEntries(ROW.map((name) => [name, finite(value(name))])));
  }
  await points(frame.time_s, {
    timestamp: stamp(frame.time_s),
    frame_id: 'world',
    pose: { position: { x: 0, y: 0, z: 0 }, orientation: LEVEL },
    point_stride: 12,
    fields: ['x', 'y', 'z'].map((name, index) => ({ name, offset: 4 * index, type: FLOAT32 })),
    data: base64(run.points),
  });
  const { changes, changed_at_ticks, experiment, seed, ...what } = whatWasRun(run);
  const { outcome, digest } = frame;
  const lists = { changes: changes.join('; '), changed_at_ticks: changed_at_ticks.join(', ') };
  const metadata = { ...what, seed: String(seed), ...lists, outcome, digest, experiment: JSON.stringify(experiment) };
  await writer.addMetadata({ name: 'mapless', metadata: new Map(Object.entries(metadata)) });
  await writer.end();
  return file.blob();
}

const LEVEL = { x: 0, y: 0, z: 0, w: 1 };

type Vector = { readonly x: number; readonly y: number; readonly z: number };
type Quaternion = Vector & { readonly w: number };

function inWorld(time_s: number, position: Vector, rotation: Quaternion): object {
  return { timestamp: stamp(time_s), frame_id: 'world', pose: { position, orientation: rotation } };
}

/** Yaw about z, then pitch about y (positive nose-up, against the right-hand rule), then roll about x. */
export function orientation(roll: number, pitch: number, yaw: number): Quaternion {
  const [sr, cr] = [Math.sin(roll / 2), Math.cos(roll / 2)];
  const [sp, cp] = [Math.sin(-pitch / 2), Math.cos(-pitch / 2)];
  const [sy, cy] = [Math.sin(yaw / 2), Math.cos(yaw / 2)];
  return {
    x: sr * cp * cy - cr * sp * sy,
    y: cr * sp * cy + sr * cp * sy,
    z: cr * cp * sy - sr * sp * cy,
    w: cr * cp * cy + sr * sp * sy,
  };
}

/** Simulated time: the run begins at zero. */
function stamp(time_s: number): { sec: number; nsec: number } {
  const nanoseconds = nanosecondsOf(time_s);
  return { sec: Number(nanoseconds / 1_000_000_000n), nsec: Number(nanoseconds % 1_000_000_000n) };
}

/** Ticks are whole milliseconds. */
function nanosecondsOf(time_s: number): bigint {
  return BigInt(Math.round(1000 * time_s)) * 1_000_000n;
}

/** JSON has no NaN. */
function finite(value: number): number | null {
  return Number.isFinite(value) ? value : null;
}

function base64(points: Float32Array): string {
  const bytes = new Uint8Array(points.buffer, points.byteOffset, points.byteLength);
  let text = '';
  for (let at = 0; at < bytes.length; at += 0x8000) text += String.fromCharCode(...bytes.subarray(at, at + 0x8000));
  return btoa(text);
}

/** Opens a channel and returns what writes a message to it. */
async function channel(
  writer: McapWriter,
  topic: string,
  schema: { readonly title: string },
): Promise<(time_s: number, message: object) => Promise<void>> {
  const encode = new TextEncoder();
  const schemaId = await writer.registerSchema({
    name: schema.title,
    encoding: 'jsonschema',
    data: encode.encode(JSON.stringify(schema)),
  });
  const channelId = await writer.registerChannel({ schemaId, topic, messageEncoding: 'json', metadata: new Map() });
  let sequence = 0;
  return async (time_s, message) => {
    const logTime = nanosecondsOf(time_s);
    const data = encode.encode(JSON.stringify(message));
    await writer.addMessage({ channelId, sequence: sequence++, logTime, publishTime: logTime, data });
  };
}

/** Collects what the writer writes: it reuses its buffer, so each part is a copy. */
class Parts implements IWritable {
  readonly #parts: Uint8Array<ArrayBuffer>[] = [];
  #length = 0n;

  async write(buffer: Uint8Array): Promise<void> {
    this.#parts.push(new Uint8Array(buffer));
    this.#length += BigInt(buffer.length);
  }

  position(): bigint {
    return this.#length;
  }

  blob(): Blob {
    return new Blob(this.#parts, { type: 'application/octet-stream' });
  }
}

/** The page's end of the worker: requests with answers, events, and a new worker after a panic. */

import { gate } from '../base/gate.ts';
import {
  type Command,
  type Computing,
  type Frame,
  type FrameBuffers,
  type FromSimulation,
  type GroundPatch,
  type Loaded,
  type SessionInfo,
  type Solid,
  type ToSimulation,
  transferables,
} from '../protocol/simulationProtocol.ts';

/** Opening something usually takes a fraction of a second. */
const SLOW_MS = 5000;

export interface SimulationEvents {
  session(info: SessionInfo, loaded: Loaded | undefined): void;
  frame(frame: Frame): void;
  /** It plays no longer, though nobody asked for that. */
  stands(): void;
  ground(patch: GroundPatch, solids: readonly Solid[]): void;
  /** An error that no request is waiting for, or any panic. After a panic the simulation is gone. */
  failure(message: string, panicked: boolean): void;
  /** A decision is being made that may take long; nothing once it is made. */
  computing(what: Computing | undefined): void;
  /** Opening something takes long; then it is open, or refused. */
  slow(): void;
  opened(): void;
}

interface Waiting {
  resolve(value: unknown): void;
  reject(error: Error): void;
}

export class SimulationClient {
  #events: SimulationEvents | undefined;
  /** What happened before anybody listened. */
  #unheard: ((events: SimulationEvents) => void)[] = [];
  readonly #waiting = new Map<number, Waiting>();
  #worker: Worker;
  #nextId = 0;
  #opening: { id: number; timer: ReturnType<typeof setTimeout> } | undefined;
  /** What the worker answers to the command that it was started with. */
  readonly first: Promise<unknown>;
  readonly #started = gate();

  /** Starts the worker with a command that it need not wait for. */
  constructor(first: Command) {
    const id = this.#nextId++;
    this.first = new Promise((resolve, reject) => this.#waiting.set(id, { resolve, reject }));
    // A message to a new worker waits in the page until the page is idle; its name is there at once.
    this.#worker = this.#start(JSON.stringify({ type: 'request', id, command: first } satisfies ToSimulation));
  }

  /** Resolves once the worker runs, or cannot. */
  get started(): Promise<void> {
    return this.#started.passed;
  }

  /** Tells `events` what happens from now on, and first what happened until now. */
  listen(events: SimulationEvents): void {
    this.#events = events;
    for (const tell of this.#unheard.splice(0)) tell(events);
  }

  /** Resolves once the worker has carried the command out, with what it answers, if it does. */
  request<Value = void>(command: Command): Promise<Value> {
    const id = this.#nextId++;
    return new Promise((resolve, reject) => {
      this.#waiting.set(id, { resolve: (value) => resolve(value as Value), reject });
      this.#send({ type: 'request', id, command });
    });
  }

  /** Gives a frame's buffers back; also tells the worker that the page is ready for another frame. */
  recycle(buffers: FrameBuffers): void {
    this.#send({ type: 'recycle', buffers }, transferables(buffers));
  }

  /** Ends the worker whatever it does; a new one takes over, with nothing loaded, and whoever waits is told why. */
  stop(why: string): void {
    this.#worker.onmessage = null;
    this.#worker.terminate();
    this.#worker = this.#start();
    clearTimeout(this.#opening?.timer);
    this.#opening = undefined;
    for (const waiting of this.#waiting.values()) waiting.reject(new Error(why));
    this.#waiting.clear();
  }

  #send(message: ToSimulation, transfer: Transferable[] = []): void {
    this.#worker.postMessage(message, transfer);
  }

  #start(name = ''): Worker {
    const worker = new Worker(new URL('./simulationWorker.ts', import.meta.url), { type: 'module', name });
    worker.onmessage = ({ data }: MessageEvent<FromSimulation>) => {
      if (data.type === 'started') this.#started.open();
      else this.#tell((events) => this.#receive(data, events));
    };
    worker.onerror = (event) => {
      event.preventDefault();
      this.#started.open();
      this.#tell((events) => this.#fail(event.message || 'The simulation could not be loaded.', true, events));
    };
    return worker;
  }

  #tell(what: (events: SimulationEvents) => void): void {
    if (this.#events) what(this.#events);
    else this.#unheard.push(what);
  }

  #receive(message: FromSimulation, events: SimulationEvents): void {
    events.computing(message.type === 'computing' ? message : undefined);
    switch (message.type) {
      case 'session':
        events.session(message.info, message.loaded);
        break;
      case 'frame':
        events.frame(message.frame);
        break;
      case 'stands':
        events.stands();
        break;
      case 'ground':
        events.ground(message.patch, message.solids);
        break;
      case 'opening':
        this.#opening = { id: message.id, timer: setTimeout(() => events.slow(), SLOW_MS) };
        break;
      case 'done':
        this.#endOpening(message.id, events);
        this.#settle(message.id)?.resolve(message.value);
        break;
      case 'failed': {
        this.#endOpening(message.id, events);
        const waiting = message.id === undefined ? undefined : this.#settle(message.id);
        waiting?.reject(new Error(message.message));
        if (message.panicked || !waiting) this.#fail(message.message, message.panicked, events);
        break;
      }
    }
  }

  #settle(id: number): Waiting | undefined {
    const waiting = this.#waiting.get(id);
    this.#waiting.delete(id);
    return waiting;
  }

  #endOpening(id: number | undefined, events: SimulationEvents): void {
    if (!this.#opening || this.#opening.id !== id) return;
    clearTimeout(this.#opening.timer);
    this.#opening = undefined;
    events.opened();
  }

  #fail(message: string, panicked: boolean, events: SimulationEvents): void {
    // A panic leaves the core's memory in an unknown state: only a new worker is trustworthy.
    events.computing(undefined);
    if (panicked) this.stop(message);
    events.failure(message, panicked);
  }
}

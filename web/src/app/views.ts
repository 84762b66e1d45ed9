/** What shows the page's state: told by the app whatever changes. */

import type { Editor } from '../editor/editor.ts';
import type { HeightField } from '../ground/heightField.ts';
import type { Computing, Frame, GroundPatch, SessionInfo, Solid } from '../protocol/simulationProtocol.ts';

export interface Views {
  /** A scenario, goal or start changed; with `field`, the ground is another one. */
  session(info: SessionInfo, field: HeightField | undefined): void;
  frame(frame: Frame): void;
  status(frame: Frame, playing: boolean): void;
  /** The ground was sculpted: these heights are new, and what stands on it stands so. */
  sculpted(patch: GroundPatch, solids: readonly Solid[]): void;
  playing(playing: boolean): void;
  speed(speed: number): void;
  /** Resolves once all is drawn and nothing moves any more. */
  still(): Promise<void>;
  /** Seconds until the next scenario starts by itself, or nothing. */
  countdown(seconds: number | undefined): void;
  /** The experiment, or what can be undone, has changed. */
  experiment(editor: Editor): void;
  notice(message: string): void;
  /** Something that is not wrong, but good to know. */
  news(message: string): void;
  clearNotice(): void;
  /** Whether to drive on from here with what is only tried, or from the start. */
  askHow(): void;
  /** A decision is being made that may take long; nothing once it is made. */
  computing(what: Computing | undefined): void;
  /** Something takes long to open, which can be stopped. */
  slow(stop: () => void): void;
  /** What took long is open, or refused. */
  clearSlow(): void;
}

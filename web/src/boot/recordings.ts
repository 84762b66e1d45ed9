/** A robot's recording in place of the run: loaded when one is opened. The run waits meanwhile as it is. */

import type { App } from '../app/app.ts';
import { byId } from '../base/dom.ts';
import type { HeightField } from '../ground/heightField.ts';
import type { Frame, SessionInfo } from '../protocol/simulationProtocol.ts';
import type { DrivePanel } from '../recorded/drivePanel.ts';
import type { DriveViews, RecordedDrive } from '../recorded/recordedDrive.ts';
import type { TopicsForm } from '../recorded/topicsForm.ts';

/** The panels that a run and a recording share. */
export interface SharedPanels {
  session(info: SessionInfo, field: HeightField | undefined): void;
  surroundings(field: HeightField): void;
  frame(frame: Frame, playing: boolean): void;
  playing(playing: boolean): void;
  speed(speed: number): void;
  notice(message: string): void;
  /** Puts tools down: a recording cannot be changed. */
  letGo(): void;
}

export class Recordings {
  readonly #app: App;
  readonly #panels: SharedPanels;
  readonly #page = byId('app', HTMLElement);
  #drive: RecordedDrive | undefined;
  #panel: DrivePanel | undefined;
  #form: TopicsForm | undefined;
  #newest = 0;

  constructor(app: App, panels: SharedPanels) {
    [this.#app, this.#panels] = [app, panels];
  }

  /** What is open. */
  get drive(): RecordedDrive | undefined {
    return this.#drive;
  }

  /** Rejected if the file is no recording; what was shown before stays then. */
  async open(file: File): Promise<void> {
    this.#newest += 1;
    const number = this.#newest;
    this.#form?.close();
    const [{ RecordedDrive }, { DrivePanel }] = await Promise.all([
      import('../recorded/recordedDrive.ts'),
      import('../recorded/drivePanel.ts'),
    ]);
    const panels = this.#panels;
    let panel: DrivePanel | undefined;
    const views: DriveViews = {
      session: (info, field) => panels.session(info, field),
      surroundings: (field) => panels.surroundings(field),
      frame: (frame, recorded) => {
        panels.frame(frame, this.#drive?.playing ?? false);
        panel?.show(recorded);
      },
      playing: (playing) => panels.playing(playing),
      speed: (speed) => panels.speed(speed),
      news: (past) => panel?.news(past),
      failed: (message) => {
        this.close();
        panels.notice(`${file.name}: ${message}`);
      },
    };
    const drive = await RecordedDrive.open(file, views, async (choices) => {
      const { TopicsForm } = await import('../recorded/topicsForm.ts');
      if (number !== this.#newest) return undefined;
      this.#form = new TopicsForm(file.name, choices);
      return this.#form.chosen;
    });
    if (!drive) return;
    if (number !== this.#newest) {
      drive.close();
      return;
    }
    await this.#app.pause();
    this.#forget();
    panels.letGo();
    const attempt = (action: Promise<void>) => this.#app.attempt(action);
    panel = new DrivePanel(file.name, drive.scene, drive.supervisor, {
      step: (way) => attempt(drive.step(way)),
      nextDifference: () => attempt(drive.nextDifference()),
      seekTime: (time_s) => attempt(drive.seekTime(time_s)),
      putIn: (faults, time_s) => attempt(drive.putIn(faults, time_s)),
      close: () => this.close(),
    });
    [this.#drive, this.#panel] = [drive, panel];
    panel.news(drive.past);
    this.#page.toggleAttribute('data-recorded', true);
    await drive.setSpeed(1);
    await drive.begin();
  }

  /** Goes back to the run. */
  close(): void {
    this.#form?.close();
    if (!this.#drive) return;
    this.#forget();
    this.#page.removeAttribute('data-recorded');
    const { info, frame, field } = this.#app;
    this.#panels.speed(this.#app.speed);
    this.#panels.playing(false);
    if (!info || !frame) return;
    this.#panels.session(info, field);
    this.#panels.frame({ ...frame, ...this.#app.record.trailTo(frame.tick), anew: true }, false);
  }

  #forget(): void {
    this.#drive?.close();
    this.#panel?.remove();
    [this.#drive, this.#panel] = [undefined, undefined];
  }
}

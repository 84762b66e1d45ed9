/** The measurements of a run: the six metrics beside the paper's, plots over time, times, digest, and its files. */

import { byId, setText } from '../base/dom.ts';
import type { Editor } from '../editor/editor.ts';
import { changesOf } from '../experiment/changes.ts';
import type { Place } from '../experiment/place.ts';
import { ExportButtons } from '../export/exportButtons.ts';
import type { Run } from '../export/exportedRun.ts';
import type { Filmed } from '../export/film.ts';
import { TimePlots } from '../plots/timePlots.ts';
import { type Frame, isDisturbed, type SessionInfo } from '../protocol/simulationProtocol.ts';
import type { Published } from '../run/published.ts';
import type { RunRecord } from '../run/record.ts';
import { MetricsPanel } from './metrics.ts';
import { TimingPanel } from './timing.ts';

/** How long a button says that it has done its work. */
const THANKS_MS = 1600;

export interface MeasureOptions {
  readonly record: RunRecord;
  readonly view: Filmed | undefined;
  /** What is run, and the scenario that it is named after. */
  readonly editor: Pick<Editor, 'experiment' | 'scenario'>;
  heightAt(place: Place): number | undefined;
  /** Takes the run to another time. */
  go(time_s: number): Promise<void>;
  notice(message: string): void;
}

export class Measure {
  readonly #plots: TimePlots;
  readonly #metrics = new MetricsPanel(byId('metrics', HTMLElement));
  readonly #timing = new TimingPanel();
  readonly #record: RunRecord;
  readonly #editor: MeasureOptions['editor'];
  readonly #heightAt: MeasureOptions['heightAt'];
  #info: SessionInfo | undefined;
  #frame: Frame | undefined;
  #paper: Published | undefined;
  #shownPaper: Published | undefined;

  constructor({ record, view, go, notice, editor, heightAt }: MeasureOptions) {
    this.#record = record;
    this.#editor = editor;
    this.#heightAt = heightAt;
    this.#plots = new TimePlots(record, go);
    byId('plots', HTMLElement).append(this.#plots.element);
    this.#enlarges();
    this.#copiesDigest(notice);
    new ExportButtons({ run: () => this.#run(), plots: (words) => this.#plots.file(words), view, notice });
  }

  session(info: SessionInfo): void {
    this.#info = info;
    this.#plots.session(info);
  }

  /** What the paper reports for the course that is driven; nothing for any other. */
  paper(paper: Published | undefined): void {
    this.#paper = paper;
    this.#showPaper();
  }

  frame(frame: Frame): void {
    this.#frame = frame;
    this.#showPaper();
    this.#metrics.show(frame.metrics);
    this.#timing.show(this.#record);
    this.#plots.update(frame);
  }

  /** A run that was changed under way is another one, also where everything is as it was again. */
  #showPaper(): void {
    const paper = this.#frame && isDisturbed(this.#frame.timeline) ? undefined : this.#paper;
    if (paper === this.#shownPaper) return;
    this.#shownPaper = paper;
    this.#metrics.paper(paper);
    this.#plots.paper(paper);
  }

  #run(): Run | undefined {
    const [info, frame] = [this.#info, this.#frame];
    const { experiment, scenario } = this.#editor;
    if (!info || !frame || !experiment) return undefined;
    return {
      info,
      frame,
      record: this.#record.copy(),
      points: frame.buffers.points.slice(0, 3 * frame.returns),
      experiment,
      changes: changesOf(experiment, scenario),
      goal_z_m: this.#heightAt(info.goal) ?? 0,
    };
  }

  /** The plots move into a sheet of the whole window, and back. */
  #enlarges(): void {
    const sheet = byId('plots-sheet', HTMLDialogElement);
    const large = byId('plots-large', HTMLElement);
    byId('plots-enlarge', HTMLButtonElement).addEventListener('click', () => {
      large.append(this.#plots.element);
      sheet.showModal();
    });
    sheet.addEventListener('close', () => byId('plots', HTMLElement).append(this.#plots.element));
  }

  #copiesDigest(notice: (message: string) => void): void {
    const button = byId('copy-digest', HTMLButtonElement);
    button.addEventListener('click', async () => {
      try {
        await navigator.clipboard.writeText(byId('digest', HTMLElement).textContent ?? '');
        setText(button, 'Copied');
        setTimeout(() => setText(button, 'Copy'), THANKS_MS);
      } catch {
        notice('The browser did not let the page write to the clipboard; select the digest and copy it.');
      }
    });
  }
}

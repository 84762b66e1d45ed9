/** The buttons that download a run: as numbers, as pictures, as a film. */

import { byId, setText } from '../base/dom.ts';
import { messageOf } from '../base/messageOf.ts';
import { download } from '../files/download.ts';
import { fileName, type Run, runJson, runWords, trajectoryCsv, whatWasRun } from './exportedRun.ts';
import { Camera, canFilm, type Filmed } from './film.ts';

export interface Source {
  /** Nothing until the first scenario is loaded. */
  run(): Run | undefined;
  /** The plots over time, as SVG, with what was run beneath. */
  plots(words: readonly string[]): string;
  /** Without WebGL there is no view to picture. */
  readonly view: Filmed | undefined;
  notice(message: string): void;
}

export class ExportButtons {
  readonly #source: Source;
  readonly #film = byId('save-film', HTMLButtonElement);
  readonly #camera: Camera | undefined;

  constructor(source: Source) {
    this.#source = source;
    this.#camera = source.view ? new Camera(source.view) : undefined;
    this.#on('save-csv', 'trajectory.csv', (run) => text(trajectoryCsv(run), 'text/csv'));
    this.#on('save-json', 'result.json', (run) => text(runJson(run), 'application/json'));
    this.#on('save-mcap', 'run.mcap', async (run) => (await import('./mcap.ts')).mcapFile(run));
    this.#on('save-plots', 'plots.svg', (run) => text(source.plots(runWords(run)), 'image/svg+xml'));
    this.#on('save-picture', 'view.png', () => this.#camera?.picture());
    this.#film.addEventListener('click', () => this.#toggleFilm());
    byId('save-picture', HTMLButtonElement).disabled = !this.#camera;
    if (this.#camera && canFilm()) return;
    this.#film.disabled = true;
    this.#film.title = 'This browser records no WebM video.';
  }

  #on(id: string, what: string, make: (run: Run) => Blob | undefined | Promise<Blob | undefined>): void {
    const button = byId(id, HTMLButtonElement);
    button.addEventListener('click', async () => {
      const run = this.#source.run();
      if (!run) return;
      button.disabled = true;
      try {
        const blob = await make(run);
        if (blob) download(fileName(run, what), blob);
        // A table of numbers has no place for what was run.
        if (id === 'save-csv') download(fileName(run, 'trajectory.run.json'), runFile(run));
        if (run.record.cut) {
          this.#source.notice(
            `The run is longer than its record: the files begin at tick ${run.record.get(0, 'tick')}.`,
          );
        }
      } catch (error) {
        this.#source.notice(`${fileName(run, what)} could not be made: ${messageOf(error)}`);
      } finally {
        button.disabled = false;
      }
    });
  }

  async #toggleFilm(): Promise<void> {
    const camera = this.#camera;
    const run = this.#source.run();
    if (!camera || !run) return;
    if (camera.filming) {
      camera.stop();
      return;
    }
    this.#showFilm(true, 'Film begins…');
    try {
      const film = await camera.film(() => this.#showFilm(true, 'Stop the film'));
      download(fileName(run, 'film.webm'), film);
    } catch (error) {
      this.#source.notice(`The film could not be made: ${messageOf(error)}`);
    } finally {
      this.#showFilm(false, 'Film (WebM)');
    }
  }

  #showFilm(filming: boolean, words: string): void {
    setText(this.#film, words);
    this.#film.setAttribute('aria-pressed', String(filming));
  }
}

function runFile(run: Run): Blob {
  const { time_s: sim_time_s, digest } = run.frame;
  return text(`${JSON.stringify({ ...whatWasRun(run), sim_time_s, digest }, null, 2)}\n`, 'application/json');
}

function text(content: string, type: string): Blob {
  return new Blob([content], { type });
}

/** What is said of an open recording beside the panels of a run: the supervisor, the command, what differs, and what is wrong with the file. */

import '../style/recorded.css';
import { button, byId, html, setText } from '../base/dom.ts';
import { clock, degrees, fixed } from '../base/format.ts';
import { stateWords } from './recordedFrame.ts';
import type { RecordedPast } from './recordedPast.ts';
import type { RecordedFrame, RecordedScene, SupervisorInfo } from './recordedProtocol.ts';
import { SupervisorPanel } from './supervisorPanel.ts';

/** Changes that are listed; a drive has a handful. */
const MOST_CHANGES = 200;

export interface DriveActions {
  step(way: 1 | -1): void;
  nextDifference(): void;
  seekTime(time_s: number): void;
  /** Decides everything anew with faults, as `no_scan@1.5+0.4`, and shows a moment of that. */
  putIn(faults: readonly string[], time_s: number): void;
  close(): void;
}

export class DrivePanel {
  readonly #scene: RecordedScene;
  readonly #bar = html('div', 'drive-bar');
  readonly #section = html('section', 'drive');
  readonly #state = html('dd');
  readonly #command = html('dd');
  readonly #scan = html('dd');
  readonly #differs = html('p', 'drive-differs');
  readonly #counted = html('p', 'section-note');
  readonly #notes = html('ul', 'drive-notes');
  readonly #changes = html('ol', 'drive-changes');
  readonly #next: HTMLButtonElement;
  readonly #seekTime: (time_s: number) => void;
  readonly #supervisor: SupervisorPanel;
  #past: RecordedPast | undefined;
  #listed = 0;

  constructor(name: string, scene: RecordedScene, supervisor: SupervisorInfo, actions: DriveActions) {
    this.#scene = scene;
    this.#seekTime = actions.seekTime;
    this.#bar.append(html('span', 'drive-name', [name]), button('filled', 'Close the recording', actions.close));
    byId('what-if', HTMLElement).before(this.#bar);
    const title = html('h2', '', ['Recording']);
    title.id = 'drive-title';
    this.#section.setAttribute('aria-labelledby', title.id);
    this.#differs.setAttribute('role', 'status');
    this.#next = button('plain', 'Next difference', actions.nextDifference);
    this.#next.hidden = true;
    this.#section.append(
      html('div', 'section-head', [title, this.#counted]),
      html('dl', 'drive-now', [
        ...line('Supervisor', this.#state),
        ...line('Command', this.#command),
        ...line('Scan', this.#scan),
      ]),
      html('div', 'row', [
        button('plain', '‹ Scan', () => actions.step(-1)),
        button('plain', 'Scan ›', () => actions.step(1)),
        this.#next,
      ]),
      this.#differs,
      this.#notes,
      this.#changes,
    );
    const [back, on] = this.#section.querySelectorAll('button');
    back?.setAttribute('aria-label', 'To the scan before');
    on?.setAttribute('aria-label', 'To the next scan');
    this.#supervisor = new SupervisorPanel(supervisor, actions.putIn);
    document.querySelector('.panel .status')?.after(this.#section, this.#supervisor.section);
  }

  remove(): void {
    this.#bar.remove();
    this.#section.remove();
    this.#supervisor.section.remove();
  }

  show(recorded: RecordedFrame): void {
    const { command, scan_age_s, activity, differences } = recorded;
    this.#supervisor.show(recorded);
    setText(this.#state, stateWords(recorded));
    const turn = `${degrees(command.omega_rad_s, 1)}/s`;
    setText(this.#command, `${fixed(command.v_m_s, 2)} m/s, ${turn}`);
    const age = scan_age_s === undefined ? 'none yet' : `${fixed(scan_age_s, 2)} s old`;
    setText(
      this.#scan,
      activity ? `${age}, decided on` : `${age}${scan_age_s === undefined ? '' : ', not asked about'}`,
    );
    this.#differs.hidden = differences.length === 0;
    setText(this.#differs, differences.length > 0 ? `Differs from the recording. ${differences.join('. ')}` : '');
  }

  news(past: RecordedPast): void {
    const { decided } = past;
    if (!decided) return;
    if (past !== this.#past) {
      [this.#past, this.#listed] = [past, 0];
      this.#changes.replaceChildren();
    }
    const share = decided.end_s > 0 ? Math.min(decided.until_s / decided.end_s, 1) : 1;
    const differ = decided.different_answers + decided.different_ticks;
    const judged = this.#scene.has_decisions
      ? `${differ === 0 ? 'none' : differ} of the decisions differ${differ === 1 ? 's' : ''}`
      : 'decided by this page alone';
    setText(this.#counted, decided.has_ended ? judged : `decided again up to ${Math.floor(100 * share)} %`);
    this.#next.hidden = past.differences_s.length === 0;
    this.#note(past);
    for (const { at_s, text } of past.changes.slice(this.#listed, MOST_CHANGES)) {
      const go = button('plain', `${clock(at_s)} ${text}`, () => this.#seekTime(at_s));
      this.#changes.append(html('li', '', [go]));
    }
    this.#listed = past.changes.length;
  }

  #note({ decided }: RecordedPast): void {
    if (!decided) return;
    const { fault, is_cut, has_ended, lost, goals, complaints, answers } = decided;
    const notes: string[] = [];
    if (fault) notes.push(`The file cannot be read any further. ${fault}`);
    if (is_cut) notes.push(`The file is cut off: it ends within a record, at ${clock(decided.until_s)}.`);
    if (lost > 0) notes.push(`${lost} entries could not be recorded; decisions after them may differ.`);
    if (has_ended && !this.#scene.has_decisions && goals === 0)
      notes.push('There is no goal in it, so nothing is decided.');
    else if (has_ended && answers === 0) notes.push('The planner was never asked.');
    for (const [what, count, last] of complaints) notes.push(`${what}: ${last}${count > 1 ? ` (${count} times)` : ''}`);
    if (this.#notes.textContent !== notes.join('')) {
      this.#notes.replaceChildren(...notes.map((note) => html('li', '', [note])));
    }
  }
}

function line(name: string, value: HTMLElement): HTMLElement[] {
  return [html('dt', '', [name]), value];
}

/** Asks which topics of a recording are meant where several have one type. Loaded when a recording is opened that needs it. */

import '../style/recorded.css';
import { button, html } from '../base/dom.ts';
import type { TopicChoice, Topics } from './recordedProtocol.ts';

const ROLE_WORDS: Record<string, string> = {
  scan: 'Scan',
  odometry: 'Odometry',
  imu: 'IMU',
  emergency_stop: 'Emergency stop',
  reset: 'Reset',
  goal_pose: 'Goal',
  clock: 'Clock',
};

/** Stands where the panel of a drive would. */
export class TopicsForm {
  /** What was chosen; nothing where that is called off. */
  readonly chosen: Promise<Topics | undefined>;
  readonly #section = html('section', 'drive');
  /** A phone scrolls down to the form, and back. */
  readonly #scrolled = scrollY;
  #answer: (topics?: Topics) => void = () => {};

  constructor(name: string, choices: readonly TopicChoice[]) {
    this.chosen = new Promise((resolve) => {
      this.#answer = resolve;
    });
    const title = html('h2', '', ['Which topics?']);
    title.id = 'topics-title';
    this.#section.setAttribute('aria-labelledby', title.id);
    const fields = choices.map(({ role, schema, candidates }) => {
      const select = html('select');
      select.name = role;
      for (const { topic, messages } of candidates) {
        const count = messages === undefined ? '' : ` (${messages} message${messages === 1 ? '' : 's'})`;
        select.append(new Option(topic + count, topic));
      }
      const words = html('span', '', [html('b', '', [ROLE_WORDS[role] ?? role]), ` ${schema.replace('/msg/', '/')}`]);
      return html('label', 'field', [words, select]);
    });
    const form = html('form', 'drive-topics', [
      ...fields,
      html('div', 'row', [html('button', 'filled', ['Open']), button('plain', 'Cancel', () => this.close())]),
    ]);
    form.addEventListener('submit', (event) => {
      event.preventDefault();
      const selects = form.querySelectorAll('select');
      this.close(Object.fromEntries(Array.from(selects, ({ name, value }) => [name, value])));
    });
    form.addEventListener('keydown', (event) => {
      if (event.key !== 'Escape') return;
      event.preventDefault();
      this.close();
    });
    const words = `Several topics in ${name} have the same type. Choose those to open it with.`;
    this.#section.append(title, html('p', 'drive-notes', [words]), form);
    document.querySelector('.panel .status')?.after(this.#section);
    this.#section.scrollIntoView({ block: 'nearest' });
    form.querySelector('select')?.focus({ preventScroll: true });
  }

  /** Once it is closed, nothing. */
  close(topics?: Topics): void {
    if (!this.#section.isConnected) return;
    this.#section.remove();
    scrollTo(scrollX, this.#scrolled);
    this.#answer(topics);
  }
}

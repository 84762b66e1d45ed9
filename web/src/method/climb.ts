/** Learning, step by step: the bound climbs, and the skyline is shown that each step gives. */

import { button, html, setText } from '../base/dom.ts';
import { fixed, grouped } from '../base/format.ts';
import type { Hyperparameters } from '../experiment/hyperparameters.ts';
import type { ClimbStep } from '../protocol/simulationProtocol.ts';

interface Host {
  begin(): Promise<readonly ClimbStep[]>;
  move(values: Partial<Hyperparameters>): void;
  set(values: Partial<Hyperparameters>): void;
  /** Begins the run anew with what is set, and has a ghost with fixed values drive beside it. */
  drive(): void;
  failed(error: unknown): void;
}

export class Climb {
  readonly button = button('plain', 'Learned…', () => void this.#toggle());
  readonly element = html('div', 'method-climb');
  readonly #host: Host;
  readonly #step = html('input');
  readonly #said = html('p', 'method-climb-said');
  readonly #drive = button('plain', 'Drive with these', () => this.#host.drive());
  readonly #bars = html('div', 'method-bars');
  #steps: readonly ClimbStep[] = [];

  constructor(host: Host) {
    this.#host = host;
    this.button.title = 'Learns from this scan as the paper does, with nothing to hold the values: they run away';
    this.button.setAttribute('aria-expanded', 'false');
    Object.assign(this.#step, { type: 'range', min: '0', step: '1' });
    this.#step.setAttribute('aria-label', 'Step of learning');
    this.#step.addEventListener('input', () => this.#show((values) => host.move(values)));
    this.#step.addEventListener('change', () => this.#show((values) => host.set(values)));
    this.#said.setAttribute('role', 'status');
    this.#bars.setAttribute('aria-hidden', 'true');
    this.#drive.title = 'From the start, beside a ghost with fixed values: see what they do to a drive';
    this.element.append(this.#bars, this.#step, html('div', 'method-climb-foot', [this.#said, this.#drive]));
    this.element.hidden = true;
  }

  /** Other values hold than those of a step. */
  close(): void {
    this.#open(false);
  }

  #open(open: boolean): void {
    this.button.setAttribute('aria-expanded', String(open));
    this.element.hidden = !open;
  }

  async #toggle(): Promise<void> {
    const open = this.element.hidden !== false;
    this.#open(open);
    if (!open) return;
    try {
      this.#steps = await this.#host.begin();
    } catch (error) {
      this.#open(false);
      this.#host.failed(error);
      return;
    }
    const last = this.#steps.length - 1;
    this.#step.max = String(last);
    this.#step.value = String(last);
    const bounds = this.#steps.map(({ bound }) => bound);
    const [lowest, highest] = [Math.min(...bounds), Math.max(...bounds)];
    this.#bars.replaceChildren(
      ...bounds.map((bound) => {
        const bar = html('i');
        bar.style.height = `${10 + (90 * (bound - lowest)) / Math.max(highest - lowest, 1e-9)}%`;
        return bar;
      }),
    );
    this.#show((values) => this.#host.set(values));
    // On a phone the image stands right above.
    this.element.scrollIntoView({ block: 'end' });
  }

  #show(tell: (values: Partial<Hyperparameters>) => void): void {
    const at = Number(this.#step.value);
    const step = this.#steps[at];
    if (!step) return;
    const [azimuth_rad, elevation_rad] = step.length_scales_rad.map(rounded) as [number, number];
    Array.from(this.#bars.children).forEach((bar, index) => {
      bar.classList.toggle('is-now', index === at);
    });
    const bound = `${step.bound < 0 ? '\u2212' : ''}${grouped(Math.round(Math.abs(step.bound)))}`;
    setText(
      this.#said,
      `Step ${at} of ${this.#steps.length - 1}: bound ${bound} nats, σ² ${fixed(step.variance_m2, 1)} m²`,
    );
    tell({
      azimuth_rad,
      elevation_rad,
      variance_m2: rounded(step.variance_m2),
      alpha: rounded(step.alpha),
      noise_m2: rounded(step.noise_variance_m2),
    });
  }
}

function rounded(value: number): number {
  return Number(value.toPrecision(3));
}

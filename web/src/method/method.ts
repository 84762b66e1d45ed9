/**
 * The Gaussian process by hand: its threshold, kernel, noise and inducing inputs are changed where the robot stands, and
 * the skyline follows. One azimuth is unrolled beside the image; the kernel and the climb of the bound can be seen.
 */

import '../style/method.css';
import type { App } from '../app/app.ts';
import { button, html, setText } from '../base/dom.ts';
import { degrees, fixed, wrap } from '../base/format.ts';
import { messageOf } from '../base/messageOf.ts';
import { Newest } from '../base/newest.ts';
import { readTheme, type Theme } from '../colours/theme.ts';
import {
  type Hyperparameters,
  hyperparametersOf,
  withHyperparameters,
  withoutHyperparameters,
  withPaperProcess,
} from '../experiment/hyperparameters.ts';
import type { Overrides } from '../experiment/overrides.ts';
import type { Plot } from '../inspector/imagePlot.ts';
import { azimuthOf, columnOf, rowOf } from '../inspector/lattice.ts';
import { perceptionFault } from '../inspector/reason.ts';
import type { VarianceImage } from '../inspector/varianceImage.ts';
import type { Frame, SessionInfo } from '../protocol/simulationProtocol.ts';
import { Climb } from './climb.ts';
import { InducingInputs } from './inducingInputs.ts';
import { Knobs } from './knobs.ts';
import { errorWords, skylineError } from './skylineError.ts';
import { drawSlice } from './slice.ts';
import { ThresholdHandle } from './thresholdHandle.ts';

/** What helps where the process has no solution. */
const REMEDY = 'the noise is too small for this kernel. Press Default, or As it was.';

export class Method {
  readonly #app: App;
  readonly #image: VarianceImage;
  readonly #canvas: HTMLCanvasElement;
  readonly #element = html('section', 'method');
  readonly #slice = html('canvas', 'slice-canvas');
  readonly #azimuth = html('input');
  readonly #azimuthSaid = html('output');
  readonly #error = html('p', 'method-error');
  readonly #kernel = html('input');
  readonly #knobs = new Knobs(
    (values) => this.#move(values),
    (values) => this.#set(values),
  );
  readonly #handle: ThresholdHandle;
  readonly #inputs: InducingInputs;
  readonly #climb: Climb;
  readonly #newest = new Newest();
  #theme = readTheme();
  #info: SessionInfo | undefined;
  #frame: Frame | undefined;
  /** The column that the slice goes through, and the row that was pointed at. */
  #column = 180;
  #row = 15;
  #open = false;

  /** `seen` is the section of the image, `canvas` the image in it; `besideFixed` has a ghost with fixed values drive. */
  constructor(
    app: App,
    image: VarianceImage,
    seen: HTMLElement,
    canvas: HTMLCanvasElement,
    besideFixed: () => Promise<void>,
  ) {
    this.#app = app;
    this.#image = image;
    this.#canvas = canvas;
    this.#handle = new ThresholdHandle(
      (threshold) => this.#move({ threshold }),
      (threshold) => this.#set({ threshold }),
    );
    canvas.parentElement?.append(this.#handle.element);
    this.#inputs = new InducingInputs({
      look: (question) => app.insight.lookInside(question),
      changed: () => this.#showInside(),
      pause: () => app.pause(),
      failed: (error) => app.attempt(Promise.reject(unsolved(error))),
    });
    this.#climb = new Climb({
      begin: async () => {
        await app.pause();
        return app.insight.climb();
      },
      move: (values) => this.#move(values),
      set: (values) => this.#set(values),
      drive: () =>
        this.#newest.do(async () => {
          app.touch();
          await app.attempt(app.runTried());
          await app.attempt(besideFixed());
        }),
      failed: (error) => app.attempt(Promise.reject(unsolved(error))),
    });
    this.#build();
    seen.append(this.#element);
    this.#element.hidden = true;
    new ResizeObserver(() => this.#drawSlice()).observe(this.#slice);
    image.onDrawn((plot) => this.#handle.place(plot, this.#frame?.threshold, this.#newest.busy));
    canvas.addEventListener('pointermove', (event) => {
      if (event.pointerType === 'mouse' && event.buttons === 0) this.#point(event);
    });
    canvas.addEventListener('click', (event) => {
      this.#point(event);
      if (this.#open) this.#inputs.pressed(this.#column, this.#row);
    });
    if (app.info) this.session(app.info);
    if (app.frame) this.frame(app.frame);
  }

  get isOpen(): boolean {
    return this.#open;
  }

  show(open: boolean): void {
    this.#open = open;
    this.#element.hidden = !open;
    if (!open) {
      this.#inputs.reset();
      this.#kernel.checked = false;
    }
    this.#image.drawOver(open ? (context, plot, theme) => this.#drawOver(context, plot, theme) : undefined);
    this.#app.attempt(this.#app.insight.showTruth(open));
    if (open && this.#frame) this.frame(this.#frame);
    else this.#showInside();
  }

  theme(theme: Theme): void {
    this.#theme = theme;
    this.#drawSlice();
  }

  session(info: SessionInfo): void {
    this.#info = info;
    this.#azimuth.max = String(info.image.columns / 2 - 1);
    this.#azimuth.min = String(-info.image.columns / 2);
    this.#knobs.show(hyperparametersOf(info), this.#newest.busy);
  }

  frame(frame: Frame): void {
    this.#frame = frame;
    if (!this.#open) return;
    const { tick, thought, returns } = frame;
    this.#inputs.scanned(this.#app.playing, JSON.stringify([tick, thought, returns, this.#info?.overrides]));
    this.#showInside();
  }

  #build(): void {
    const presets: [string, string, (overrides: Overrides) => Overrides][] = [
      ['Default', 'The values of this project, chosen on recorded truth', withoutHyperparameters],
      ['Paper’s', 'V_th 0.70, one length-scale of 2°, little noise, farthest points', withPaperProcess],
    ];
    const buttons = presets.map(([name, title, change]) => {
      const made = button('plain', name, () => {
        const { info } = this.#app;
        this.#climb.close();
        if (info) this.#adjust(change(info.overrides));
      });
      made.title = title;
      return made;
    });
    Object.assign(this.#azimuth, { type: 'range', step: '1', value: '0' });
    this.#azimuth.setAttribute('aria-label', 'Azimuth of the slice');
    this.#azimuth.addEventListener('input', () => {
      // To the left is to the left, as in the image.
      this.#cut(columnOf((-Number(this.#azimuth.value) * Math.PI) / 180, this.#info?.image.columns ?? 360));
    });
    this.#slice.setAttribute('role', 'img');
    Object.assign(this.#kernel, { type: 'checkbox' });
    this.#kernel.addEventListener('change', () => this.#showInside());
    this.#error.setAttribute('role', 'status');
    const group = html('div', 'method-presets', [...buttons, this.#climb.button]);
    group.setAttribute('role', 'group');
    group.setAttribute('aria-label', 'Values to begin with');
    const kernel = html('label', 'method-check', [this.#kernel, 'kernel k(·, pointer) in the image']);
    const equations = html('details', 'method-equations', [
      html('summary', '', ['Equations']),
      html('p', '', ['k(z, z′) = σ² (1 + r² / 2α)^−α,  r² = Σ ((z − z′) / ℓ)²  over azimuth and elevation']),
      html('p', '', ['variance v = k** − k*ᵤ Kᵤᵤ⁻¹ kᵤ* + k*ᵤ (Kᵤᵤ + Kᵤf Kfᵤ / σₙ²)⁻¹ kᵤ*']),
      html('p', '', ['mean = k*ᵤ (Kᵤᵤ + Kᵤf Kfᵤ / σₙ²)⁻¹ Kᵤf y / σₙ²,  y = r − range,  r the radius of the occupancy']),
      html('p', '', ['Free where v / σ² > V_th: no return is near, so nothing has lowered the prior variance.']),
    ]);
    equations.addEventListener('toggle', () => equations.scrollIntoView({ block: 'nearest' }));
    const slice = html('div', 'method-slice', [
      html('div', 'method-slice-head', [html('h3', '', ['One azimuth']), this.#azimuthSaid]),
      this.#slice,
      this.#azimuth,
    ]);
    const hand = html('div', 'method-hand', [
      group,
      this.#climb.element,
      this.#knobs.element,
      this.#inputs.element,
      kernel,
      this.#error,
      equations,
    ]);
    this.#element.setAttribute('aria-label', 'The Gaussian process by hand');
    this.#element.append(slice, hand);
  }

  /** While a slider is dragged: the answer comes at once, and holds no longer than that. */
  #move(values: Partial<Hyperparameters>): void {
    this.#newest.do(async () => {
      await this.#app.pause();
      const { info } = this.#app;
      if (info) await this.#app.tryOut(withHyperparameters(info.overrides, values, info)).catch(() => undefined);
    });
  }

  #set(values: Partial<Hyperparameters>): void {
    const { info } = this.#app;
    if (info) this.#adjust(withHyperparameters(info.overrides, values, info));
  }

  #adjust(overrides: Overrides): void {
    this.#newest.do(async () => {
      this.#app.touch();
      await this.#app.pause();
      await this.#app.attempt(this.#app.adjust({ overrides }));
    });
  }

  /** Somebody points at the image: the slice goes through there. */
  #point({ clientX, clientY }: MouseEvent): void {
    if (!this.#open || !this.#info) return;
    const box = this.#canvas.getBoundingClientRect();
    const at = this.#image.directionAt(clientX - box.left, clientY - box.top);
    if (!at) return;
    this.#row = at.row;
    this.#cut(columnOf(at.azimuth_rad, this.#info.image.columns));
  }

  #cut(column: number): void {
    this.#column = column;
    if (this.#kernel.checked) this.#showInside();
    this.#drawSlice();
    this.#image.again();
  }

  /** What the image shows in place of the planner's own variance. */
  #showInside(): void {
    const [info, frame] = [this.#info, this.#frame];
    if (!info || !frame) return;
    if (this.#open && this.#kernel.checked) {
      const [column, row] = [this.#column, this.#row];
      this.#newest.do(async () => {
        const covariances = await this.#app.insight.kernelFrom(column, row);
        if (!this.#kernel.checked) return;
        this.#image.showInstead({ values: covariances.map((value) => 1 - value), profile: undefined });
      });
    } else {
      const { inside } = this.#inputs;
      this.#image.showInstead(
        this.#open && inside && this.#inputs.isOwn === false
          ? { values: inside.variance, profile: inside.profile }
          : undefined,
      );
    }
    this.#sayError(info, frame);
    this.#drawSlice();
    this.#image.again();
  }

  #sayError({ occupancy_radius_m }: SessionInfo, frame: Frame): void {
    const { buffers, thought } = frame;
    const { truth } = buffers;
    const fault = perceptionFault(frame);
    if (fault) {
      setText(this.#error, `No skyline: ${helpWith(fault)}`);
      return;
    }
    const profile = (this.#inputs.isOwn === false && this.#inputs.inside?.profile) || buffers.profile;
    const now = skylineError(profile, truth);
    const before = thought === 'what_if' ? skylineError(buffers.former, truth) : undefined;
    const words = now ? `Off the true skyline by ${errorWords(now, occupancy_radius_m)}` : '';
    setText(
      this.#error,
      !now
        ? truth.some((elevation_rad) => !Number.isNaN(elevation_rad))
          ? 'No skyline: nowhere does the variance cross V_th.'
          : 'Pause to compare with the true skyline.'
        : before
          ? `${words}; the run’s: ${errorWords(before, occupancy_radius_m)}.`
          : `${words}.`,
    );
  }

  #drawSlice(): void {
    const [info, frame] = [this.#info, this.#frame];
    if (!this.#open || !info || !frame) return;
    const columns = info.image.columns;
    const azimuth_rad = wrap(azimuthOf(this.#column, columns));
    const deg = Math.round((azimuth_rad * 180) / Math.PI);
    this.#azimuth.value = String(-deg);
    const where = deg === 0 ? 'ahead' : `${Math.abs(deg)}° ${deg > 0 ? 'left' : 'right'}`;
    setText(this.#azimuthSaid, where);
    this.#azimuth.setAttribute('aria-valuetext', where);
    const inside = this.#inputs.isOwn === false ? this.#inputs.inside : undefined;
    const { occupancy, variance, profile } = inside ?? frame.buffers;
    const surfaces = { occupancy, variance, profile, inducing: this.#inputs.list };
    drawSlice(
      this.#slice,
      info,
      frame,
      surfaces,
      this.#column,
      Math.sqrt(hyperparametersOf(info).variance_m2),
      this.#theme,
    );
    const skyline = profile[this.#column] ?? Number.NaN;
    this.#inputs.lookAt(this.#column, rowOf(Number.isNaN(skyline) ? 0 : skyline, info.image.rows));
    this.#slice.setAttribute(
      'aria-label',
      `Slice ${where}: ${Number.isNaN(skyline) ? 'no skyline' : `skyline at ${degrees(skyline, 1)}`}, V_th ${fixed(frame.threshold, 2)}`,
    );
  }

  #drawOver(context: CanvasRenderingContext2D, plot: Plot, theme: Theme): void {
    const { info } = this.#app;
    if (!info) return;
    this.#inputs.draw(context, plot, info.image, theme);
    const x = plot.x(wrap(azimuthOf(this.#column, info.image.columns)));
    context.strokeStyle = `rgb(${theme.accent.join(' ')})`;
    context.lineWidth = 1.5;
    context.beginPath();
    context.moveTo(x, plot.top);
    context.lineTo(x, plot.top + plot.height);
    context.stroke();
  }
}

/** What to do where the process has no solution; the core's own words for anything else. */
function helpWith(why: string): string {
  return why.includes('positive definite') ? REMEDY : `${why}.`;
}

/** As it is said over the view. */
function unsolved(error: unknown): Error {
  const why = messageOf(error);
  const help = helpWith(why);
  return new Error(help === REMEDY ? `The Gaussian process has no solution: ${REMEDY} (${why})` : why);
}

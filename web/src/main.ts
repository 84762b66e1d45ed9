/** Puts the page together. */

import './style/tokens.css';
import './style/layout.css';
import './style/controls.css';
import './style/panels.css';
import './style/thinking.css';
import { publish } from './api.ts';
import { App } from './app.ts';
import { CATALOGUE, entry, following } from './core/catalogue.ts';
import { AttitudeInstrument, PITCH, ROLL } from './panel/attitude.ts';
import { DecisionPanel } from './panel/decision.ts';
import { DetailCard } from './panel/detail.ts';
import { MetricsPanel } from './panel/metrics.ts';
import { OUTCOME_WORDS, StatusPanel } from './panel/status.ts';
import { neighbour, VarianceImage } from './panel/varianceImage.ts';
import { type Layers, needsSurfaces } from './scene/layers.ts';
import { Stage } from './scene/stage.ts';
import { GroundTools } from './scene/tools.ts';
import type { CameraMode } from './scene/viewpoint.ts';
import { Attention, type Finder } from './ui/attention.ts';
import { Controls } from './ui/controls.ts';
import { byId, setText } from './ui/dom.ts';
import { bindKeys } from './ui/keys.ts';
import { LayersPanel } from './ui/layersPanel.ts';
import { Notice } from './ui/notice.ts';
import { bindPointing, bindStepping } from './ui/pointing.ts';
import { readTheme, watchTheme } from './ui/theme.ts';

const element = (id: string) => byId(id, HTMLElement);
const view = byId('view', HTMLCanvasElement);
const notice = new Notice();
const image = byId('variance', HTMLCanvasElement);
const variance = new VarianceImage(image, readTheme());
const roll = new AttitudeInstrument(ROLL);
const pitch = new AttitudeInstrument(PITCH);
element('attitude').append(roll.element, pitch.element);
const metrics = new MetricsPanel(element('metrics'));
const attention = new Attention((frame, target) => {
  stage?.mark(frame, target);
  variance.mark(target);
  decision.mark(target);
  detail.show(frame, target, attention.pinned);
});
const detail = new DetailCard(element('detail'), () => attention.pin(undefined));
const decision = new DecisionPanel(element('candidates'), element('terms'), element('candidate-count'), attention);
const status = new StatusPanel({
  outcome: element('outcome'),
  time: element('time'),
  speed: element('speed-now'),
  reason: element('reason'),
  planner: element('planner-ms'),
  returns: element('returns'),
  digest: element('digest'),
  announcement: element('announcement'),
});
const result = element('result');
const help = byId('help-sheet', HTMLDialogElement);

/** Without WebGL the numbers, the image and the controls still work. */
let stage: Stage | undefined;
try {
  stage = new Stage(view, readTheme());
} catch {
  notice.show('This browser offers no WebGL 2, so the 3D view stays empty. Everything else works.');
}

const app = new App({
  session(info, field) {
    stage?.session(info, field);
    variance.session(info);
    detail.session(info);
    if (field) layersPanel.heights(field.min_m, field.max_m);
    roll.limit(info.limits.roll_rad);
    pitch.limit(info.limits.pitch_rad);
    decision.session(info);
    status.session(info);
    controls.showSession(info);
    showCamera();
    const { group, title, lesson } = entry(info.scenario);
    setText(element('scene-title'), `${group}: ${title}`);
    setText(element('scene-lesson'), lesson);
    setText(element('next-title'), following(info.scenario).title);
  },
  frame(frame) {
    stage?.frame(frame);
    variance.show(frame);
    decision.show(frame);
    attention.show(frame);
    metrics.show(frame.metrics);
    roll.show(frame.pose.roll, frame.metrics.max_abs_roll_rad);
    pitch.show(frame.pose.pitch, frame.metrics.max_abs_pitch_rad);
  },
  status(frame, playing) {
    status.show(frame, playing);
    // Once a trial has ended, the button starts it anew.
    controls.showPlaying(playing && frame.outcome === 'running');
    result.hidden = frame.outcome === 'running';
    result.dataset.outcome = frame.outcome;
    setText(element('result-words'), OUTCOME_WORDS[frame.outcome]);
  },
  sculpted: () => stage?.sculpted(),
  playing: (playing) => controls.showPlaying(playing),
  speed(speed) {
    controls.showSpeed(speed);
    stage?.speed(speed);
  },
  tool: (tool) => controls.showTool(tool),
  countdown(seconds) {
    setText(element('countdown'), seconds === undefined ? '' : `in ${seconds} s`);
  },
  notice: (message) => notice.show(message),
  clearNotice: () => notice.hide(),
});

const tools = stage
  ? new GroundTools(view, stage, {
      setGoal: (goal) => app.attempt(app.setGoal(goal)),
      setStart: (start) => app.attempt(app.setStart(start)),
      sculpt: (brush) => app.attempt(app.dab(brush)),
    })
  : undefined;

const actions = {
  togglePlay: () => app.attempt(app.togglePlay()),
  step: () => app.attempt(app.step()),
  restart: () => app.attempt(app.restart().then(() => app.play())),
  next: () => app.attempt(app.next()),
  setSpeed: (speed: number) => app.attempt(app.setSpeed(speed)),
  faster: (steps: number) => app.attempt(app.faster(steps)),
  load: (...args: Parameters<App['run']>) => app.attempt(app.run(...args)),
  selectTool(tool: Parameters<GroundTools['select']>[0]) {
    tools?.select(tool);
    controls.showTool(tool);
  },
  setBrushRadius: (radius_m: number) => tools?.radius(radius_m),
  growBrush: (steps: number) => controls.growBrush(steps),
  toggleFollow() {
    if (stage?.camera === 'chase') stage.release();
    else stage?.view('chase');
    showCamera();
  },
  toggleEye: () => view3d(stage?.camera === 'eye' ? 'chase' : 'eye'),
  toggleTop: () => view3d(stage?.camera === 'top' ? 'chase' : 'top'),
  overview: () => view3d('free'),
  toggleLayers: () => layersPanel.toggle(),
  toggleImage: () => enlargeImage(!imageIsLarge()),
  tour: () => app.attempt(tour()),
  letGo() {
    actions.selectTool('look');
    attention.pin(undefined);
  },
  help: () => help.showModal(),
};
const controls = new Controls(actions);
function showCamera(): void {
  controls.showCamera(stage?.camera ?? 'free');
}
function view3d(mode: CameraMode): void {
  stage?.view(mode);
  showCamera();
}

const layersPanel = new LayersPanel((layers) => {
  stage?.layers(layers);
  watchSurfaces();
});
/** The surfaces are predicted only while the image is in sight or a layer shows them. */
let imageInSight = false;
function watchSurfaces(): void {
  app.attempt(app.watch(imageInSight || needsSurfaces(layersPanel.layers)));
}
new IntersectionObserver((entries) => {
  imageInSight = entries.at(-1)?.isIntersecting ?? false;
  watchSurfaces();
}).observe(image);

const layout = element('app');
const imageIsLarge = () => layout.dataset.image === 'large';
function enlargeImage(large: boolean): void {
  layout.dataset.image = large ? 'large' : 'small';
  controls.showImage(large);
  // A phone scrolls the large image sideways: it begins with what is ahead.
  const scroller = element('seen-scroll');
  scroller.scrollLeft = (scroller.scrollWidth - scroller.clientWidth) / 2;
  if (large) scroller.scrollIntoView({ block: 'nearest' });
}

/** Loaded only for those who take it. */
async function tour(): Promise<void> {
  const card = element('tour');
  if (!card.hidden) return;
  const { Tour } = await import('./tour/tour.ts');
  if (layout.dataset.tour) return;
  layout.dataset.tour = 'on';
  const host = {
    layers: layersPanel.layers,
    camera: stage?.camera ?? 'free',
    imageIsLarge: imageIsLarge(),
    playing: app.playing,
    decided: () => app.decided(),
    showLayers: (layers: Layers) => layersPanel.set(layers),
    view: view3d,
    enlargeImage,
    play: (playing: boolean) => (playing ? app.play() : app.pause()),
    pin: (finder: Finder | undefined) => attention.pin(finder),
  } as const;
  const ended = () => {
    delete layout.dataset.tour;
    byId('tour-open', HTMLButtonElement).focus();
  };
  try {
    await new Tour(card, host, ended).begin();
  } catch (error) {
    ended();
    throw error;
  }
}

bindPointing(image, attention, (x, y, within_px) => variance.pointedAt(x, y, within_px));
bindPointing(
  view,
  attention,
  (x, y, within_px) => stage?.pointedAt(x, y, within_px),
  () => view.dataset.tool === 'look',
);
bindStepping(image, (by, segments) => {
  attention.pin((frame) => neighbour(frame, attention.target, by, segments));
  setText(element('pointed'), detail.text);
});
bindKeys(actions);
controls.showTool('look');
controls.showSpeed(1);

watchTheme((theme) => {
  stage?.theme(theme);
  variance.theme(theme);
});
for (const event of ['pointerdown', 'keydown', 'wheel']) {
  document.addEventListener(event, () => app.touch(), { passive: true, capture: true });
}
document.addEventListener('visibilitychange', () => app.attempt(app.hidden(document.hidden)));
view.addEventListener('webglcontextlost', (event) => {
  event.preventDefault();
  notice.show('The graphics driver took the 3D view away. It comes back by itself; the simulation goes on.');
});
view.addEventListener('webglcontextrestored', () => notice.hide());

publish(app);

const first = CATALOGUE[0];
if (first) app.attempt(app.run(first.id));

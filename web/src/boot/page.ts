/** Puts the page together. */

import { App } from '../app/app.ts';
import { answerFrame } from '../app/framed.ts';
import { publish } from '../app/windowApi.ts';
import { byId, setText } from '../base/dom.ts';
import { readTheme, watchTheme } from '../colours/theme.ts';
import { BrushPanel } from '../controls/brushPanel.ts';
import { Controls } from '../controls/controls.ts';
import { GroundKey } from '../controls/groundKey.ts';
import { bindKeys } from '../controls/keys.ts';
import { ObjectPanel } from '../controls/objectPanel.ts';
import { ShareSheet } from '../controls/shareSheet.ts';
import { TerrainsSheet } from '../controls/terrainsSheet.ts';
import { TimelineBar } from '../controls/timelineBar.ts';
import { UndoButtons } from '../controls/undoButtons.ts';
import type { Editor } from '../editor/editor.ts';
import { Autosave } from '../experiment/autosave.ts';
import { entry, following } from '../experiment/catalogue.ts';
import { countOverrides } from '../experiment/overrides.ts';
import type { HeightField } from '../ground/heightField.ts';
import { AttitudeInstrument, PITCH, ROLL } from '../inspector/attitude.ts';
import { Inspector } from '../inspector/inspector.ts';
import { outcomeWords, StatusPanel } from '../inspector/status.ts';
import type { Lab } from '../lab/lab.ts';
import { Measure } from '../measurements/measurements.ts';
import { ComputingSign } from '../notices/computing.ts';
import { watchFaults, watchGraphics } from '../notices/faults.ts';
import { Notice } from '../notices/notice.ts';
import { keepOffline } from '../offline/register.ts';
import type { Frame, SessionInfo } from '../protocol/simulationProtocol.ts';
import { published } from '../run/published.ts';
import { GroundTools } from '../view/groundTools.ts';
import { ObjectTool } from '../view/objectTool.ts';
import { Stage } from '../view/stage.ts';
import { AddressBar } from './addressBar.ts';
import { ByHand } from './byHand.ts';
import { Recordings } from './recordings.ts';
import { beginAt, begun, core } from './startCore.ts';
import { begin, leadOut } from './welcome.ts';

const element = (id: string) => byId(id, HTMLElement);
const view = byId('view', HTMLCanvasElement);
const notice = new Notice();
const computing = new ComputingSign();
const roll = new AttitudeInstrument(ROLL);
const pitch = new AttitudeInstrument(PITCH);
element('attitude').append(roll.element, pitch.element);
const status = new StatusPanel({
  outcome: element('outcome'),
  time: element('time'),
  speed: element('speed-now'),
  reason: element('reason'),
  returns: element('returns'),
  digest: element('digest'),
  announcement: element('announcement'),
});
const result = element('result');
const help = byId('help-sheet', HTMLDialogElement);

/** The drawer with parameters, comparison and seeds: loaded when it is first opened. */
let lab: Lab | undefined;

async function loadLab(): Promise<Lab> {
  const { Lab } = await import('../lab/lab.ts');
  lab ??= new Lab(app, stage, byId('lab', HTMLButtonElement));
  return lab;
}

async function openLab(): Promise<void> {
  (await loadLab()).toggle();
}

function labCount(count: number): void {
  const badge = element('lab-count');
  badge.hidden = count === 0;
  setText(badge, String(count));
  byId('lab', HTMLButtonElement).setAttribute(
    'aria-label',
    `Parameters, comparison, many seeds${count > 0 ? `; ${count} changed` : ''}`,
  );
}

/** What is said and published of a scenario is shown only where its ground, start and route are its own. */
function showCourse({ experiment, asItComes }: Editor): void {
  const name = asItComes && experiment ? experiment.name : '';
  measure.paper(published(name));
  setText(element('scene-lesson'), asItComes === false ? CHANGED : entry(name).lesson);
}

const CHANGED = 'Changed: ground, objects, start or route are no longer the scenario’s.';

const SLOW = 'Opening this takes long. Wait for it, or stop it and go on with what was there before.';

let stage: Stage | undefined;

const app = new App(core, {
  session(info, field) {
    // Something else was opened.
    if (field) recordings.close();
    if (recordings.drive) return;
    shared.session(info, field);
    labCount(countOverrides(info.overrides));
    lab?.session(info);
    byHand.session(info);
    measure.session(info);
    controls.showSession(info);
    objectTool?.show(info.objects);
    groundKey.session(info);
    if (field) {
      groundKey.ground(field);
      brushPanel.ground(field.min_m, field.max_m);
      lab?.sculpted();
    }
    setText(element('next-title'), following(info.scenario).title);
  },
  frame(frame) {
    if (recordings.drive) return;
    shared.frame(frame);
    lab?.frame(frame);
    byHand.frame(frame);
    measure.frame(frame);
  },
  status(frame, playing) {
    if (recordings.drive) return;
    status.show(frame, playing);
    // Once a trial has ended, the button starts it anew.
    controls.showPlaying(playing && frame.outcome === 'running');
    result.hidden = frame.outcome === 'running';
    result.dataset.outcome = frame.outcome;
    setText(element('result-words'), outcomeWords(frame));
  },
  sculpted(patch, solids) {
    stage?.sculpted(patch, solids);
    lab?.sculpted();
    if (app.field) groundKey.ground(app.field);
  },
  playing: (playing) => controls.showPlaying(playing),
  speed(speed) {
    controls.showSpeed(speed);
    stage?.speed(speed);
  },
  still: () => stage?.still() ?? Promise.resolve(),
  countdown(seconds) {
    setText(element('countdown'), seconds === undefined ? '' : `in ${seconds} s`);
  },
  experiment(editor) {
    undoButtons.show(editor);
    showCourse(editor);
    if (!editor.experiment) return;
    // What the address brings back is no work to keep.
    if (!addressBar.show(editor, !app.touched)) autosave.save(editor.experiment, !editor.asOpened);
    app.attempt(leadOut(editor.experiment));
  },
  notice: (message) => notice.show(message),
  news: (message) => notice.tell(message),
  clearNotice: () => notice.hide(),
  askHow: () => inspector.askHow(),
  computing: (what) => computing.show(what),
  slow: (stop) => notice.tell(SLOW, 'Stop', stop),
  clearSlow: () => notice.withdraw(SLOW),
});

const NO_LARGEST = { max_abs_roll_rad: undefined, max_abs_pitch_rad: undefined };

/** What a run and a recording are shown by. */
const shared = {
  session(info: SessionInfo, field: HeightField | undefined) {
    stage?.session(info, field);
    timeline.session(info.period_s);
    inspector.session(info, field);
    roll.limit(info.limits.roll_rad);
    pitch.limit(info.limits.pitch_rad);
    status.session(info);
    const { group, title } = entry(info.scenario);
    setText(element('scene-title'), recordings.drive ? 'A robot’s recording' : `${group}: ${title}`);
  },
  frame(frame: Frame) {
    stage?.frame(frame);
    timeline.show(frame);
    inspector.frame(frame);
    // Of a recording the largest so far is not kept.
    const { max_abs_roll_rad, max_abs_pitch_rad } = recordings.drive ? NO_LARGEST : frame.metrics;
    roll.show(frame.pose.roll, max_abs_roll_rad);
    pitch.show(frame.pose.pitch, max_abs_pitch_rad);
  },
};

const recordings = new Recordings(app, {
  session: shared.session,
  surroundings: (field) => stage?.surroundings(field),
  frame(frame, playing) {
    shared.frame(frame);
    status.show(frame, playing);
  },
  playing: (playing) => controls.showPlaying(playing),
  speed(speed) {
    controls.showSpeed(speed);
    stage?.speed(speed);
  },
  notice: (message) => notice.show(message),
  letGo() {
    actions.letGo();
    inspector.enlargeImage(false);
  },
});
/** What buttons, keys and the timeline drive. */
const driven = () => recordings.drive ?? app;

const graphics = watchGraphics(
  (message) => notice.show(message),
  () => notice.hide(),
);
/** Without WebGL the numbers, the image and the controls still work. */
try {
  stage = new Stage(view, readTheme(), graphics);
} catch {
  graphics.unavailable();
}

const measure = new Measure({
  record: app.record,
  view: stage,
  editor: app.editor,
  heightAt: (place) => app.heightAt(place),
  go: (time_s) => app.attempt(app.seekTime(time_s)),
  notice: (message) => notice.show(message),
});
const inspector = new Inspector(app, stage, view, {
  enlarged: (large) => {
    if (!recordings.drive) byHand.imageEnlarged(large);
  },
  byHand: (open) => byHand.process(open),
});
const byHand = new ByHand(app, inspector, stage, view, async () => (await loadLab()).besideFixed());
const tools = stage
  ? new GroundTools(view, stage, {
      setGoal: (goal) => app.attempt(app.course.setGoal(goal)),
      addWaypoint: (place) => app.attempt(app.course.addWaypoint(place)),
      setStart: (start) => app.attempt(app.course.setStart(start)),
      pressed: (onGround) => controls.showHint(onGround),
      moveView: (right, ahead) => inspector.moveView(right, ahead),
      stroke(brush) {
        const stroke = app.editor.stroke(brush);
        return { touch: stroke.touch, end: () => app.attempt(stroke.end()) };
      },
    })
  : undefined;

const objectTool = stage
  ? new ObjectTool(view, stage, {
      setObjects: (change) => app.attempt(app.course.setObjects(change)),
      pressed: (onGround) => controls.showHint(onGround),
      changed: (objects, held) => objectPanel.show(objects, held),
      say: (words) => objectPanel.say(words),
    })
  : undefined;
const objectPanel = new ObjectPanel({
  kind: (kind) => objectTool?.kind(kind),
  hold: (object) => objectTool?.hold(object),
  turn: (times) => objectTool?.turn(times),
  grow: (times) => objectTool?.grow(times),
  remove: () => objectTool?.remove(),
});

/** A choice that is refused goes back to what holds. */
async function orBack(choice: Promise<void>): Promise<void> {
  try {
    await choice;
  } catch (error) {
    if (app.info) controls.showSession(app.info);
    throw error;
  }
}

const actions = {
  togglePlay: () => app.attempt(driven().togglePlay()),
  step: () => app.attempt(driven().step()),
  restart: () => app.attempt(recordings.drive?.restart() ?? app.restart().then(() => app.play())),
  next: () => app.attempt(app.next()),
  setSpeed: (speed: number) => app.attempt(driven().setSpeed(speed)),
  faster: (steps: number) => app.attempt(driven().faster(steps)),
  load: (...args: Parameters<App['runScenario']>) => app.attempt(orBack(app.runScenario(...args))),
  selectTool(tool: Parameters<GroundTools['select']>[0]) {
    tools?.select(tool);
    objectTool?.select(tool === 'objects');
    objectPanel.tool(tool);
    controls.showTool(tool);
    brushPanel.tool(tool);
  },
  change: (part: Parameters<App['change']>[0]) => app.attempt(orBack(app.change(part))),
  growBrush: (steps: number) => brushPanel.grow(steps),
  strengthenBrush: (steps: number) => brushPanel.strengthen(steps),
  terrains: () => terrainsSheet.open(),
  share: () => app.attempt(shareSheet.open()),
  letGo() {
    actions.selectTool('look');
    inspector.letGo();
  },
  help: () => help.showModal(),
  addWaypoints: (adding: boolean) => tools?.addWaypoints(adding),
  clearWaypoints: () => app.attempt(app.info ? app.course.setGoal(app.info.goal) : Promise.resolve()),
  setGoalHeading: (heading_rad: number | undefined) => app.attempt(app.course.setGoalHeading(heading_rad)),
  jump: (times: number) => app.attempt(driven().jump(times)),
  lab: () => app.attempt(openLab()),
  method: () => byHand.toggleProcess(),
  weigh: () => byHand.toggleCost(),
};
const brushPanel = new BrushPanel((setting) => tools?.brush(setting));
const groundKey = new GroundKey((colouring) => stage?.colouring(colouring));
const undoButtons = new UndoButtons(app);
const terrainsSheet = new TerrainsSheet(
  app,
  async ({ name, bytes }) => (await loadLab()).planner(name, bytes),
  (file) => {
    // What was wrong with the file before is not said of this one.
    notice.hide();
    return recordings.open(file);
  },
  async (file) => {
    const { savedRun, wordsOf } = await import('../files/savedRun.ts');
    const run = await savedRun(file);
    if (!run) return false;
    const frame = await app.openAt(run.experiment, run.moment_s);
    const stopped = frame?.outcome === 'running' && frame.time_s < run.moment_s - 1e-6;
    if (frame && !stopped) notice.tell(wordsOf(file.name, run, frame.digest));
    return true;
  },
);
const shareSheet = new ShareSheet(app);
const autosave = new Autosave((why) => notice.show(why));
const addressBar = new AddressBar((experiment) => app.attempt(app.run({ experiment })));
const controls = new Controls(actions);
const timeline = new TimelineBar((tick) => app.attempt(driven().seek(tick)));
byId('lab', HTMLButtonElement).addEventListener('click', actions.lab);
bindKeys(actions, inspector, () => recordings.drive !== undefined);
controls.showTool('look');
controls.showSpeed(1);

watchTheme((theme) => {
  stage?.theme(theme);
  inspector.theme(theme);
  byHand.theme(theme);
});
for (const event of ['pointerdown', 'keydown', 'wheel']) {
  document.addEventListener(event, () => app.touch(), { passive: true, capture: true });
}
document.addEventListener('visibilitychange', () => app.attempt(app.hidden(document.hidden)));
watchFaults((message) => notice.show(message));
element('skip').addEventListener('click', (event) => {
  // An address with #view would stand in the history and in shared links.
  event.preventDefault();
  view.focus();
});
keepOffline((start) => notice.tell('A new version of this page is ready.', 'Reload', start));

publish(app);

app.attempt(
  begin(app, notice, begun, beginAt).then(async (beginning) => {
    if (beginning?.from === 'last visit' && beginning.own) await autosave.goOnWith(beginning.own);
    if (window.mapless && document.documentElement.hasAttribute('data-embed')) answerFrame(window.mapless);
  }),
);

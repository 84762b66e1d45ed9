/** Keys for everything. They act wherever the focus is, except while text is typed or a control uses the key itself. */

import { TOOLS, type Tool } from '../view/groundTools.ts';

export interface KeyActions {
  togglePlay(): void;
  step(): void;
  restart(): void;
  next(): void;
  faster(steps: number): void;
  selectTool(tool: Tool): void;
  growBrush(steps: number): void;
  strengthenBrush(steps: number): void;
  terrains(): void;
  share(): void;
  /** Puts down the tool and lets go of what was pointed at. */
  letGo(): void;
  help(): void;
  /** So many jumps along the timeline. */
  jump(times: number): void;
  lab(): void;
  /** The Gaussian process by hand. */
  method(): void;
  /** The weights of the cost. */
  weigh(): void;
}

export interface InspectorKeys {
  toggleFollow(): void;
  toggleEye(): void;
  toggleTop(): void;
  overview(): void;
  toggleLayers(): void;
  toggleImage(): void;
  tour(): void;
}

/** What can be done with a recording, which cannot be changed. */
const RECORDED = new Set([' ', ...'srjkfetoxvg,.?']).add('escape');

/** `recorded`: whether a recording is shown in place of a run. */
export function bindKeys(actions: KeyActions, inspector: InspectorKeys, recorded: () => boolean): void {
  const keys: Record<string, () => void> = {
    ' ': () => actions.togglePlay(),
    s: () => actions.step(),
    r: () => actions.restart(),
    j: () => actions.jump(-1),
    k: () => actions.jump(1),
    p: () => actions.lab(),
    m: () => actions.method(),
    w: () => actions.weigh(),
    n: () => actions.next(),
    f: () => inspector.toggleFollow(),
    e: () => inspector.toggleEye(),
    t: () => inspector.toggleTop(),
    o: () => inspector.overview(),
    x: () => inspector.toggleLayers(),
    v: () => inspector.toggleImage(),
    h: () => inspector.tour(),
    ',': () => actions.faster(-1),
    '.': () => actions.faster(1),
    '[': () => actions.growBrush(-1),
    ']': () => actions.growBrush(1),
    '{': () => actions.strengthenBrush(-1),
    '}': () => actions.strengthenBrush(1),
    a: () => actions.selectTool('objects'),
    c: () => actions.selectTool('crater'),
    d: () => actions.selectTool('ditch'),
    b: () => actions.selectTool('boulder'),
    g: () => actions.terrains(),
    l: () => actions.share(),
    '?': () => actions.help(),
    escape: () => actions.letGo(),
  };
  TOOLS.slice(0, 10).forEach((tool, index) => {
    keys[String((index + 1) % 10)] = () => actions.selectTool(tool);
  });
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
    if (document.querySelector('dialog[open]') || takesKey(event)) return;
    // The browser closes a popover itself.
    if (event.key === 'Escape' && document.querySelector(':popover-open')) return;
    const act = keys[event.key.toLowerCase()];
    if (!act || (recorded() && !RECORDED.has(event.key.toLowerCase()))) return;
    event.preventDefault();
    act();
  });
}

/** Fields that somebody writes into. */
const WRITTEN = ['number', 'search', 'text'];

/** Whether the focused control has its own use for the key. */
function takesKey(event: KeyboardEvent): boolean {
  const { target } = event;
  if (target instanceof HTMLSelectElement || target instanceof HTMLTextAreaElement) return true;
  if (target instanceof HTMLInputElement)
    return (
      WRITTEN.includes(target.type) || (event.key === ' ' && (target.type === 'radio' || target.type === 'checkbox'))
    );
  return event.key === ' ' && (target instanceof HTMLButtonElement || target instanceof HTMLAnchorElement);
}

/** Pointing at a drawing by mouse, finger and keys; what is found is marked everywhere. */

import type { Finder, SelectionModel } from '../scene/selection.ts';

/** A press that moved farther than this was a drag. */
const TAP_PX = 6;
const REACH_PX = { mouse: 14, touch: 26 };

type Find = (clientX: number, clientY: number, within_px: number) => Finder | undefined;

/** Hovering shows what is there while the pointer stays; a click or a tap keeps it in sight, and one beside it lets go. */
export function bindPointing(element: HTMLElement, selection: SelectionModel, find: Find, enabled = () => true): void {
  let pressed: { x: number; y: number } | undefined;
  const under = ({ clientX, clientY, pointerType }: PointerEvent) =>
    enabled() ? find(clientX, clientY, pointerType === 'touch' ? REACH_PX.touch : REACH_PX.mouse) : undefined;
  element.addEventListener('pointermove', (event) => {
    if (event.pointerType !== 'touch' && event.buttons === 0) selection.hover(under(event));
  });
  element.addEventListener('pointerleave', () => selection.hover(undefined));
  element.addEventListener('pointerdown', ({ clientX, clientY, isPrimary, button }) => {
    pressed = isPrimary && button === 0 ? { x: clientX, y: clientY } : undefined;
  });
  element.addEventListener('pointercancel', () => {
    pressed = undefined;
  });
  element.addEventListener('pointerup', (event) => {
    if (!pressed || !event.isPrimary || !enabled()) return;
    if (Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) < TAP_PX) selection.pin(under(event));
    pressed = undefined;
  });
}

/** Arrow keys step from one to the next: through subgoals or, with Shift, through segments. */
export function bindStepping(element: HTMLElement, step: (by: 1 | -1, segments: boolean) => void): void {
  element.addEventListener('keydown', (event) => {
    if (event.key !== 'ArrowLeft' && event.key !== 'ArrowRight') return;
    event.preventDefault();
    step(event.key === 'ArrowRight' ? 1 : -1, event.shiftKey);
  });
}

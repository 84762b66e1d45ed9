/** In a frame of another page, a plain wheel scrolls that page: it is the view's with Ctrl, or once the frame was pressed into. */

export function leaveWheel(): void {
  let held = false;
  addEventListener('pointerdown', () => {
    held = true;
  });
  // A press elsewhere in the page around it.
  addEventListener('blur', () => {
    held = false;
  });
  const leave = (event: WheelEvent) => {
    // A pinch on a touchpad comes as a wheel with Ctrl.
    if (!held && !event.ctrlKey && !event.metaKey) event.stopPropagation();
  };
  addEventListener('wheel', leave, { capture: true, passive: true });
}

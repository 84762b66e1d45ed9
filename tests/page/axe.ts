/** Accessibility, as axe judges it, on a desktop and on a phone. */

import AxeBuilder from '@axe-core/playwright';
import type { Page } from '@playwright/test';

const GRAVE = ['serious', 'critical'];

/** What axe finds by the rules of WCAG 2.2 AA, in one line each. */
export function faults(page: Page): Promise<string[]> {
  return found(
    new AxeBuilder({ page }).withTags(['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice']),
  );
}

/** What it finds in the colours alone, which is all that another theme changes. */
export function colourFaults(page: Page): Promise<string[]> {
  return found(new AxeBuilder({ page }).withRules(['color-contrast', 'link-in-text-block']));
}

async function found(axe: AxeBuilder): Promise<string[]> {
  // Otherwise it puts its result together in another page, which takes as long as to find it.
  const { violations } = await axe.setLegacyMode().analyze();
  return violations
    .filter(({ impact }) => GRAVE.includes(impact ?? ''))
    .map(({ id, nodes }) => `${id}: ${nodes.map(({ target }) => target.join(' ')).join(', ')}`);
}

export const DEVICES = {
  desktop: { viewport: { width: 1440, height: 900 } },
  phone: { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true },
};

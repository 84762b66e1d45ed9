/** A drawing of the page as an SVG file of its own: the style sheet's colours and fonts are written into it. */

const PROPERTIES = [
  'fill',
  'stroke',
  'stroke-width',
  'stroke-dasharray',
  'opacity',
  'font-family',
  'font-size',
  'font-weight',
] as const;

const HEAD = 34;

export function toSvgFile(drawing: SVGSVGElement, title: string): string {
  const copy = drawing.cloneNode(true) as SVGSVGElement;
  const originals = drawing.querySelectorAll('*');
  copy.querySelectorAll('*').forEach((element, index) => {
    const original = originals[index];
    if (!original) return;
    const style = getComputedStyle(original);
    for (const property of PROPERTIES) element.setAttribute(property, style.getPropertyValue(property));
    element.removeAttribute('class');
  });
  const { width, height } = drawing.viewBox.baseVal;
  const page = getComputedStyle(drawing.ownerDocument.body);
  const surface = getComputedStyle(drawing.ownerDocument.documentElement).getPropertyValue('--surface');
  const frame = (name: string, attributes: Record<string, string | number>, text = '') => {
    const element = document.createElementNS('http://www.w3.org/2000/svg', name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, String(value));
    element.textContent = text;
    return element;
  };
  copy.removeAttribute('class');
  copy.removeAttribute('aria-hidden');
  copy.setAttribute('xmlns', 'http://www.w3.org/2000/svg');
  copy.setAttribute('viewBox', `-12 ${-HEAD} ${width + 24} ${height + HEAD + 8}`);
  copy.setAttribute('width', String(width + 24));
  copy.setAttribute('height', String(height + HEAD + 8));
  copy.prepend(
    frame('title', {}, title),
    frame('rect', { x: -12, y: -HEAD, width: width + 24, height: height + HEAD + 8, fill: surface.trim() }),
    frame('text', { y: -14, fill: page.color, 'font-family': page.fontFamily, 'font-size': 13 }, title),
  );
  return `<?xml version="1.0" encoding="UTF-8"?>\n${new XMLSerializer().serializeToString(copy)}\n`;
}

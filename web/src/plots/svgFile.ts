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
const LINE = 15;
/** Width of a letter of the words beneath, at most on average. */
const LETTER = 6;

/** The first of the words is the title; the others stand beneath, as many in a line as fit. */
export function toSvgFile(drawing: SVGSVGElement, [title = '', ...words]: readonly string[]): string {
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
  const beneath = linesOf(words, Math.floor(width / LETTER));
  const whole = { x: -12, y: -HEAD, width: width + 24, height: height + HEAD + 12 + beneath.length * LINE };
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
  copy.setAttribute('viewBox', Object.values(whole).join(' '));
  copy.setAttribute('width', String(whole.width));
  copy.setAttribute('height', String(whole.height));
  const type = { fill: page.color, 'font-family': page.fontFamily };
  copy.prepend(
    frame('title', {}, title),
    frame('rect', { ...whole, fill: surface.trim() }),
    frame('text', { y: -14, ...type, 'font-size': 13 }, title),
    ...beneath.map((line, at) => frame('text', { y: height + (at + 1) * LINE, ...type, 'font-size': 11 }, line)),
  );
  return `<?xml version="1.0" encoding="UTF-8"?>\n${new XMLSerializer().serializeToString(copy)}\n`;
}

/** Words joined to lines of so many letters; longer words have a line of their own. */
function linesOf(words: readonly string[], most: number): readonly string[] {
  const lines: string[] = [];
  for (const word of words) {
    const last = lines.at(-1);
    if (last !== undefined && last.length + 2 + word.length <= most) lines[lines.length - 1] = `${last}; ${word}`;
    else lines.push(word);
  }
  return lines;
}

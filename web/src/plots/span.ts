/** The stretch of time that the plots show. */

export interface Span {
  readonly from_s: number;
  readonly to_s: number;
}

/** No closer than two seconds: twenty ticks. */
const SHORTEST_S = 2;

/** `span` made shorter (factor below 1) or longer around a time that stays where it is, within `whole`. */
export function zoom(span: Span, at_s: number, factor: number, whole: Span): Span {
  const length_s = span.to_s - span.from_s;
  const longest_s = whole.to_s - whole.from_s;
  const wanted_s = Math.min(Math.max(length_s * factor, Math.min(SHORTEST_S, longest_s)), longest_s);
  const part = length_s > 0 ? (at_s - span.from_s) / length_s : 0.5;
  return within({ from_s: at_s - part * wanted_s, to_s: at_s + (1 - part) * wanted_s }, whole);
}

/** Moves `span` by a time, no farther than the ends of `whole`. */
export function pan(span: Span, by_s: number, whole: Span): Span {
  return within({ from_s: span.from_s + by_s, to_s: span.to_s + by_s }, whole);
}

function within({ from_s, to_s }: Span, whole: Span): Span {
  const shift_s = Math.max(whole.from_s - from_s, 0) + Math.min(whole.to_s - to_s, 0);
  return { from_s: from_s + shift_s, to_s: to_s + shift_s };
}

/** Round times at a spacing that leaves about `count` of them in the span. */
export function ticks({ from_s, to_s }: Span, count: number): number[] {
  const least_s = (to_s - from_s) / Math.max(count, 1);
  const steps_s = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 1200, 3600];
  const step_s = steps_s.find((step) => step >= least_s) ?? 3600;
  const times: number[] = [];
  for (let index = Math.ceil(from_s / step_s - 1e-9) + 0; index * step_s <= to_s + 1e-9; index += 1) {
    times.push(index * step_s);
  }
  return times;
}

/** Round values between `least` and `most`, about `count` of them, and at least one beside zero. */
export function levels(least: number, most: number, count: number): number[] {
  const wanted = (most - least) / Math.max(count, 1);
  const magnitude = 10 ** Math.floor(Math.log10(wanted));
  const steps = [0.5, 1, 2, 5, 10].map((part) => part * magnitude);
  const step = steps.find((one) => one >= wanted && one <= most) ?? steps.findLast((one) => one <= most) ?? wanted;
  const values: number[] = [];
  for (let index = Math.ceil(least / step - 1e-9) + 0; index * step <= most * (1 + 1e-9); index += 1) {
    values.push(index * step);
  }
  return values;
}

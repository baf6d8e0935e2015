// Numbers and text as a reader sees them; shared by the page and the SVG figures.

const MINUS = '\u2212';
const DASH = '\u2013';

// A fixed number of decimals, a real minus sign, never "-0.0"; anything that is
// not a finite number (JSON has no NaN, so it arrives as null) is a dash.
export function formatNumber(value, digits) {
  if (typeof value !== 'number' || !Number.isFinite(value)) return DASH;
  const text = digits === undefined ? String(value) : value.toFixed(digits);
  const isZero = !/[1-9]/.test(text);
  return isZero ? text.replace('-', '') : text.replaceAll('-', MINUS);
}

// Tick labels: the shortest text for a value whose last bits are rounding noise.
export const formatTick = (value) => formatNumber(Number(value.toPrecision(10)));

// Decimals that resolve about a thousandth of a range, unless the document says.
export function digitsFor(axis, range) {
  if (axis?.digits !== undefined) return axis.digits;
  if (!(range > 0)) return 3;
  return Math.min(9, Math.max(0, 3 - Math.floor(Math.log10(range))));
}

export function withUnit(text, unit) {
  return unit ? `${text}\u00a0${unit}` : text;
}

export function axisTitle(axis = {}) {
  return axis.unit ? `${axis.label ?? ''} (${axis.unit})`.trim() : axis.label ?? '';
}

export function escapeMarkup(text) {
  const entities = { '&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;', "'": '&#39;' };
  return String(text).replace(/[&<>"']/g, (character) => entities[character]);
}

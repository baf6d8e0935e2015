// Colours of charts. The surfaces and inks repeat those of style.css, because
// the SVG figures are drawn without a style sheet.

// Picked to stay apart from each other for protan-, deuter- and tritanopes and to
// have a contrast of at least 3:1 against the surface they are drawn on.
const SERIES_COLOURS = {
  light: ['#2f3146', '#a94200', '#3b60eb', '#2ea599', '#83279a', '#bd8d18'],
  dark: ['#d5d9e3', '#e0602a', '#5b86ff', '#3fc4ae', '#b565c4', '#e6b13c'],
};

// These compensation modes look the same in every report, whichever of them it has.
const FIXED = { uncompensated: 0, before: 0, naive: 1, abbe: 2, abbe_closed: 3 };
const ORDER_OF_OTHERS = [2, 3, 1, 4, 5, 0];

const SURFACES = {
  light: {
    surface: '#ffffff', ink: '#1d222b', muted: '#5b6472', rule: '#c9cfd8', grid: '#e8ebf0', limit: '#b3261e',
    diverging: ['#1f5a9e', '#7fb0d8', '#f6f6f4', '#e9a27c', '#a33a12'],
    sequential: ['#f1f5fa', '#b9cfe8', '#6f9dd0', '#2f68ac', '#12386f'],
  },
  dark: {
    surface: '#15181d', ink: '#e6e9ee', muted: '#9aa3b0', rule: '#454c57', grid: '#272c34', limit: '#ff8a80',
    diverging: ['#86c1f7', '#3a73ad', '#22262d', '#a9552f', '#ffa780'],
    sequential: ['#1d2836', '#24507f', '#3b7fbf', '#7fb4e6', '#d8eafb'],
  },
};

// No double quotes: ECharts writes the name into SVG attributes as it is.
export const FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Liberation Sans', Arial, sans-serif";

const keyOf = (name) => String(name).toLowerCase().replace(/[^a-z0-9]+/g, '_');

// One slot of the palette for each series name of a document.
function assignSlots(names) {
  const slots = new Map();
  for (const name of names) {
    const fixed = FIXED[keyOf(name)];
    if (fixed !== undefined) slots.set(name, fixed);
  }
  const taken = new Set(slots.values());
  const free = ORDER_OF_OTHERS.filter((slot) => !taken.has(slot));
  const others = names.filter((name) => !slots.has(name));
  // Six channels of one axis have to differ from each other more than from a mode in another chart.
  const pool = others.length <= free.length ? free : ORDER_OF_OTHERS;
  let next = 0;
  for (const name of names) {
    if (!slots.has(name)) slots.set(name, pool[next++ % pool.length]);
  }
  return slots;
}

// mode: 'light' or 'dark'; names: all series names of the document.
export function makeTheme(mode, names) {
  const slots = assignSlots(names);
  const colours = SERIES_COLOURS[mode];
  return { mode, font: FONT, ...SURFACES[mode], colourOf: (name) => colours[slots.get(name) ?? 2] };
}

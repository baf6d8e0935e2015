// Positioning of one axis after ISO 230-2: means of both directions with bands of
// two standard deviations, and the figures A, R, E, B and M as dimension lines.

import { digitsFor, formatNumber } from '../format.mjs';
import { linesOption } from './lines.mjs';
import { quantity, tooltip, tooltipTable } from './parts.mjs';

const MEANINGS = {
  A: 'accuracy of positioning, both directions',
  R: 'repeatability, both directions',
  E: 'systematic deviation, both directions',
  B: 'reversal value',
  M: 'range of the mean deviation',
};
const COLUMN = 26;  // pixels for each dimension line beside the plot
const LETTER_ROOM = 16;  // pixels
const BESIDE = ['A', 'E', 'M'];

// R and B may stand at the same target.
const TEXT_BESIDE = {
  A: { dx: 0, align: 'center' }, E: { dx: 0, align: 'center' }, M: { dx: 0, align: 'center' },
  R: { dx: -5, align: 'right' }, B: { dx: 5, align: 'left' },
};

// The curves of the chart as those of a "lines" section.
export function positioningSeries({ positions, up, down }) {
  const band = ({ mean, s }) => ({
    lo: mean.map((value, index) => value - 2 * s[index]),
    hi: mean.map((value, index) => value + 2 * s[index]),
  });
  return [
    { name: 'upwards', x: positions, y: up.mean, band: band(up) },
    { name: 'downwards', x: positions, y: down.mean, band: band(down) },
    { name: 'mean of both', x: positions, y: positions.map((_, i) => (up.mean[i] + down.mean[i]) / 2), style: 'dashed' },
  ];
}

// From where to where each dimension line reaches: {name, low, high, x?}; x is the target it stands
// at, none: beside the plot.
export function dimensions(section) {
  const [up, down, mean] = section.series;
  const range = (...arrays) => ({ low: Math.min(...arrays.flat()), high: Math.max(...arrays.flat()) });
  const targets = section.positions.map((x, i) => {
    const [s, t] = [section.up.s[i], section.down.s[i]];
    const reversal = Math.abs(up.y[i] - down.y[i]);
    return { x, i, reversal, spread: Math.max(2 * s + 2 * t + reversal, 4 * s, 4 * t) };
  });
  const worst = (key) => targets.reduce((a, b) => (b[key] > a[key] ? b : a));
  const r = worst('spread');
  const b = worst('reversal');
  const bandsAt = ({ i }) => range([up.band.lo[i], down.band.lo[i], up.band.hi[i], down.band.hi[i]]);
  return [
    { name: 'A', ...range(up.band.lo, up.band.hi, down.band.lo, down.band.hi) },
    { name: 'E', ...range(up.y, down.y) },
    { name: 'M', ...range(mean.y) },
    { name: 'R', x: r.x, ...bandsAt(r) },
    { name: 'B', x: b.x, ...range([up.y[b.i], down.y[b.i]]) },
  ];
}

export function iso230Option(section, theme, view) {
  const option = linesOption(section, theme, view);
  const lines = dimensions(section);
  const digits = digitsFor(section.y, section.figures.A);
  const last = Math.max(...section.positions);
  return {
    ...option,
    grid: { ...option.grid, right: BESIDE.length * COLUMN + 12, top: 22 },
    title: {
      text: Object.keys(MEANINGS).map((name) => `${name} ${formatNumber(section.figures[name], Math.min(digits, 2))}`)
        .join('   ') + `   ${section.y.unit}`,
      right: 16, top: 6, padding: 0, textStyle: { color: theme.muted, fontSize: 11.5, fontWeight: 'normal' },
    },
    series: [...option.series, {
      id: 'dimensions', type: 'custom', clip: false, z: 8, encode: { x: 0, y: [1, 2], tooltip: [1] },
      data: lines.map((line) => [line.x ?? last, line.low, line.high]), emphasis: { disabled: true },
      tooltip: tooltip(theme, {
        trigger: 'item',
        formatter: ({ dataIndex }) => {
          const { name } = lines[dataIndex];
          return tooltipTable(`${name} ${quantity(section.y, section.figures[name], digits)}`, [{ name: MEANINGS[name], text: '' }]);
        },
      }),
      renderItem: (params, api) => dimensionLine(lines, params.dataIndex, api, params.coordSys, theme),
    }],
  };
}

// Where the letter of a dimension line stands. R at the first target is above its line, for on the
// left are the labels of the axis; B at the same target stays below it.
function letterPlace(lines, { name, x }, { at, low, high }, api, plot) {
  if (x === undefined) return { ...TEXT_BESIDE[name], y: Math.max(high - 3, 20), verticalAlign: 'bottom' };
  if (name !== 'R' || at - plot.x > LETTER_ROOM) return { ...TEXT_BESIDE[name], y: (low + high) / 2, verticalAlign: 'middle' };
  const b = lines.find((line) => line.name === 'B');
  const [, middleOfB] = api.coord([b.x, (b.low + b.high) / 2]);
  const above = b.x === x ? Math.min(high - 2, middleOfB - LETTER_ROOM / 2) : high - 2;
  return { dx: 5, align: 'left', y: above, verticalAlign: 'bottom' };
}

// Ends, shaft and letter.
function dimensionLine(lines, index, api, plot, theme) {
  const { name, x } = lines[index];
  const beside = x === undefined;
  const [atTarget, low] = api.coord([api.value(0), api.value(1)]);
  const [, high] = api.coord([api.value(0), api.value(2)]);
  const at = beside ? plot.x + plot.width + (BESIDE.indexOf(name) + 0.6) * COLUMN : atTarget;
  const stroke = { stroke: theme.ink, lineWidth: beside ? 1.2 : 1 };
  const tick = (y) => ({ type: 'line', shape: { x1: at - 4, y1: y, x2: at + 4, y2: y }, style: stroke });
  const letter = letterPlace(lines, lines[index], { at, low, high }, api, plot);
  return {
    type: 'group',
    children: [
      { type: 'line', shape: { x1: at, y1: low, x2: at, y2: high }, style: stroke }, tick(low), tick(high),
      {
        type: 'text', x: at + letter.dx, y: letter.y,
        style: {
          text: name, fill: theme.ink, font: `600 11px ${theme.font}`, align: letter.align,
          verticalAlign: letter.verticalAlign, backgroundColor: theme.surface, padding: [0, 1],
        },
      },
    ],
  };
}

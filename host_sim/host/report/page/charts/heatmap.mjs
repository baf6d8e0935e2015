// A value over a grid of two coordinates, as colour.

import { axisTitle, digitsFor, formatNumber } from '../format.mjs';
import { extent } from '../series.mjs';
import { grid, quantity, tooltip, tooltipTable, xAxis, yAxis } from './parts.mjs';

const MOST_LABELS = 12;      // along one axis
const ROOM_PER_LABEL = 56;   // pixels along the x axis

export function heatmapOption(section, theme, view) {
  const { x, y, z } = section;
  const digits = rangeDigits(z, ...z.values);
  return {
    // On the line of the y title, at the right: what the colours stand for.
    title: {
      text: axisTitle(z), right: 6, top: 7, padding: 0,
      textStyle: { color: theme.muted, fontSize: 12, fontWeight: 'normal' },
    },
    grid: grid({ right: 76 }),
    xAxis: xAxis(x, theme, gridAxis(x, view.width / ROOM_PER_LABEL)),
    yAxis: yAxis(y, theme, gridAxis(y, MOST_LABELS)),
    visualMap: colourScale(z, theme, digits),
    tooltip: tooltip(theme, {
      formatter: ({ value: [column, row, value] }) => tooltipTable(`${z.label} ${quantity(z, value, digits)}`, [
        { name: x.label, text: quantity(x, x.values[column], rangeDigits(x, x.values)) },
        { name: y.label, text: quantity(y, y.values[row], rangeDigits(y, y.values)) },
      ]),
    }),
    series: [{
      id: 'cells', type: 'heatmap', data: cells(z.values), progressive: 0,
      itemStyle: { borderWidth: 0 }, emphasis: { itemStyle: { borderColor: theme.ink, borderWidth: 1 } },
    }],
  };
}

// z.values[row][column] belongs to y.values[row] and x.values[column].
function cells(rows) {
  return rows.flatMap((row, y) => row.map((value, x) => [x, y, Number.isFinite(value) ? value : '-']));
}

// Positions of a grid are rarely round numbers: labels are rounded, and not all are written.
function gridAxis({ values }, mostLabels) {
  const step = values.length > 1 ? Math.abs(values[1] - values[0]) : 1;
  const isEnough = (digits) => values.every((value) => Math.abs(value - Number(value.toFixed(digits))) <= 0.03 * step);
  const digits = [0, 1, 2, 3].find(isEnough) ?? 4;
  return {
    type: 'category', data: values.map((value) => formatNumber(value, digits)),
    splitLine: { show: false }, axisTick: { show: false },
    axisLabel: { interval: Math.ceil(values.length / Math.min(mostLabels, MOST_LABELS)) - 1 },
  };
}

function rangeDigits(axis, ...arrays) {
  const [low, high] = extent(...arrays) ?? [0, 1];
  return digitsFor(axis, high - low);
}

// Values of both signs get a scale that is neutral at zero and equally wide on either side.
function colourScale(z, theme, digits) {
  const [low, high] = extent(...z.values) ?? [0, 1];
  const signed = low < 0 && high > 0;
  const reach = Math.max(-low, high);
  const [min, max] = signed ? [-reach, reach] : [low, high];
  const ends = [max, min].map((value) => formatNumber(value, Math.min(digits, 2)));
  return {
    type: 'continuous', min, max, calculable: false, right: 14, top: 'middle', itemWidth: 12, itemHeight: 240,
    inRange: { color: signed ? theme.diverging : theme.sequential },
    text: ends, textGap: 8, textStyle: { color: theme.muted, fontSize: 12 },
  };
}

// How often values fall into bins that all series of the chart have in common.

import { digitsFor, formatNumber, withUnit } from '../format.mjs';
import { extent, limitsOf, niceStep } from '../series.mjs';
import { grid, limitSeries, tooltip, tooltipTable, valueScale, visibleSeries, xAxis, xEnds, yAxis } from './parts.mjs';

export function histogramOption(section, theme, view) {
  const bins = makeBins(section);
  const shown = visibleSeries(section, view);
  const counts = new Map(shown.map((series) => [series.name, countInto(bins, series.values)]));
  return {
    grid: grid({ right: 28 }),  // half of the words above a limit line at the edge
    xAxis: xAxis(section.x, theme, { ...valueScale(xRange(section, bins)), splitLine: { show: false } }),
    yAxis: yAxis(section.y ?? { label: 'Count' }, theme, { ...valueScale(), minInterval: 1, boundaryGap: [0, '4%'] }),
    tooltip: binTooltip(section, shown, counts, bins, theme),
    series: [
      ...shown.map((series, slot) => binSeries(series, counts, bins, slot / shown.length, 1 / shown.length, theme)),
      ...limitSeries(section, theme, { along: 'x', unit: section.x?.unit, anchor: 0 }),
    ],
  };
}

// About section.bins bins with round edges, over the hidden series too, so that
// the bins stay where they are when a series is switched off.
function makeBins(section) {
  const [low, high] = extent(...section.series.map((series) => series.values)) ?? [0, 1];
  const width = niceStep((high - low || Math.abs(high) || 1) / (section.bins ?? 12));
  const first = Math.floor(low / width);
  const count = Math.floor(high / width) - first + 1;
  const edge = (index) => Number(((first + index) * width).toPrecision(12));
  return { first, width, count, edge };
}

function countInto(bins, values) {
  const counts = new Array(bins.count).fill(0);
  for (const value of values) {
    if (Number.isFinite(value)) ++counts[Math.floor(value / bins.width) - bins.first];
  }
  return counts;
}

function xRange(section, bins) {
  const [min, max] = extent([bins.edge(0), bins.edge(bins.count)], limitsOf(section));
  // A limit outside of the data does not sit on the frame of the chart.
  const pad = (value, edge) => (value === edge ? 0 : bins.width);
  return xEnds(min - pad(min, bins.edge(0)), max + pad(max, bins.edge(bins.count)));
}

function binSeries(series, counts, bins, offset, share, theme) {
  const data = counts.get(series.name).map((count, index) => [bins.edge(index), bins.edge(index + 1), count]);
  return {
    id: `bins:${series.name}`, name: series.name, type: 'custom', clip: true, data,
    encode: { x: [0, 1], y: 2, tooltip: [2] }, itemStyle: { color: theme.colourOf(series.name) },
    emphasis: { disabled: true },
    renderItem(params, api) {
      const [left, top] = api.coord([api.value(0), api.value(2)]);
      const [right, bottom] = api.coord([api.value(1), 0]);
      const room = right - left - 2;
      return {
        type: 'rect', style: { fill: theme.colourOf(series.name) },
        shape: { x: left + 1 + room * offset, y: top, width: Math.max(1, room * share - 1), height: bottom - top },
      };
    },
  };
}

function binTooltip(section, shown, counts, bins, theme) {
  const digits = digitsFor(section.x, bins.width * 100);
  return tooltip(theme, {
    trigger: 'item',
    formatter({ dataIndex }) {
      const range = `${formatNumber(bins.edge(dataIndex), digits)} … ${formatNumber(bins.edge(dataIndex + 1), digits)}`;
      return tooltipTable(withUnit(range, section.x?.unit), shown.map((series) => ({
        colour: theme.colourOf(series.name), name: series.name, text: String(counts.get(series.name)[dataIndex]),
      })));
    },
  });
}

// Deviations from a circle over the angle, drawn outwards: the picture of a circular test.

import { digitsFor, formatTick } from '../format.mjs';
import { niceRange, yExtent } from '../series.mjs';
import { quantity, tooltip, tooltipTable, visibleSeries } from './parts.mjs';

const ROOM_INSIDE = 1.2;  // of the range, between the centre and the smallest deviation

export function polarOption(section, theme, view) {
  const [low, high] = yExtent([section], view.hidden) ?? [0, 1];
  const range = niceRange([low - ROOM_INSIDE * ((high - low) || 1), high]);
  const xDigits = digitsFor(section.x, 360);
  const yDigits = digitsFor(section.y, high - low);
  return {
    polar: { center: ['50%', '50%'], radius: '82%' },
    angleAxis: {
      type: 'value', min: 0, max: 360, interval: 30, startAngle: 0, clockwise: false,
      axisLine: { lineStyle: { color: theme.rule } }, axisTick: { show: false },
      axisLabel: { color: theme.muted, fontSize: 12, formatter: (degrees) => (degrees === 360 ? '' : `${degrees}°`) },
      splitLine: { lineStyle: { color: theme.grid } },
    },
    radiusAxis: {
      type: 'value', min: range.min, max: range.max, interval: range.interval,
      axisLine: { show: false }, axisTick: { show: false },
      axisLabel: { color: theme.muted, fontSize: 11, formatter: (value) => (value < low - range.interval ? '' : formatTick(value)) },
      splitLine: { lineStyle: { color: theme.grid } },
    },
    tooltip: tooltip(theme, {
      trigger: 'axis',
      formatter: (hits) => tooltipTable(
        `${section.x?.label ?? 'x'} ${quantity(section.x, hits[0].value[1], xDigits)}`,
        hits.map(({ seriesName, value }) => ({
          colour: theme.colourOf(seriesName), name: seriesName, text: quantity(section.y, value[0], yDigits),
        })),
      ),
    }),
    series: visibleSeries(section, view).map((series) => curve(series, theme)),
  };
}

// Within one turn, and closed where the first point follows the last within a step.
function curve(series, theme) {
  const colour = theme.colourOf(series.name);
  const points = series.x.map((angle, index) => [series.y[index], ((angle % 360) + 360) % 360]);
  const step = series.x.length > 1 ? Math.abs(series.x[1] - series.x[0]) : 0;
  const travelled = series.x.length > 1 ? Math.abs(series.x[series.x.length - 1] - series.x[0]) : 0;
  if (travelled + 1.5 * step >= 360) points.push(points[0]);
  return {
    id: `circle:${series.name}`, name: series.name, type: 'line', coordinateSystem: 'polar',
    data: points, symbol: 'circle', symbolSize: 3, showSymbol: false, emphasis: { disabled: true },
    itemStyle: { color: colour }, lineStyle: { color: colour, width: 1.5 },
  };
}

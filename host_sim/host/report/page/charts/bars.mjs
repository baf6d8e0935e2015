// One group of bars for each category, one bar in it for each series.

import { digitsFor, formatNumber } from '../format.mjs';
import { extent, niceStep } from '../series.mjs';
import {
  grid, limitSeries, quantity, rightMargin, tooltip, tooltipTable, valueScale, visibleSeries, xAxis, yAxis,
} from './parts.mjs';

const LETTER = 7.6;           // pixels, of a category name in a wide font
const NARROWEST_NUMBER = 30;  // pixels for a number above its bar

export function barsOption(section, theme, view) {
  const shown = visibleSeries(section, view);
  const range = extent(...section.series.map((series) => series.values)) ?? [0, 1];
  const digits = digitsFor(section.y, Math.max(range[1], 0) - Math.min(range[0], 0));
  const perCategory = (view.width - 60 - rightMargin(section)) / section.categories.length;
  const numbersFit = (perCategory * 0.7) / Math.max(1, shown.length) >= NARROWEST_NUMBER;
  return {
    grid: grid({ right: rightMargin(section) }),
    xAxis: xAxis(section.x ?? {}, theme, {
      type: 'category', data: section.categories, axisTick: { show: false },
      axisLabel: categoryLabel(section.categories, perCategory),
    }),
    // The gaps keep the numbers at the longest bars clear of the axis titles.
    yAxis: yAxis(section.y, theme, { ...valueScale(), boundaryGap: [range[0] < 0 ? '6%' : 0, '6%'] }),
    tooltip: barTooltip(section, shown, theme, digits),
    series: [
      // Above the limit line, which would strike the numbers through.
      ...shown.map((series) => ({
        id: `bar:${series.name}`, name: series.name, type: 'bar', data: series.values.map(bar),
        z: 6, barMaxWidth: 46, barGap: '8%', barCategoryGap: '30%', emphasis: { disabled: true },
        itemStyle: { color: theme.colourOf(series.name) },
        label: {
          show: numbersFit, color: theme.ink, fontSize: 11,
          backgroundColor: theme.surface, padding: [1, 2, 0, 2], distance: 3,
          formatter: ({ value }) => formatNumber(value, digits),
        },
      })),
      ...limitSeries(section, theme, { along: 'y', unit: section.y?.unit, anchor: section.categories[0] }),
    ],
  };
}

const bar = (value) => ({ value, label: { position: value < 0 ? 'bottom' : 'top' } });

// No category may go without its name: long ones break between words, crowded ones lean. Of numbers,
// teeth for instance, the first and round ones are enough.
function categoryLabel(categories, room) {
  if (categories.every(isWhole)) return roundNumbers(categories, room);
  const longestWord = Math.max(...categories.flatMap((name) => name.split(' ')).map((word) => word.length));
  const level = { rotate: 0, width: room - 8, overflow: 'break', lineHeight: 16 };
  const leaning = { rotate: 40, width: 120, overflow: 'truncate' };
  return { interval: 0, hideOverlap: false, ...(longestWord * LETTER + 8 <= room ? level : leaning) };
}

const isWhole = (name) => /^\d+$/.test(name);

function roundNumbers(categories, room) {
  const widest = Math.max(...categories.map((name) => name.length)) * LETTER + 8;
  const step = Math.max(1, niceStep(widest / room));
  const isFirst = (index, name) => index === 0 && name.length === 1;
  return { rotate: 0, hideOverlap: false, interval: (index, name) => isFirst(index, name) || Number(name) % step === 0 };
}

function barTooltip(section, shown, theme, digits) {
  return tooltip(theme, {
    trigger: 'axis',
    axisPointer: { type: 'shadow', z: 0, shadowStyle: { color: theme.grid, opacity: 0.6 } },
    formatter(hits) {
      const index = hits[0].dataIndex;
      return tooltipTable(section.categories[index], shown.map((series) => ({
        colour: theme.colourOf(series.name), name: series.name,
        text: quantity(section.y, series.values[index], digits),
      })));
    },
  });
}

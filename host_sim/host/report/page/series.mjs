// Questions about the data of a document: what is in it, how far it reaches, and
// how to draw fewer points of it without losing a peak.

import { positioningSeries } from './charts/iso230_2.mjs';

export const CHART_TYPES = ['lines', 'bars', 'heatmap', 'histogram', 'iso230_2', 'polar', 'volume', 'places'];

// Drawn in three dimensions, and turned by dragging.
export const SPATIAL_TYPES = ['volume', 'places'];

const CURVES = ['lines', 'iso230_2', 'polar'];

// The same document with the series of those charts whose series follow from other members.
export function prepared(document) {
  const withSeries = (chart) => (chart.type === 'iso230_2' ? { ...chart, series: positioningSeries(chart) } : chart);
  const sections = (document.sections ?? []).map((section) => (
    section.type === 'group' ? { ...section, charts: (section.charts ?? []).map(withSeries) } : withSeries(section)));
  return { ...document, sections };
}

// Every chart of a document, those inside groups too, in reading order.
export function chartsOf(document) {
  return (document.sections ?? []).flatMap((section) => {
    if (section.type === 'group') return section.charts ?? [];
    return CHART_TYPES.includes(section.type) ? [section] : [];
  });
}

// The distinct series names of some charts, in order of first appearance.
export function seriesNames(charts) {
  return [...new Set(charts.flatMap((chart) => (chart.series ?? []).map((series) => series.name)))];
}

// How the series of some charts look in a legend: as line, dashed line, points or block.
export function legendEntries(charts) {
  const looks = new Map();
  for (const chart of charts) {
    for (const series of chart.series ?? []) {
      const look = CURVES.includes(chart.type) ? series.style ?? 'solid' : 'block';
      if (!looks.has(series.name)) looks.set(series.name, look);
    }
  }
  return [...looks].map(([name, look]) => ({ name, look }));
}

// Smallest and largest finite number of any number of arrays, null if there is none.
export function extent(...arrays) {
  let low = Infinity;
  let high = -Infinity;
  for (const values of arrays) {
    for (const value of values ?? []) {
      if (typeof value !== 'number' || !Number.isFinite(value)) continue;
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  return low <= high ? [low, high] : null;
}

export function yExtent(charts, hidden = new Set()) {
  const arrays = charts.flatMap((chart) => [
    ...chart.series.filter((series) => !hidden.has(series.name))
      .flatMap((series) => [series.y, series.band?.lo, series.band?.hi]),
    limitsOf(chart),
  ]);
  return extent(...arrays);
}

// "limit" is one number or a [low, high] pair.
export function limitsOf(chart) {
  if (chart.limit === undefined || chart.limit === null) return [];
  return Array.isArray(chart.limit) ? chart.limit : [chart.limit];
}

// 1, 2 or 5 times a power of ten, not below the given step.
export function niceStep(step) {
  const power = 10 ** Math.floor(Math.log10(step));
  const factor = [1, 2, 5, 10].find((candidate) => candidate * power >= step * (1 - 1e-9));
  return factor * power;
}

// A range around [low, high] whose ends are multiples of its tick interval.
export function niceRange([low, high], ticks = 5) {
  if (low === high) [low, high] = [low - (Math.abs(low) || 1), high + (Math.abs(high) || 1)];
  const interval = niceStep((high - low) / ticks);
  const round = (value) => Number((value * interval).toPrecision(12));
  return { min: round(Math.floor(low / interval)), max: round(Math.ceil(high / interval)), interval };
}

export function isAscending(values) {
  return values.every((value, index) => index === 0 || value >= values[index - 1]);
}

// Index of the entry of an ascending array that is nearest to a value.
export function nearestIndex(ascending, value) {
  let low = 0;
  let high = ascending.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (ascending[middle] > value) high = middle;
    else low = middle;
  }
  return Math.abs(ascending[high] - value) < Math.abs(ascending[low] - value) ? high : low;
}

// At most about maxPoints points of a line. Each run of points keeps its first,
// lowest and highest one, so no extreme error disappears from a figure.
export function thinned(series, maxPoints) {
  const count = series.x.length;
  if (count <= maxPoints) return series;
  const run = Math.ceil((3 * count) / maxPoints);
  const kept = new Set([count - 1]);
  for (let start = 0; start < count; start += run) {
    let lowest = start;
    let highest = start;
    for (let index = start; index < Math.min(start + run, count); ++index) {
      if (series.y[index] < series.y[lowest]) lowest = index;
      if (series.y[index] > series.y[highest]) highest = index;
    }
    kept.add(start).add(lowest).add(highest);
  }
  const indices = [...kept].sort((a, b) => a - b);
  const pick = (values) => indices.map((index) => values[index]);
  const band = series.band && { lo: pick(series.band.lo), hi: pick(series.band.hi) };
  return { ...series, x: pick(series.x), y: pick(series.y), band };
}

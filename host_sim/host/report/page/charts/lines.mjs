// Curves over a common x axis, with an optional band around each.

import { digitsFor } from '../format.mjs';
import { extent, isAscending, nearestIndex, thinned, yExtent } from '../series.mjs';
import {
  grid, limitGap, limitSeries, quantity, rightMargin, tooltip, tooltipTable, valueScale, visibleSeries, xAxis, xEnds, yAxis,
} from './parts.mjs';

const FEW_POINTS = 15;    // up to here every point gets a marker
const MANY_POINTS = 200;  // from here on a slider helps to zoom

const DASHES = { solid: 'solid', dashed: [6, 4] };

export function linesOption(section, theme, view) {
  const shown = visibleSeries(section, view).map((series) => thinned(series, view.maxPoints));
  const xRange = extent(...section.series.map((series) => series.x)) ?? [0, 1];
  const yRange = yExtent([section], view.hidden) ?? [0, 1];
  const ordered = shown.every((series) => isAscending(series.x));
  const slider = view.slider && section.series.some((series) => series.x.length > MANY_POINTS);
  const xDigits = digitsFor(section.x, xRange[1] - xRange[0]);
  const yDigits = digitsFor(section.y, yRange[1] - yRange[0]);
  return {
    grid: grid({ right: rightMargin(section), bottom: slider ? 38 : 4 }),
    xAxis: xAxis(section.x, theme, { ...valueScale(xEnds(...xRange)), splitLine: { show: false } }),
    yAxis: yAxis(section.y, theme, {
      ...valueScale(), scale: isFarFromZero(yRange), boundaryGap: limitGap(section), ...view.yRange,
    }),
    dataZoom: view.zoom ? zoomControls(slider, theme) : [],
    tooltip: ordered
      ? crosshairTooltip(section, shown, theme, xDigits, yDigits)
      : pointTooltip(section, theme, xDigits, yDigits),
    series: [
      ...shown.filter((series) => series.band).map((series) => bandSeries(series, theme)),
      ...shown.map((series) => curve(series, theme, ordered)),
      ...limitSeries(section, theme, { along: 'y', unit: section.y?.unit, anchor: xRange[0] }),
    ],
  };
}

// Zero belongs in a chart of errors, but not in one of, say, temperatures near 20.
function isFarFromZero([low, high]) {
  return low > high / 2 || high < low / 2;
}

function curve(series, theme, ordered) {
  const colour = theme.colourOf(series.name);
  const common = {
    id: `curve:${series.name}`, name: series.name, emphasis: { disabled: true },
    itemStyle: { color: colour }, z: series.emphasis ? 4 : 3,
    data: series.x.map((x, index) => [x, series.y[index]]),
  };
  if (series.style === 'points') {
    return { ...common, type: 'scatter', symbolSize: series.emphasis ? 8 : 6 };
  }
  return {
    ...common, type: 'line', symbol: 'circle', symbolSize: ordered ? 5 : 3,
    showSymbol: !ordered || series.x.length <= FEW_POINTS, connectNulls: false,
    lineStyle: { color: colour, width: series.emphasis ? 2.6 : 1.5, type: DASHES[series.style] ?? 'solid' },
  };
}

// The first item draws the whole outline; the others only stretch the y axis.
function bandSeries(series, theme) {
  const { x, band } = series;
  const outline = [
    ...x.map((value, index) => [value, band.lo[index]]),
    ...x.map((value, index) => [value, band.hi[index]]).reverse(),
  ].filter(([, value]) => Number.isFinite(value));
  return {
    id: `band:${series.name}`, type: 'custom', silent: true, clip: true, progressive: 0, z: 1,
    tooltip: { show: false }, encode: { x: 0, y: [1, 2] },
    data: x.map((value, index) => [value, band.lo[index], band.hi[index]]),
    renderItem: (params, api) => (params.dataIndex > 0 ? null : {
      type: 'polygon', silent: true,
      shape: { points: outline.map((point) => api.coord(point)) },
      style: { fill: theme.colourOf(series.name), opacity: 0.16 },
    }),
  };
}

// The bare wheel is left to the page, which must scroll across its charts.
function zoomControls(slider, theme) {
  const inside = {
    id: 'wheel', type: 'inside', filterMode: 'none', zoomOnMouseWheel: 'ctrl', preventDefaultMouseMove: false,
  };
  if (!slider) return [inside];
  return [inside, {
    id: 'slider', type: 'slider', filterMode: 'none', height: 16, bottom: 6, left: 44, right: 24,
    showDataShadow: false, showDetail: false, brushSelect: false, borderColor: theme.grid,
    backgroundColor: 'transparent', fillerColor: theme.grid, handleSize: 16,
    moveHandleSize: 0, handleStyle: { color: theme.surface, borderColor: theme.muted },
  }];
}

// All curves at the pointer. ECharts alone would leave out those whose nearest
// point is further away than that of another curve.
function crosshairTooltip(section, shown, theme, xDigits, yDigits) {
  return tooltip(theme, {
    trigger: 'axis',
    formatter(hits) {
      const at = hits[0].axisValue;
      const rows = shown.filter((series) => series.x.length).map((series) => {
        const index = nearestIndex(series.x, at);
        const band = series.band
          ? `  [${quantity(null, series.band.lo[index], yDigits)} … ${quantity(null, series.band.hi[index], yDigits)}]` : '';
        return {
          colour: theme.colourOf(series.name), name: series.name,
          text: quantity(section.y, series.y[index], yDigits) + band,
        };
      });
      return tooltipTable(`${section.x?.label ?? 'x'} ${quantity(section.x, at, xDigits)}`, rows);
    },
  });
}

// A path that turns back has no single value at an x, so its points speak for themselves.
function pointTooltip(section, theme, xDigits, yDigits) {
  return tooltip(theme, {
    trigger: 'item',
    formatter: ({ seriesName, value }) => tooltipTable(seriesName, [
      { name: section.x?.label ?? 'x', text: quantity(section.x, value[0], xDigits) },
      { name: section.y?.label ?? 'y', text: quantity(section.y, value[1], yDigits) },
    ]),
  });
}

// The one place that says how a chart of a report looks: section in, ECharts
// option out. The page and the SVG figures both draw from here.

import { barsOption } from './charts/bars.mjs';
import { heatmapOption } from './charts/heatmap.mjs';
import { histogramOption } from './charts/histogram.mjs';
import { iso230Option } from './charts/iso230_2.mjs';
import { linesOption } from './charts/lines.mjs';
import { placesOption } from './charts/places.mjs';
import { polarOption } from './charts/polar.mjs';
import { volumeOption } from './charts/volume.mjs';
import { limitsOf, niceRange, yExtent } from './series.mjs';

const BUILDERS = {
  lines: linesOption, bars: barsOption, heatmap: heatmapOption, histogram: histogramOption,
  iso230_2: iso230Option, polar: polarOption, volume: volumeOption, places: placesOption,
};

// view, all optional:
//   width      width of the drawing in pixels, and its
//   height
//   turn       {yaw, pitch} in degrees: from where a volume or places are looked at
//   hidden     Set of series names not to draw
//   yRange     {min, max, interval} that replaces the chart's own y range
//   zoom       true: Ctrl + wheel or a pinch zooms, dragging moves
//   slider     true: a long curve gets a slider to zoom with
//   maxPoints  lines with more points are thinned
export function chartOption(section, theme, view = {}) {
  const build = BUILDERS[section.type];
  if (!build) throw new Error(`there is no chart of type "${section.type}"`);
  return {
    animation: false,
    backgroundColor: 'transparent',
    textStyle: { fontFamily: theme.font, color: theme.ink },
    ...build(section, theme, { width: 800, hidden: new Set(), maxPoints: 6000, ...view }),
  };
}

// The y range that all charts of a group share, or undefined if each has its own.
export function sharedRange(group, hidden) {
  if (!group.shared_y) return undefined;
  const range = yExtent(group.charts, hidden);
  if (!range) return undefined;
  // As the charts do on their own: the words at a limit need some room.
  const gap = group.charts.some((chart) => limitsOf(chart).length) ? 0.05 * (range[1] - range[0]) : 0;
  return niceRange([range[0] - gap, range[1] + gap]);
}

// Places in the work volume, seen from outside: points by series, in the box of the travels.
// Parallel projection, turned as the volume of error vectors is.

import { extent } from '../series.mjs';
import { quantity, tooltip, tooltipTable, visibleSeries } from './parts.mjs';
import { boxCorners, boxSeries, projection, screenRange, VIEWS, wheelZoom } from './volume.mjs';

const SIZE = 8;  // pixels

export function placesOption(section, theme, view) {
  const project = projection(view.turn ?? VIEWS.oblique);
  const everything = section.series.flatMap((series) => series.points);
  const box = section.box ?? [0, 1, 2].map((k) => extent(everything.map((point) => point[k])) ?? [0, 1]);
  const range = screenRange([...boxCorners(box), ...everything].map(project), view);
  const axis = (ends) => ({ type: 'value', min: ends[0], max: ends[1], show: false });
  return {
    grid: { left: 0, right: 0, top: 0, bottom: 0 },
    xAxis: axis(range.x), yAxis: axis(range.y),
    dataZoom: wheelZoom(view),
    tooltip: tooltip(theme, { trigger: 'item' }),
    series: [
      boxSeries(box, project, theme, section),
      ...visibleSeries(section, view).map((series) => pointSeries(section, series, project, theme)),
    ],
  };
}

function pointSeries(section, series, project, theme) {
  const colour = theme.colourOf(series.name);
  const open = series.style === 'open';
  return {
    id: `places:${series.name}`, name: series.name, type: 'scatter', z: open ? 4 : 3, data: series.points.map(project),
    symbol: 'circle', symbolSize: SIZE, emphasis: { disabled: true },
    itemStyle: open ? { color: theme.surface, borderColor: colour, borderWidth: 1.6 }
      : { color: colour, borderColor: theme.surface, borderWidth: 0.8 },
    tooltip: tooltip(theme, {
      formatter({ dataIndex }) {
        const label = series.labels?.[dataIndex];
        return tooltipTable(label ? `${series.name}: ${label}` : series.name, [section.x, section.y, section.z].map((axis, k) => ({
          name: axis.label, text: quantity(axis, series.points[dataIndex][k], 1),
        })));
      },
    }),
  };
}

// Error vectors over the work volume, seen from outside: arrows at the points of a
// grid, magnified, in the box of the travels. Parallel projection.

import { digitsFor, formatNumber, withUnit } from '../format.mjs';
import { extent, niceStep } from '../series.mjs';
import { quantity, tooltip, tooltipTable, visibleSeries } from './parts.mjs';

// Degrees about Z, then above the horizon.
export const VIEWS = {
  oblique: { yaw: -35, pitch: 25 },
  'from the front (X Z)': { yaw: 0, pitch: 0 },
  'from the side (Y Z)': { yaw: 90, pitch: 0 },
  'from above (X Y)': { yaw: 0, pitch: 90 },
};

// Point or vector in mm → right and up on the screen, in mm.
export function projection({ yaw, pitch }) {
  const [a, b] = [yaw, pitch].map((degrees) => (degrees * Math.PI) / 180);
  return ([x, y, z]) => {
    const right = x * Math.cos(a) + y * Math.sin(a);
    const away = -x * Math.sin(a) + y * Math.cos(a);
    return [right, z * Math.cos(b) + away * Math.sin(b)];
  };
}

export function volumeOption(section, theme, view) {
  const project = projection(view.turn ?? VIEWS.oblique);
  const box = [0, 1, 2].map((k) => extent(section.points.map((point) => point[k])) ?? [0, 1]);
  const corners = boxCorners(box);
  const range = screenRange(corners.map(project), view);
  const shown = visibleSeries(section, view);
  const axis = (ends) => ({ type: 'value', min: ends[0], max: ends[1], show: false });
  return {
    title: {
      text: `arrows ${formatNumber(section.magnification)} : 1`, right: 16, top: 6, padding: 0,
      textStyle: { color: theme.muted, fontSize: 12, fontWeight: 'normal' },
    },
    grid: { left: 0, right: 0, top: 0, bottom: 0 },
    xAxis: axis(range.x), yAxis: axis(range.y),
    dataZoom: wheelZoom(view),
    tooltip: tooltip(theme, { trigger: 'item' }),
    series: [
      boxSeries(box, project, theme, section),
      ...shown.map((series) => arrowSeries(section, series, project, theme)),
      scaleSeries(section, range, theme),
    ],
  };
}

export const boxCorners = (box) => [0, 1, 2, 3, 4, 5, 6, 7].map((bits) => box.map((ends, k) => ends[(bits >> k) & 1]));

// Ctrl + wheel alone: dragging turns.
export const wheelZoom = (view) => (view.zoom ? ['x', 'y'].map((name) => ({
  id: `wheel-${name}`, type: 'inside', [`${name}AxisIndex`]: 0, filterMode: 'none', zoomOnMouseWheel: 'ctrl',
  moveOnMouseMove: false, preventDefaultMouseMove: false,
})) : []);

// Equal scales, whatever the shape of the drawing; room for arrows and names around the box.
export function screenRange(points, { width, height = 420 }) {
  const [x, y] = [0, 1].map((k) => extent(points.map((point) => point[k])));
  const spans = [x, y].map(([low, high]) => high - low || 1);
  const scale = Math.max(spans[0] / Math.max(80, width - 120), spans[1] / Math.max(80, height - 96));
  const around = (ends, pixels) => {
    const middle = (ends[0] + ends[1]) / 2;
    return [middle - (scale * pixels) / 2, middle + (scale * pixels) / 2];
  };
  return { x: around(x, width), y: around(y, height), scale };
}

export function boxSeries(box, project, theme, section) {
  const corners = boxCorners(box);
  const edges = corners.flatMap((_, from) => [1, 2, 4].filter((bit) => !(from & bit)).map((bit) => [from, from | bit]));
  const data = edges.map(([from, to]) => [...project(corners[from]), ...project(corners[to])]);
  // The three edges at the first corner carry the names and ends of the axes.
  const named = new Map([1, 2, 4].map((bit, k) => [edges.findIndex(([from, to]) => from === 0 && to === bit), k]));
  const axes = [section.x, section.y, section.z];
  return {
    id: 'box', type: 'custom', silent: true, z: 1, data, encode: { x: [0, 2], y: [1, 3] }, tooltip: { show: false },
    renderItem(params, api) {
      const [x1, y1] = api.coord([api.value(0), api.value(1)]);
      const [x2, y2] = api.coord([api.value(2), api.value(3)]);
      const k = named.get(params.dataIndex);
      const edge = {
        type: 'line', shape: { x1, y1, x2, y2 },
        style: { stroke: k === undefined ? theme.rule : theme.muted, lineWidth: k === undefined ? 1 : 1.4 },
      };
      if (k === undefined || Math.hypot(x2 - x1, y2 - y1) < 12) return edge;
      const label = `${axes[k].label} ${box[k].map((end) => formatNumber(end, 0)).join(' … ')}\u00a0${axes[k].unit}`;
      return {
        type: 'group',
        children: [edge, {
          type: 'text', x: (x1 + x2) / 2 + (k === 2 ? -8 : 0), y: (y1 + y2) / 2 + (k === 2 ? 0 : 20),
          rotation: k === 2 ? Math.PI / 2 : 0,
          style: { text: label, fill: theme.muted, font: `12px ${theme.font}`, align: 'center', verticalAlign: 'middle' },
        }],
      };
    },
  };
}

function arrowSeries(section, series, project, theme) {
  const colour = theme.colourOf(series.name);
  const mm = section.magnification / 1000;
  const data = section.points.map((point, i) => {
    const tip = point.map((value, k) => value + mm * series.vectors[i][k]);
    return [...project(point), ...project(tip)];
  });
  const lengths = series.vectors.map((vector) => Math.hypot(...vector));
  const digits = digitsFor({}, Math.max(...lengths));
  return {
    id: `arrows:${series.name}`, name: series.name, type: 'custom', data, z: 3, encode: { x: [0, 2], y: [1, 3], tooltip: [0] },
    emphasis: { disabled: true }, itemStyle: { color: colour },
    renderItem: (params, api) => arrow(api.coord([api.value(0), api.value(1)]), api.coord([api.value(2), api.value(3)]), colour),
    tooltip: tooltip(theme, {
      formatter({ dataIndex }) {
        const vector = series.vectors[dataIndex];
        const axes = [section.x, section.y, section.z];
        return tooltipTable(`${series.name} ${withUnit(formatNumber(lengths[dataIndex], digits), section.unit)}`, axes.map((axis, k) => ({
          name: `${axis.label} ${quantity(axis, section.points[dataIndex][k], 0)}`,
          text: withUnit(formatNumber(vector[k], digits), section.unit),
        })));
      },
    }),
  };
}

// A wide line that nobody sees catches the pointer.
function arrow([x1, y1], [x2, y2], colour) {
  const length = Math.hypot(x2 - x1, y2 - y1);
  const head = Math.min(7, 0.5 * length);
  const turn = Math.atan2(y2 - y1, x2 - x1);
  const wing = (side) => [x2 - head * Math.cos(turn + side * 0.42), y2 - head * Math.sin(turn + side * 0.42)];
  const shape = { x1, y1, x2, y2 };
  return {
    type: 'group',
    children: [
      { type: 'line', shape, style: { stroke: colour, lineWidth: 9, opacity: 0 } },
      { type: 'circle', shape: { cx: x1, cy: y1, r: 1.6 }, style: { fill: colour } },
      { type: 'line', shape, style: { stroke: colour, lineWidth: 1.6 } },
      { type: 'polygon', shape: { points: [[x2, y2], wing(1), wing(-1)] }, style: { fill: colour } },
    ],
  };
}

// A round length as long as it is drawn, at the lower left.
function scaleSeries(section, { x, y, scale }, theme) {
  const mmPerUnit = section.magnification / 1000;
  const round = niceStep((50 * scale) / mmPerUnit);
  const start = [x[0] + 16 * scale, y[0] + 20 * scale];
  return {
    id: 'scale', type: 'custom', silent: true, z: 5, data: [[...start, start[0] + round * mmPerUnit]],
    encode: { x: [0, 2], y: 1 }, tooltip: { show: false },
    renderItem(params, api) {
      const from = api.coord([api.value(0), api.value(1)]);
      const to = api.coord([api.value(2), api.value(1)]);
      return {
        type: 'group',
        children: [arrow(from, to, theme.ink), {
          type: 'text', x: to[0] + 8, y: to[1],
          style: { text: withUnit(formatNumber(round), section.unit), fill: theme.ink, font: `12px ${theme.font}`, verticalAlign: 'middle' },
        }],
      };
    },
  };
}

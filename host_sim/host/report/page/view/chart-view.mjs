// Charts on the page: their legend, their size and their redrawing.

import { chartOption, sharedRange } from '../charts.mjs';
import * as echarts from '../echarts-parts.mjs';
import { VIEWS } from '../charts/volume.mjs';
import { legendEntries, SPATIAL_TYPES } from '../series.mjs';
import { element, note } from './dom.mjs';
import { makeLegend } from './legend.mjs';

// Draws the charts of one section under one legend. Returns the node to show and
// draw(theme, onPaper), to be called once the node is in the page and on every change of either.
export function makeFigure(section) {
  const isGroup = section.type === 'group';
  const charts = isGroup ? section.charts : [section];
  const canvases = charts.map((chart) => makeCanvas(chart, isGroup));
  const entries = legendEntries(charts);
  let theme;
  let slider;
  const redraw = () => {
    const yRange = isGroup ? sharedRange(section, legend.hidden) : undefined;
    canvases.forEach((canvas) => canvas.draw(theme, { hidden: legend.hidden, yRange, slider, zoom: true }));
  };
  const legend = makeLegend(entries, redraw);
  const views = isGroup || !SPATIAL_TYPES.includes(section.type) ? null : makeViews(canvases[0]);
  const body = isGroup
    ? element('div', { class: 'small-multiples' }, ...canvases.map((canvas) => canvas.node))
    : canvases[0].node;
  return {
    node: element('div', { class: isGroup ? '' : 'figure' }, entries.length > 1 ? legend.node : null, views, body, note(section)),
    draw(newTheme, onPaper) {
      theme = newTheme;
      slider = !onPaper;
      legend.paint(theme);
      redraw();
    },
  };
}

// ECharts swallows every wheel event over a chart that can zoom, also those it does
// not zoom on; the page could not scroll across its charts.
function leavePlainWheelToPage(target) {
  const keepFromChart = (event) => {
    if (!event.ctrlKey) event.stopPropagation();
  };
  for (const type of ['wheel', 'mousewheel']) target.addEventListener(type, keepFromChart, { capture: true, passive: true });
}

// Buttons for the usual sides of a volume.
function makeViews(canvas) {
  const buttons = Object.entries(VIEWS).map(([name, turn]) => {
    const button = element('button', { type: 'button' }, name);
    button.addEventListener('click', () => canvas.turnTo(turn));
    return button;
  });
  return element('div', { class: 'views', role: 'group', 'aria-label': 'Seen' }, ...buttons);
}

const DEGREES_PER_PIXEL = 0.4;

function turnByDragging(target, current, turnTo) {
  let from = null;
  target.addEventListener('pointerdown', (event) => {
    from = { x: event.clientX, y: event.clientY, ...current() };
    target.setPointerCapture(event.pointerId);
  });
  target.addEventListener('pointermove', (event) => {
    if (!from) return;
    const pitch = from.pitch + DEGREES_PER_PIXEL * (event.clientY - from.y);
    turnTo({ yaw: from.yaw - DEGREES_PER_PIXEL * (event.clientX - from.x), pitch: Math.min(90, Math.max(-90, pitch)) });
  });
  for (const type of ['pointerup', 'pointercancel']) target.addEventListener(type, () => { from = null; });
}

// One ECharts instance, made at the first drawing, when its element has a size.
function makeCanvas(chart, inGroup) {
  const size = inGroup ? 'small' : chart.type;
  const target = element('div', { class: `chart ${size}`, role: 'img', 'aria-label': chart.title });
  const size3d = SPATIAL_TYPES.includes(chart.type);
  let instance;
  let drawAgain;
  let turn = size3d ? { ...VIEWS.oblique } : undefined;

  function turnTo(wanted) {
    turn = { ...wanted };
    drawAgain?.();
  }

  function draw(theme, view) {
    instance ??= start();
    drawAgain = () => {
      const option = chartOption(chart, theme, { ...view, turn, width: target.clientWidth, height: target.clientHeight });
      instance.setOption(option, { replaceMerge: ['series', 'dataZoom'] });
    };
    instance.resize();
    drawAgain();
  }

  function start() {
    const started = echarts.init(target, null, { renderer: 'svg' });
    leavePlainWheelToPage(target);
    target.addEventListener('dblclick', () => started.dispatchAction({
      type: 'dataZoom', batch: (started.getOption().dataZoom ?? []).map((_, dataZoomIndex) => ({ dataZoomIndex, start: 0, end: 100 })),
    }));
    if (size3d) turnByDragging(target, () => turn, turnTo);
    new ResizeObserver(() => {
      if (started.getWidth() === target.clientWidth) return;
      started.resize();
      drawAgain();
    }).observe(target);
    return started;
  }

  const heading = inGroup ? element('h4', { id: chart.id }, chart.title) : null;
  return { draw, turnTo, node: element('div', { class: inGroup ? 'figure' : '' }, heading, target, inGroup ? note(chart) : null) };
}

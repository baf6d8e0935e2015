// Charts on the page: their legend, their size and their redrawing.

import { chartOption, sharedRange } from '../charts.mjs';
import * as echarts from '../echarts-parts.mjs';
import { legendEntries } from '../series.mjs';
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
  const body = isGroup
    ? element('div', { class: 'small-multiples' }, ...canvases.map((canvas) => canvas.node))
    : canvases[0].node;
  return {
    node: element('div', { class: isGroup ? '' : 'figure' }, entries.length > 1 ? legend.node : null, body, note(section)),
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

// One ECharts instance, made at the first drawing, when its element has a size.
function makeCanvas(chart, inGroup) {
  const size = inGroup ? 'small' : chart.type;
  const target = element('div', { class: `chart ${size}`, role: 'img', 'aria-label': chart.title });
  let instance;
  let drawAgain;

  function draw(theme, view) {
    instance ??= start();
    drawAgain = () => {
      const option = chartOption(chart, theme, { ...view, width: target.clientWidth });
      instance.setOption(option, { replaceMerge: ['series', 'dataZoom'] });
    };
    instance.resize();
    drawAgain();
  }

  function start() {
    const started = echarts.init(target, null, { renderer: 'svg' });
    leavePlainWheelToPage(target);
    target.addEventListener('dblclick', () => started.dispatchAction({ type: 'dataZoom', start: 0, end: 100 }));
    new ResizeObserver(() => {
      if (started.getWidth() === target.clientWidth) return;
      started.resize();
      drawAgain();
    }).observe(target);
    return started;
  }

  const heading = inGroup ? element('h3', { id: chart.id }, chart.title) : null;
  return { draw, node: element('div', { class: inGroup ? 'figure' : '' }, heading, target, inGroup ? note(chart) : null) };
}

// Entry of the live page: asks the server for the state of the run and shows it, until it has ended.

import { seriesNames } from './series.mjs';
import { makeTheme } from './theme.mjs';
import { makeFigure } from './view/chart-view.mjs';
import { element } from './view/dom.mjs';
import { makeVerdict } from './view/frame.mjs';
import { makeTable } from './view/table.mjs';
import { formatNumber, withUnit } from './format.mjs';

const EVERY_MS = 250;
const MOST_SAMPLES = 600;

const PHASES = { running: 'running', ended: 'the run has ended', failed: 'the run has failed', lost: 'the run was stopped' };

const AXES = {
  type: 'table',
  columns: [
    { title: 'axis' }, { title: 'target', digits: 4 }, { title: 'encoder', digits: 4 }, { title: 'unit' },
    { title: 'correction', digits: 3 }, { title: 'unit' }, { title: 'probe edges', digits: 0 }, { title: 'drive' }, { title: 'correction is' },
  ],
};
const HITS = {
  type: 'table',
  columns: [{ title: 'edges', digits: 0 }, { title: 'machine time', unit: 's', digits: 3 }, { title: 'latched by' }, { title: 'machine at' }],
};

const words = (names) => (names.length ? names.join(', ') : 'as computed');
const part = (id, title) => ({ id, body: element('div', {}), title });

function axisRows(axes) {
  return axes.map((axis) => [
    axis.axis, axis.target, axis.position, axis.unit, axis.correction, axis.correction_unit, axis.probe_edges, axis.drive ?? '\u2013',
    axis.states ? words(axis.states) : 'told by the node for all axes',
  ]);
}

function hitRows(hits) {
  return hits.map(({ number, time_s: time, axes, at }) => [
    number, time, axes, at.map((place) => `${place.axis} ${withUnit(formatNumber(place.position, 4), place.unit)}`).join(', '),
  ]);
}

function tiles(state) {
  const { bus } = state;
  const entries = [
    ['machines so far', 'machines', formatNumber(state.machine)], ['machine time', 'time', withUnit(formatNumber(state.time_s, 2), 's')],
    ['probe edges', 'edges', formatNumber(state.probe_edges)],
    ...(bus ? [
      ['bus load now', 'load', withUnit(formatNumber(bus.load_percent, 1), '%')], ['node', 'node', bus.node],
      ['compensation', 'node-state', bus.node_state], ['status of all axes', 'status', words(bus.states)],
      ['emergency messages', 'emergencies', formatNumber(bus.emergencies)],
    ] : [['bus', 'load', 'none: beside the controller']]),
  ];
  return entries.map(([name, id, value]) => element('div', {}, element('dt', {}, name), element('dd', { id }, value)));
}

// The corrections of the last seconds. Lengths and angles have a chart each.
class History {
  #charts = new Map();

  constructor(place) {
    this.place = place;
  }

  add(state) {
    for (const axis of state.axes) {
      const chart = this.#charts.get(axis.correction_unit) ?? this.#begin(axis.correction_unit);
      let series = chart.section.series.find(({ name }) => name === axis.axis);
      if (!series) {
        series = { name: axis.axis, x: [], y: [] };
        chart.section.series.push(series);
        chart.figure = undefined;
      }
      if (series.x.at(-1) === state.time_s) continue;
      series.x.push(state.time_s);
      series.y.push(axis.correction);
      if (series.x.length > MOST_SAMPLES) [series.x, series.y].forEach((values) => values.shift());
    }
  }

  #begin(unit) {
    const chart = {
      box: element('div', {}),
      section: {
        type: 'lines', title: `corrections in ${unit}`, x: { label: 'machine time', unit: 's' }, y: { label: 'correction', unit }, series: [],
      },
    };
    this.#charts.set(unit, chart);
    this.place.append(chart.box);
    return chart;
  }

  draw() {
    const mode = matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light';
    for (const chart of this.#charts.values()) {
      if (!chart.figure) {
        chart.figure = makeFigure(chart.section);
        chart.box.replaceChildren(chart.figure.node);
      }
      chart.figure.draw(makeTheme(mode, seriesNames([chart.section])), true);
    }
  }
}

function begin() {
  const parts = [
    part('axes', 'Axes'), part('corrections', 'Corrections'), part('hits', 'Last edges of the touch probe'),
    part('ticks', 'Counted so far'), part('result', 'Result'),
  ];
  const page = {
    phase: element('span', { class: 'phase', id: 'phase', role: 'status' }, PHASES.running),
    title: element('p', { class: 'subtitle', id: 'command' }), bar: element('progress', { max: 1, value: 0 }),
    doing: element('span', { id: 'doing' }), verdict: element('div', { id: 'verdict' }), tiles: element('dl', { class: 'tiles' }),
    ...Object.fromEntries(parts.map(({ id, body }) => [id, body])),
  };
  page.resultSection = element('section', { id: 'result', hidden: true }, element('h2', { class: 'title' }, 'Result'), page.result);
  const sections = parts.filter(({ id }) => id !== 'result')
    .map(({ id, title, body }) => element('section', { id }, element('h2', { class: 'title' }, title), body));
  document.body.append(element(
    'main', {},
    element('header', {}, element('h1', {}, 'volcomp run ', page.phase), page.title, element('p', { class: 'doing' }, page.bar, page.doing), page.verdict),
    page.resultSection, page.tiles, ...sections,
  ));
  page.history = new History(page.corrections);
  return page;
}

function showPhase(page, phase) {
  page.phase.className = `phase ${phase}`;
  page.phase.textContent = PHASES[phase];
  document.documentElement.dataset.phase = phase;
}

function show(page, state) {
  page.title.textContent = `${state.command} \u00b7 ${state.transport}`;
  page.bar.value = state.progress.done;
  page.doing.textContent = state.progress.what;
  page.tiles.replaceChildren(...tiles(state));
  page.axes.replaceChildren(makeTable({ ...AXES, rows: axisRows(state.axes) }));
  page.hits.replaceChildren(makeTable({ ...HITS, rows: hitRows(state.hits) }));
  page.ticks.replaceChildren(...state.ticks.map(makeTable));
  page.history.add(state);
  page.history.draw();
  showPhase(page, state.phase);
  if (state.outcome) showOutcome(page, state.outcome);
  document.documentElement.dataset.shown = String(Number(document.documentElement.dataset.shown ?? 0) + 1);
}

function showOutcome(page, outcome) {
  page.verdict.replaceChildren(makeVerdict(outcome.verdict));
  if (!outcome.result) return;
  page.result.replaceChildren(makeTable(outcome.result));
  if (outcome.report) page.result.append(element('p', { class: 'note' }, element('a', { href: 'report.html' }, 'The whole report')));
  page.resultSection.hidden = false;
}

async function follow(page) {
  for (;;) {
    let state;
    try {
      const answer = await fetch('state.json');
      if (!answer.ok) throw new Error(`status ${answer.status}`);
      state = await answer.json();
    } catch {
      showPhase(page, 'lost');
      return;
    }
    show(page, state);
    if (state.phase !== 'running') return;
    await new Promise((resolve) => { setTimeout(resolve, EVERY_MS); });
  }
}

follow(begin());

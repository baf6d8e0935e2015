// Values on hover: the pointer goes over a chart, and what appears there must be in the JSON.

import { readNumber, shows } from './checks.mjs';

const PLACES = [0.12, 0.3, 0.5, 0.7, 0.85];
const ENOUGH = 3;

// The tip that is open in chart `index`, as heading and rows; null: none.
const tipOf = (index) => `(() => {
  const tip = document.querySelectorAll('.chart')[${index}].querySelector('.tip');
  if (!tip) return null;
  const style = getComputedStyle(tip.parentElement);
  if (style.visibility === 'hidden' || style.display === 'none' || Number(style.opacity) < 1) return null;
  return { heading: tip.querySelector('b').textContent,
    rows: [...tip.querySelectorAll('tr')].map((row) => [...row.cells].map((cell) => cell.textContent)) };
})()`;

const boxOf = (index) => `(() => {
  const chart = document.querySelectorAll('.chart')[${index}];
  chart.scrollIntoView({ block: 'center', behavior: 'instant' });
  const box = chart.getBoundingClientRect();
  return { x: box.x, y: box.y, width: box.width, height: box.height };
})()`;

// Middles of the small marks of a chart: single points, cells, arrows.
const marksOf = (index, most) => `[...document.querySelectorAll('.chart')[${index}].querySelectorAll('svg path')]
  .map((path) => path.getBoundingClientRect()).filter((b) => b.width > 1 && b.height > 1 && b.width < ${most} && b.height < ${most})
  .map((b) => ({ x: b.x + b.width / 2, y: b.y + b.height / 2 }))`;

// The places to point at: along the chart for what answers anywhere, single marks for what does not.
async function places(page, chart, index) {
  const box = await page.value(boxOf(index));
  const grid = [0.35, 0.55, 0.75].flatMap((v) => PLACES.map((u) => ({ x: box.x + u * box.width, y: box.y + v * box.height })));
  if (!['volume', 'places', 'lines', 'histogram'].includes(chart.type)) return grid;
  const marks = await page.value(marksOf(index, chart.type === 'histogram' ? box.height : 60));
  const step = Math.max(1, Math.floor(marks.length / 30));
  return [...grid, ...marks.filter((_, i) => i % step === 0)];
}

const withName = (chart, name) => chart.series.find((series) => series.name === name);
const afterLabel = (text, axis) => (text.startsWith(`${axis?.label ?? 'x'} `) ? text.slice((axis?.label ?? 'x').length + 1) : text);

// "−1.2 µm  [−1.5 µm … −0.9 µm]": value and band.
const band = (text) => /^(.*?)\s+\[(.*) … (.*)\]$/s.exec(text)?.slice(1) ?? [text];

function curvesAgree(chart, { heading, rows }) {
  const at = readNumber(afterLabel(heading, chart.x))?.value;
  return rows.length > 0 && rows.every(([name, text]) => {
    const series = withName(chart, name);
    const near = [...series.x.keys()].sort((a, b) => Math.abs(series.x[a] - at) - Math.abs(series.x[b] - at)).slice(0, 2);
    const [value, low, high] = band(text);
    return near.some((i) => shows(value, series.y[i])
      && (low === undefined || (shows(low, series.band.lo[i]) && shows(high, series.band.hi[i]))));
  });
}

function pointAgrees(chart, { heading, rows }) {
  const series = withName(chart, heading);
  return series.x.some((x, i) => shows(rows[0][1], x) && shows(rows[1][1], series.y[i]));
}

function barsAgree(chart, { heading, rows }) {
  const index = chart.categories.indexOf(heading);
  return index >= 0 && rows.every(([name, text]) => shows(text, withName(chart, name).values[index] ?? null));
}

function cellAgrees(chart, { heading, rows }) {
  const text = afterLabel(heading, chart.z);
  return chart.z.values.some((row, r) => shows(rows[1][1], chart.y.values[r])
    && row.some((value, c) => shows(rows[0][1], chart.x.values[c]) && shows(text, value ?? null)));
}

function binAgrees(chart, { heading, rows }) {
  const [low, high] = heading.replace(/\u00a0.*$/, '').split(' … ').map((text) => readNumber(text).value);
  const room = 1e-9 * (Math.abs(low) + Math.abs(high));
  return rows.every(([name, text]) => {
    const { values } = withName(chart, name);
    const surely = values.filter((v) => v > low + room && v < high - room).length;
    const perhaps = values.filter((v) => v >= low - room && v <= high + room).length;
    return Number(text) >= surely && Number(text) <= perhaps;
  });
}

function arrowAgrees(chart, { heading, rows }) {
  const series = chart.series.find(({ name }) => heading.startsWith(`${name} `));
  return series.vectors.some((vector, i) => shows(heading.slice(series.name.length + 1), Math.hypot(...vector))
    && vector.every((value, k) => shows(rows[k][1], value))
    && chart.points[i].every((value, k) => shows(afterLabel(rows[k][0], [chart.x, chart.y, chart.z][k]), value)));
}

// "series: label", or the series alone where places have no labels.
function placeAgrees(chart, { heading, rows }) {
  return chart.series.some(({ name, points, labels }) => points.some((point, i) => heading === (labels ? `${name}: ${labels[i]}` : name)
    && point.every((value, k) => shows(rows[k][1], value))));
}

function figureAgrees(chart, { heading, rows }) {
  if (!/^[AREBM] /.test(heading)) return curvesAgree(chart, { heading, rows });
  return shows(heading.slice(2), chart.figures[heading[0]]);
}

// Angles go on beyond a turn in the JSON, and within one on the page.
function circleAgrees(chart, { heading, rows }) {
  const at = readNumber(afterLabel(heading, chart.x))?.value;
  const off = (x) => Math.abs(((((x - at) % 360) + 540) % 360) - 180);
  return rows.length > 0 && rows.every(([name, text]) => {
    const series = withName(chart, name);
    return series.x.some((x, i) => off(x) < 1.5 && shows(text, series.y[i]));
  });
}

const isAscending = (values) => values.every((value, i) => i === 0 || value >= values[i - 1]);
const AGREES = {
  lines: (chart, tip) => (chart.series.every(({ x }) => isAscending(x)) ? curvesAgree : pointAgrees)(chart, tip),
  iso230_2: figureAgrees, bars: barsAgree, heatmap: cellAgrees, polar: circleAgrees, histogram: binAgrees, volume: arrowAgrees,
  places: placeAgrees,
};

// Points at chart number `index` of the page until enough tips have been seen.
export async function checkTips(page, failures, chart, index) {
  let seen = 0;
  for (const { x, y } of await places(page, chart, index)) {
    await page.mouse('mouseMoved', x, y);
    const tip = await page.value(tipOf(index));
    if (!tip) continue;
    failures.check(AGREES[chart.type](chart, tip), `tip in chart "${chart.title}": ${JSON.stringify(tip)} is not in the JSON`);
    if (++seen >= ENOUGH) break;
  }
  failures.check(seen > 0, `no value appears when pointing at the chart "${chart.title}"`);
}

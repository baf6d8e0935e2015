// Curves as they are drawn: every point of the JSON where the labels of the axes say it must be.

import { readNumber } from './checks.mjs';

const NEAR = 0.6;           // pixels
const LEFT_OUT = 1.4;       // pixels: what is nearer to the point before need not be drawn
const MOST_POINTS = 6000;   // longer curves are drawn with fewer points

const drawn = (index) => `(() => {
  const svg = document.querySelectorAll('.chart')[${index}].querySelector('svg');
  const place = (text) => (/translate\\(([-\\d.]+)[ ,]([-\\d.]+)\\)/.exec(text.getAttribute('transform') ?? '') ?? []).slice(1).map(Number);
  const labels = (anchor) => [...svg.querySelectorAll('text[text-anchor=' + anchor + ']')]
    .map((text) => ({ text: text.textContent, at: place(text) })).filter(({ at }) => at.length === 2);
  return { x: labels('middle'), y: labels('end'),
    paths: [...svg.querySelectorAll('g[clip-path] path[fill=none]')].map((path) => path.getAttribute('d')) };
})()`;

// From value to pixel by the outermost labels: the lines of the page are straight.
function scale(labels, k) {
  const known = labels.map(({ text, at }) => ({ read: readNumber(text), pixel: at[k] })).filter(({ read }) => read?.rest === '' && read.value !== null)
    .map(({ read, pixel }) => ({ value: read.value, pixel })).sort((a, b) => a.value - b.value);
  const [low, high] = [known[0], known.at(-1)];
  if (!low || low.value === high.value) return undefined;
  return (value) => low.pixel + ((value - low.value) * (high.pixel - low.pixel)) / (high.value - low.value);
}

const vertices = (d) => [...d.matchAll(/([ML])\s*([-\d.e]+)[ ,]([-\d.e]+)/g)].map(([, , x, y]) => [Number(x), Number(y)]);

// All points in their order; those left out are as good as at the one before.
function follows(points, wanted) {
  const near = ([px, py], [qx, qy], distance) => Math.abs(px - qx) < distance && Math.abs(py - qy) < distance;
  let next = 0;
  for (const point of wanted) {
    if (next < points.length && near(points[next], point, NEAR)) ++next;
    else if (next === 0 || !near(points[next - 1], point, LEFT_OUT)) return false;
  }
  return next === points.length;
}

function isDrawn(series, paths, x, y) {
  const wanted = series.x.map((value, i) => [value, series.y[i]]).filter(([, value]) => Number.isFinite(value)).map(([a, b]) => [x(a), y(b)]);
  return paths.some((points) => points.length > 0 && follows(points, wanted));
}

// Returns how many points were held against the JSON.
export async function checkCurves(page, failures, chart, index) {
  if (!['lines', 'iso230_2'].includes(chart.type)) return 0;
  const picture = await page.value(drawn(index));
  const [x, y] = [scale(picture.x, 0), scale(picture.y, 1)];
  if (!failures.check(x && y, `the axes of chart "${chart.title}" have no labels`)) return 0;
  const paths = picture.paths.map(vertices);
  let points = 0;
  for (const series of chart.series) {
    if (series.style === 'points' || series.x.length > MOST_POINTS) continue;
    failures.check(isDrawn(series, paths, x, y), `curve "${series.name}" of chart "${chart.title}" is not drawn as the JSON has it`);
    points += series.x.length;
  }
  return points;
}

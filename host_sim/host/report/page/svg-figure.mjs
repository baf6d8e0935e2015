// A chart, or a group of charts, as a still SVG picture with title and legend.

import { chartOption, sharedRange } from './charts.mjs';
import { init } from './echarts-parts.mjs';
import { escapeMarkup } from './format.mjs';
import { chartsOf, legendEntries, seriesNames } from './series.mjs';
import { makeTheme } from './theme.mjs';

const MARGIN = 16;
const GAP = 18;
const LEGEND_LINE = 22;
const NARROWEST_CHART = 340;  // of a group; narrower ones go below each other

// The picture is opaque and light with a thin frame, so it looks the same and
// intended on a light and on a dark web page.
export function svgFigure(section, report, { width, height }) {
  const theme = makeTheme('light', seriesNames(chartsOf(report)));
  const charts = section.type === 'group' ? section.charts : [section];
  const legend = drawLegend(charts, theme, width - 2 * MARGIN);
  const top = MARGIN + 24 + legend.height;
  const box = { x: MARGIN, y: top, width: width - 2 * MARGIN, height: height - top - MARGIN + 6 };
  const body = section.type === 'group' ? drawGroup(section, theme, box) : drawChart(section, theme, box);
  return [
    `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" width="${width}" height="${height}"`
      + ` role="img" aria-label="${escapeMarkup(section.title)}" font-family="${theme.font}">`,
    `<rect x=".5" y=".5" width="${width - 1}" height="${height - 1}" rx="6" fill="${theme.surface}" stroke="${theme.rule}"/>`,
    words(MARGIN, MARGIN + 13, 16, theme.ink, section.title, ' font-weight="600"'),
    legend.markup, body, '</svg>\n',
  ].join('\n');
}

function drawChart(chart, theme, box, yRange) {
  const instance = init(null, null, { renderer: 'svg', ssr: true, width: box.width, height: box.height });
  instance.setOption(chartOption(chart, theme, { width: box.width, height: box.height, maxPoints: box.width, yRange }));
  const drawing = slim(instance.renderToSVGString({ useViewBox: false }));
  instance.dispose();
  return `<g transform="translate(${box.x} ${box.y})">${drawing}</g>`;
}

function drawGroup(group, theme, box) {
  const columns = Math.max(1, Math.min(2, group.charts.length, Math.floor(box.width / NARROWEST_CHART)));
  const rows = Math.ceil(group.charts.length / columns);
  const width = Math.floor((box.width - GAP * (columns - 1)) / columns);
  const height = Math.floor((box.height - GAP * (rows - 1)) / rows);
  const yRange = sharedRange(group, new Set());
  return group.charts.map((chart, index) => {
    const x = box.x + (index % columns) * (width + GAP);
    const y = box.y + Math.floor(index / columns) * (height + GAP);
    const title = words(x, y + 12, 13, theme.ink, chart.title, ' font-weight="600"');
    return title + drawChart(chart, theme, { x, y: y + 20, width, height: height - 20 }, yRange);
  }).join('\n');
}

// Breaks into lines by the estimated width of the names. One series needs no legend.
function drawLegend(charts, theme, room) {
  const entries = legendEntries(charts);
  if (entries.length < 2) return { height: 0, markup: '' };
  let x = 0;
  let line = 0;
  const markup = entries.map(({ name, look }) => {
    const width = 28 + 7.2 * name.length + 18;
    if (x > 0 && x + width > room) [x, line] = [0, line + 1];
    const y = MARGIN + 24 + line * LEGEND_LINE + 10;
    const left = MARGIN + x;
    x += Math.round(width);
    return swatch(look, left, y, theme.colourOf(name)) + words(left + 28, y + 4, 13, theme.ink, name);
  });
  return { height: (line + 1) * LEGEND_LINE + 6, markup: markup.join('\n') };
}

function swatch(look, x, y, colour) {
  if (look === 'points') return `<circle cx="${x + 16}" cy="${y}" r="4" fill="${colour}"/>`;
  if (look === 'block') return `<rect x="${x + 10}" y="${y - 6}" width="12" height="12" rx="2" fill="${colour}"/>`;
  const dash = look === 'dashed' ? ' stroke-dasharray="6 3"' : '';
  return `<path d="M${x} ${y}h22" stroke="${colour}" stroke-width="3"${dash}/>`;
}

function words(x, y, size, colour, text, more = '') {
  return `<text x="${x}" y="${y}" font-size="${size}" fill="${colour}"${more}>${escapeMarkup(text)}</text>`;
}

const hexByte = (text) => Number(text).toString(16).padStart(2, '0');

// Shortens what ECharts writes: a tenth of a pixel is plenty, a still picture has no
// pointer to react to, and the font is already named by the picture itself.
function slim(svg) {
  const shorten = (number, digits) => String(Number(Number(number).toFixed(digits)));
  const round = (text, digits) => text.replace(/-?\d*\.\d+(e-?\d+)?/g, (number) => shorten(number, digits));
  return svg
    .replace(/<style[^]*?<\/style>/g, '')
    .replace(/ (ecmeta_[\w-]+|class|pointer-events|xmlns|xmlns:xlink|version|baseProfile)="[^"]*"/g, '')
    .replace(/font-family:[^;"]*;?/g, '')
    .replace(/rgb\((\d+),(\d+),(\d+)\)/g, (_, ...parts) => `#${parts.slice(0, 3).map(hexByte).join('')}`)
    .replace(/><\/(path|rect|circle)>/g, '/>')
    .replace(/ (d|points|x|y|x1|x2|y1|y2|width|height)="([^"]*)"/g, (_, name, value) => ` ${name}="${round(value, 1)}"`)
    .replace(/ transform="([^"]*)"/g, (_, value) => ` transform="${round(value, 3)}"`);
}

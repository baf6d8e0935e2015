// Pieces that several kinds of chart are made of.

import { axisTitle, escapeMarkup, formatNumber, formatTick, withUnit } from '../format.mjs';
import { limitsOf, niceStep } from '../series.mjs';

const LIMIT_WORDS = 58;  // pixels to the right of the plot

// Axis labels and titles are inside the margins, whatever their width.
export function grid(margins = {}) {
  return {
    left: 4, right: 14, top: 8, bottom: 4, ...margins,
    outerBoundsMode: 'same', outerBoundsContain: 'all',
  };
}

export const visibleSeries = (section, view) =>
  section.series.filter((series) => !view.hidden.has(series.name));

function axisLook(axis, theme) {
  return {
    name: axisTitle(axis),
    nameTextStyle: { color: theme.muted, fontSize: 12 },
    axisLine: { show: true, onZero: false, lineStyle: { color: theme.rule } },
    axisTick: { show: true, lineStyle: { color: theme.rule } },
    axisLabel: { color: theme.muted, fontSize: 12, hideOverlap: true },
    splitLine: { lineStyle: { color: theme.grid } },
    axisPointer: { lineStyle: { color: theme.muted, type: 'solid', width: 1 }, label: { show: false } },
  };
}

export function xAxis(axis, theme, extra = {}) {
  const look = axisLook(axis, theme);
  return {
    ...look, nameLocation: 'middle', nameGap: 26, ...extra,
    axisLabel: { ...look.axisLabel, ...extra.axisLabel },
  };
}

// The y title stands level above the axis: easier to read and narrower than a turned one.
export function yAxis(axis, theme, extra = {}) {
  const look = axisLook(axis, theme);
  return {
    ...look, nameLocation: 'end', nameGap: 12, ...extra,
    nameTextStyle: { ...look.nameTextStyle, align: 'left', padding: [0, 0, 0, -28] },
    axisLabel: { ...look.axisLabel, ...extra.axisLabel },
  };
}

export const valueScale = (extra = {}) => ({
  type: 'value', ...extra, axisLabel: { formatter: formatTick, ...extra.axisLabel },
});

// The two ends of an x axis. They are where the data end, and get a label only if
// that is a round number: "700" and "707" side by side help nobody.
export function xEnds(min, max) {
  const round = niceStep((max - min || 1) / 10);
  const isRound = (value) => Math.abs(value / round - Math.round(value / round)) < 1e-6;
  return { min, max, axisLabel: { showMinLabel: isRound(min), showMaxLabel: isRound(max) } };
}

// Keeps the words at a limit clear of the labels of the other axis.
export const limitGap = (section) => (limitsOf(section).length ? ['5%', '5%'] : [0, 0]);

// The right margin of a chart; the words at a horizontal limit stand there.
export const rightMargin = (section) => (limitsOf(section).length ? LIMIT_WORDS : 14);

// Dashed lines at the limits of a chart. Each also has an invisible point there,
// since a mark line alone does not widen the axis; anchor is that point's other
// coordinate.
export function limitSeries(section, theme, { along, unit, anchor }) {
  return limitsOf(section).map((limit, index) => ({
    id: `limit:${index}`, type: 'line', silent: true, symbol: 'none', tooltip: { show: false },
    data: [along === 'y' ? [anchor, limit] : [limit, anchor]],
    markLine: {
      silent: true, symbol: 'none', animation: false,
      lineStyle: { color: theme.limit, type: [6, 4], width: 1.2 },
      label: {
        formatter: `limit${along === 'y' ? '\n' : ' '}${withUnit(formatTick(limit), unit)}`,
        position: 'end', color: theme.limit, fontSize: 11.5, lineHeight: 16,
      },
      data: [along === 'y' ? { yAxis: limit } : { xAxis: limit }],
    },
  }));
}

export function tooltip(theme, extra) {
  return {
    className: 'hover', confine: true, transitionDuration: 0, backgroundColor: theme.surface, borderColor: theme.rule,
    padding: [8, 10], textStyle: { color: theme.ink, fontSize: 12.5, fontFamily: theme.font },
    extraCssText: 'box-shadow:0 2px 10px rgba(0,0,0,.15);border-radius:4px', ...extra,
  };
}

// rows: {colour, name, text}; colour may be absent.
export function tooltipTable(heading, rows) {
  const body = rows.map(({ colour, name, text }) => {
    const swatch = colour ? `<i class="dot" style="background:${colour}"></i>` : '';
    return `<tr><td>${swatch}${escapeMarkup(name)}</td><td>${escapeMarkup(text)}</td></tr>`;
  });
  return `<div class="tip"><b>${escapeMarkup(heading)}</b><table>${body.join('')}</table></div>`;
}

export const quantity = (axis, value, digits) => withUnit(formatNumber(value, digits), axis?.unit);

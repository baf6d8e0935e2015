// Tables: numbers to the right with fixed decimals, text to the left.

import { formatNumber } from '../format.mjs';
import { element, note } from './dom.mjs';

export function makeTable(section) {
  const shown = [...section.columns.keys()].filter((index) => !section.columns[index].hidden);
  const numeric = section.columns.map((_, index) => section.rows.some((row) => typeof row[index] === 'number'));
  const align = (index) => (numeric[index] ? 'number' : undefined);
  const head = shown.map((index) => headCell(section.columns[index], align(index)));
  const rows = section.rows.map((row, rowIndex) => element(
    'tr', { class: rowIndex === section.highlight_row ? 'highlight' : undefined },
    ...shown.map((index) => element('td', { class: align(index) }, cellText(row[index], section.columns[index]))),
  ));
  const table = element(
    'table', { class: 'data' },
    section.head === false ? null : element('thead', {}, element('tr', {}, ...head)),
    element('tbody', {}, ...rows),
  );
  return element('div', { class: 'figure' }, element('div', { class: 'scroller' }, table), note(section));
}

const headCell = (column, side) => element(
  'th', { class: side, scope: 'col' },
  column.title, column.unit ? element('span', { class: 'unit' }, column.unit) : null,
);

const cellText = (cell, column) => (typeof cell === 'string' ? cell : formatNumber(cell, column.digits));

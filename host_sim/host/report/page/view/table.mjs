// Tables: numbers to the right with fixed decimals, text to the left.

import { formatNumber } from '../format.mjs';
import { element, note } from './dom.mjs';

export function makeTable(section) {
  const numeric = section.columns.map((_, index) => section.rows.some((row) => typeof row[index] === 'number'));
  const align = (index) => (numeric[index] ? 'number' : undefined);
  const head = section.columns.map((column, index) => element(
    'th', { class: align(index), scope: 'col' },
    column.title, column.unit ? element('span', { class: 'unit' }, column.unit) : null,
  ));
  const rows = section.rows.map((row, rowIndex) => element(
    'tr', { class: rowIndex === section.highlight_row ? 'highlight' : undefined },
    ...section.columns.map((column, index) => element('td', { class: align(index) }, cellText(row[index], column))),
  ));
  const table = element(
    'table', { class: 'data' }, element('thead', {}, element('tr', {}, ...head)), element('tbody', {}, ...rows),
  );
  return element('div', { class: 'figure' }, element('div', { class: 'scroller' }, table), note(section));
}

const cellText = (cell, column) => (typeof cell === 'string' ? cell : formatNumber(cell, column.digits));

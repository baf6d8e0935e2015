// What surrounds the sections: heading, verdict, table of contents, provenance.

import { element } from './dom.mjs';

export function makeHeader(report) {
  return element(
    'header', {},
    element('h1', {}, report.title ?? 'Report'),
    report.subtitle ? element('p', { class: 'subtitle' }, report.subtitle) : null,
    report.verdict ? makeVerdict(report.verdict) : null,
  );
}

// The word and the sign say it too, for print and for those who cannot tell red from green.
export function makeVerdict({ ok, text }) {
  return element(
    'p', { class: `verdict ${ok ? 'pass' : 'fail'}`, role: 'status' },
    element('b', {}, ok ? '\u2713 Pass' : '\u2717 Fail'), element('span', {}, text),
  );
}

export function makeContents(entries) {
  const links = entries.flatMap(({ id, title, chapter }) => [
    chapter ? element('li', { class: 'chapter' }, chapter) : null,
    element('li', {}, element('a', { href: `#${id}` }, title)),
  ].filter(Boolean));
  return element('nav', { 'aria-label': 'Contents' }, element('ol', {}, ...links));
}

export function makeProvenance(rows = []) {
  const body = rows.map(([name, value]) => element(
    'tr', {}, element('th', { scope: 'row' }, name), element('td', {}, String(value ?? '\u2013')),
  ));
  return element(
    'details', { id: 'provenance' },
    element('summary', {}, 'Provenance: how to get this report again'),
    element('table', { class: 'provenance' }, element('tbody', {}, ...body)),
  );
}

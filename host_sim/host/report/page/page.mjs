// Entry of the page: reads the report's JSON out of the page and shows it.

import { CHART_TYPES, chartsOf, prepared, seriesNames } from './series.mjs';
import { makeTheme } from './theme.mjs';
import { makeFigure } from './view/chart-view.mjs';
import { element } from './view/dom.mjs';
import { makeContents, makeHeader, makeProvenance } from './view/frame.mjs';
import { makeTable } from './view/table.mjs';

// The body of a section, plus draw(theme) if there is something to draw.
function makeBody(section) {
  if (section.type === 'text') {
    return { node: element('div', { class: 'text' }, ...section.paragraphs.map((text) => element('p', {}, text))) };
  }
  if (section.type === 'table') return { node: makeTable(section) };
  if (section.type === 'group' || CHART_TYPES.includes(section.type)) return makeFigure(section);
  return { node: element('p', { class: 'note' }, `This page cannot show a section of type "${section.type}".`) };
}

const beginsChapter = (sections, index) =>
  Boolean(sections[index].chapter) && sections[index].chapter !== sections[index - 1]?.chapter;

function build(report) {
  const bodies = report.sections.map(makeBody);
  const ids = report.sections.map((section, index) => section.id ?? `section-${index + 1}`);
  const inChapters = report.sections.some((section) => section.chapter);
  const sections = report.sections.flatMap((section, index) => [
    beginsChapter(report.sections, index) ? element('h2', { class: 'chapter' }, section.chapter) : null,
    element('section', { id: ids[index], class: section.type },
      element(inChapters ? 'h3' : 'h2', { class: 'title' }, section.title), bodies[index].node),
  ]);
  const contents = report.sections.map((section, index) => ({
    id: ids[index], title: section.title, chapter: beginsChapter(report.sections, index) ? section.chapter : null,
  }));
  const hint = element(
    'p', { class: 'hint' }, 'Charts: hover for values, click a name to hide its curve, Ctrl + wheel or a pinch to zoom, ',
    'drag to move or to turn a volume, double click to see all again.',
  );
  const footer = element('footer', {}, 'The data of this page: ', element('a', { href: 'report.json' }, 'report.json'));
  document.title = report.title ?? 'Report';
  document.body.append(
    makeContents([...contents, { id: 'provenance', title: 'Provenance' }]),
    element('main', {}, makeHeader(report), chartsOf(report).length ? hint : null, ...sections,
      makeProvenance(report.provenance), footer),
  );
  return bodies.filter((body) => body.draw);
}

// Paper is light and as wide as A4; the class gives the page that width before
// the browser lays it out for print, so that the charts can be drawn to fit.
function followThemeAndPrint(draw) {
  const dark = matchMedia('(prefers-color-scheme: dark)');
  const onScreen = () => draw(dark.matches ? 'dark' : 'light', false);
  dark.addEventListener('change', onScreen);
  addEventListener('beforeprint', () => {
    document.documentElement.classList.add('printing');
    document.getElementById('provenance').open = true;
    draw('light', true);
  });
  addEventListener('afterprint', () => {
    document.documentElement.classList.remove('printing');
    onScreen();
  });
  onScreen();
}

function show() {
  const report = prepared(JSON.parse(document.getElementById('report-data').textContent));
  const figures = build(report);
  const names = seriesNames(chartsOf(report));
  followThemeAndPrint((mode, onPaper) => {
    const theme = makeTheme(mode, names);
    figures.forEach((figure) => figure.draw(theme, onPaper));
  });
}

// data-report on <html> tells a test in a headless browser how it went.
try {
  show();
  document.documentElement.dataset.report = 'ready';
} catch (error) {
  document.documentElement.dataset.report = 'failed';
  document.body.append(element('p', { class: 'verdict fail' }, `This report cannot be shown: ${error.message}`));
  throw error;
}

// node report_test.mjs NAME FOLDER VOLCOMP COMMAND …
//
// The report of a command in a headless browser: no complaint of the console and no request to anywhere,
// every text and number of the page as in report.json, values on hover, zoom, light, dark and on
// paper. FOLDER/NAME keeps the report and the pictures.

import { mkdir, readFile, rm } from 'node:fs/promises';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { withBrowser } from './browser.mjs';
import { checkTable, Failures, readNumber, run, shows, TABLES } from './checks.mjs';
import { checkCurves } from './curves.mjs';
import { checkLabels } from './labels.mjs';
import { checkTips } from './tips.mjs';

// The curves of ISO 230-2 follow from its means and deviations.
function withSeries(chart) {
  if (chart.type !== 'iso230_2') return chart;
  const { positions: x, up, down } = chart;
  const of = ({ mean, s }) => ({ x, y: mean, band: { lo: mean.map((m, i) => m - 2 * s[i]), hi: mean.map((m, i) => m + 2 * s[i]) } });
  return { ...chart, series: [
    { name: 'upwards', ...of(up) }, { name: 'downwards', ...of(down) },
    { name: 'mean of both', x, y: x.map((_, i) => (up.mean[i] + down.mean[i]) / 2) },
  ] };
}

const chartsOf = (report) => report.sections.flatMap((section) => {
  if (section.type === 'group') return section.charts;
  return ['table', 'text'].includes(section.type) ? [] : [section];
}).map(withSeries);

async function checkTexts(page, failures, report) {
  const text = (selector) => page.value(`document.querySelector(${JSON.stringify(selector)})?.textContent ?? ''`);
  const texts = (selector) => page.value(`[...document.querySelectorAll(${JSON.stringify(selector)})].map((node) => node.textContent)`);
  failures.same(await text('h1'), report.title, 'title');
  failures.same(await page.value('document.title'), report.title, 'title of the window');
  failures.same(await text('.subtitle'), report.subtitle ?? '', 'subtitle');
  if (report.verdict) {
    failures.same(await text('.verdict span'), report.verdict.text, 'verdict');
    failures.same(await page.value('document.querySelector(".verdict").classList.contains("pass")'), report.verdict.ok, 'colour of the verdict');
  } else {
    failures.same(await page.value('document.querySelector(".verdict")'), null, 'there is no verdict');
  }
  failures.same((await texts('.title')).join('|'), report.sections.map(({ title }) => title).join('|'), 'titles of sections');
  const notes = report.sections.flatMap((section) => (section.type === 'group'
    ? [...section.charts.map((chart) => chart.note), section.note] : [section.note])).filter(Boolean);
  failures.same((await texts('.note')).join('|'), notes.join('|'), 'notes');
  failures.same((await texts('table.provenance tr')).join('|'), report.provenance.map((row) => row.join('')).join('|'), 'provenance');
}

async function checkTables(page, failures, report) {
  const shown = await page.value(TABLES);
  const tables = report.sections.filter(({ type }) => type === 'table');
  if (!failures.same(shown.length, tables.length, 'tables')) return 0;
  return tables.reduce((count, section, index) => count + checkTable(failures, shown[index], section), 0);
}

// What is written inside a chart: the figures of ISO 230-2, the magnification of arrows.
async function checkInscriptions(page, failures, charts) {
  for (const [index, chart] of charts.entries()) {
    const words = await page.value(`[...document.querySelectorAll('.chart')[${index}].querySelectorAll('svg text')].map((t) => t.textContent)`);
    if (chart.type === 'iso230_2') {
      const line = words.find((text) => /^A .*M /.test(text)) ?? '';
      for (const [name, value] of Object.entries(chart.figures)) {
        const read = new RegExp(`(?:^| )${name} ([-\u2212\\d.]+)`).exec(line)?.[1] ?? '';
        failures.check(shows(read, value), `${name} of "${chart.title}": the chart says "${read}", the JSON ${value}`);
      }
    }
    if (chart.type !== 'volume') continue;
    const read = readNumber((words.find((text) => text.startsWith('arrows ')) ?? '').slice(7));
    failures.same(read?.value, chart.magnification, `magnification of "${chart.title}"`);
  }
}

// Ctrl + wheel over the first curves: another picture; a double click: the first again.
async function checkZoom(page, failures, charts) {
  const index = charts.findIndex(({ type }) => type === 'lines');
  if (index < 0) return;
  const drawing = () => page.value(`document.querySelectorAll('.chart')[${index}].querySelector('svg').innerHTML`);
  const box = await page.value(`(() => {
    const chart = document.querySelectorAll('.chart')[${index}];
    chart.scrollIntoView({ block: 'center', behavior: 'instant' });
    const { x, y, width, height } = chart.getBoundingClientRect();
    return { x: x + width / 2, y: y + height / 2 };
  })()`);
  const labels = () => page.value(`[...document.querySelectorAll('.chart')[${index}].querySelectorAll('svg text')].map((t) => t.textContent).join('|')`);
  const away = () => page.mouse('mouseMoved', 2, 2);
  await away();
  await page.settled();
  const [before, names] = [await drawing(), await labels()];
  for (const notch of [1, 2, 3]) await page.mouse('mouseWheel', box.x, box.y, { deltaX: 0, deltaY: -400 / notch, modifiers: 2 });
  const zoomed = async () => await drawing() !== before && await labels() !== names;
  for (let waits = 0; waits < 50 && !(await zoomed()); ++waits) await page.settled();
  failures.check(await zoomed(), `Ctrl + wheel does not zoom "${charts[index].title}"`);
  for (const clickCount of [1, 2]) {
    for (const type of ['mousePressed', 'mouseReleased']) await page.mouse(type, box.x, box.y, { button: 'left', clickCount });
  }
  await away();
  for (let waits = 0; waits < 50 && await labels() !== names; ++waits) await page.settled();
  failures.same(await labels(), names, `a double click does not show all of "${charts[index].title}" again`);
}

async function takePictures(page, failures, folder) {
  await page.value('scrollTo(0, 0)');
  for (const scheme of ['light', 'dark']) {
    await page.media('screen', scheme);
    await page.settled();
    const brightness = await page.value(`getComputedStyle(document.querySelector('main')).backgroundColor.match(/\\d+/g).slice(0, 3).reduce((a, b) => a + Number(b), 0) / 3`);
    failures.check(scheme === 'light' ? brightness > 200 : brightness < 60, `the page is not ${scheme}: brightness ${brightness} of 255`);
    await page.screenshot(join(folder, `${scheme}.png`));
  }
  const pages = await page.pdf(join(folder, 'print.pdf'));
  failures.check(pages > 0, 'nothing comes out on paper');
}

// A4 less its margins; what belongs to the screen stays away.
async function checkPaper(page, failures, charts) {
  await page.media('print', 'dark');
  await page.value('dispatchEvent(new Event("beforeprint"))');
  await page.settled();
  await checkLabels(page, failures, charts, 'on paper');
  const wide = await page.value(`[...document.querySelectorAll('main, .chart svg, table')].map((node) => node.getBoundingClientRect().right)
    .filter((right) => right > document.querySelector('main').getBoundingClientRect().right + 2).length`);
  failures.same(wide, 0, 'what is wider than the paper');
  failures.same(await page.value('getComputedStyle(document.querySelector("nav")).display'), 'none', 'contents on paper');
  failures.same(await page.value('document.getElementById("provenance").open'), true, 'provenance on paper is open');
  failures.check(await page.value('[...document.querySelectorAll(".chart svg")].every((svg) => svg.querySelector("path"))'), 'an empty chart on paper');
  await page.value('dispatchEvent(new Event("afterprint"))');
  await page.media('screen', 'light');
}

async function main([name, results, ...command]) {
  if (!command.length) throw new Error('usage: node report_test.mjs NAME FOLDER VOLCOMP COMMAND …');
  const failures = new Failures(name);
  const folder = join(results, name);
  await rm(folder, { recursive: true, force: true });
  await mkdir(folder, { recursive: true });
  const { code, output } = await run(command[0], [...command.slice(1), '--report', folder]);
  if (!failures.check(code === 0, `the run ended with ${code}: ${output}`)) return failures.end();

  const report = JSON.parse(await readFile(join(folder, 'report.json'), 'utf8'));
  const charts = chartsOf(report);
  const url = pathToFileURL(join(folder, 'report.html')).href;
  const begun = Date.now();
  let numbers = 0;
  let points = 0;
  let labels = 0;
  await withBrowser(async (browser) => {
    const page = await browser.newPage();
    await page.open(url);
    await page.until('document.documentElement.dataset.report !== undefined');
    failures.same(await page.value('document.documentElement.dataset.report'), 'ready', 'state of the page');
    await checkTexts(page, failures, report);
    numbers = await checkTables(page, failures, report);
    failures.same(await page.value('document.querySelectorAll(".chart svg").length'), charts.length, 'charts');
    await checkInscriptions(page, failures, charts);
    for (const [index, chart] of charts.entries()) points += await checkCurves(page, failures, chart, index);
    for (const [index, chart] of charts.entries()) await checkTips(page, failures, chart, index);
    await checkZoom(page, failures, charts);
    labels = await checkLabels(page, failures, charts, 'on a wide screen');
    await page.size(700, 900);
    await page.settled();
    await checkLabels(page, failures, charts, 'on a narrow screen');
    await page.size(1240, 900);
    await page.settled();
    await checkPaper(page, failures, charts);
    await takePictures(page, failures, folder);
    const foreign = page.requests.filter((address) => address !== url && !address.startsWith('data:'));
    failures.same(foreign.join(' '), '', 'requests to elsewhere');
    failures.same(page.complaints.join(' | '), '', 'complaints of the console');
  });
  failures.check(labels > 10, `only ${labels} labels in charts`);
  failures.check(numbers > 10, `only ${numbers} numbers in tables`);
  console.log(`${name}: ${numbers} numbers in tables, ${points} points of curves, ${charts.length} charts with ${labels} labels, ${Date.now() - begun} ms in the browser`);
  return failures.end();
}

await main(process.argv.slice(2));

// node render-svg.mjs REPORT.json CHART_ID [--width 900] [--height 420] > OUT.svg
// Draws one chart, or one group of charts, of a report as a still picture.

import { readFile } from 'node:fs/promises';
import { parseArgs } from 'node:util';
import { CHART_TYPES, prepared } from './series.mjs';
import { svgFigure } from './svg-figure.mjs';

const USAGE = 'usage: node render-svg.mjs REPORT.json CHART_ID [--width 900] [--height 420] > OUT.svg';

// A mistake of the caller: one sentence, no stack trace.
class UsageError extends Error {}

function parse(argv) {
  let parsed;
  try {
    parsed = parseArgs({ args: argv, allowPositionals: true, options: {
      width: { type: 'string', default: '900' }, height: { type: 'string' },
    } });
  } catch {
    throw new UsageError(USAGE);
  }
  const [file, id, ...rest] = parsed.positionals;
  if (!id || rest.length) throw new UsageError(USAGE);
  return { file, id, width: pixels('width', parsed.values.width), height: pixels('height', parsed.values.height) };
}

function pixels(name, text) {
  if (text === undefined) return undefined;
  if (!/^\d+$/.test(text) || text < 200 || text > 4000) {
    throw new UsageError(`--${name} must be a whole number of pixels from 200 to 4000, not "${text}".`);
  }
  return Number(text);
}

async function load(file) {
  const text = await readFile(file, 'utf8').catch((error) => {
    throw new UsageError(`Cannot read ${file}: ${error.code}.`);
  });
  try {
    return prepared(JSON.parse(text));
  } catch (error) {
    throw new UsageError(`${file} is not valid JSON: ${error.message}.`);
  }
}

function find(report, id, file) {
  const figures = (report.sections ?? [])
    .flatMap((section) => (section.type === 'group' ? [section, ...section.charts] : [section]))
    .filter((section) => section.id && (section.type === 'group' || CHART_TYPES.includes(section.type)));
  const found = figures.find((section) => section.id === id);
  if (found) return found;
  const known = figures.map((section) => section.id).join(', ') || 'none';
  throw new UsageError(`${file} has no chart "${id}"; its charts are: ${known}.`);
}

async function main(argv) {
  const { file, id, width, height } = parse(argv);
  const report = await load(file);
  const section = find(report, id, file);
  const usual = section.type === 'group' ? 320 * Math.max(2, Math.ceil(section.charts.length / 2)) : 420;
  process.stdout.write(svgFigure(section, report, { width, height: height ?? usual }));
}

main(process.argv.slice(2)).catch((error) => {
  console.error(`render-svg.mjs: ${error instanceof UsageError ? error.message : error.stack}`);
  process.exitCode = error instanceof UsageError ? 2 : 1;
});

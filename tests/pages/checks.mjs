// What the tests of pages have in common: failures, how a number reads on a page, and whether it is
// that of the JSON.

import { spawn } from 'node:child_process';

export class Failures {
  count = 0;
  #what;

  constructor(what) {
    this.#what = what;
  }

  check(condition, sentence) {
    if (!condition) this.#say(sentence);
    return Boolean(condition);
  }

  same(found, expected, sentence) {
    return this.check(found === expected, `${sentence}: the page says "${found}", the JSON "${expected}"`);
  }

  #say(sentence) {
    ++this.count;
    if (this.count <= 20) console.error(`FAILED ${this.#what}: ${sentence}`);
  }

  end() {
    if (this.count > 20) console.error(`FAILED ${this.#what}: ${this.count - 20} more`);
    process.exitCode = this.count ? 1 : 0;
  }
}

const MINUS = '\u2212';
const DASH = '\u2013';

// "−1.25 µm" → {value: -1.25, digits: 2, rest: "µm"}; a dash is null; anything else undefined.
export function readNumber(text) {
  const trimmed = text.trim();
  if (trimmed === DASH || trimmed.startsWith(`${DASH}\u00a0`)) return { value: null, digits: 0, rest: trimmed.slice(2) };
  const match = /^([-\u2212]?\d+(?:\.(\d+))?(?:e[-+\u2212]?\d+)?)\s?(.*)$/s.exec(trimmed);
  if (!match) return undefined;
  return { value: Number(match[1].replaceAll(MINUS, '-')), digits: match[2]?.length ?? 0, rest: match[3] };
}

// Whether a text shows a value of the JSON: rounded to the decimals that are shown, not otherwise changed.
export function shows(text, value) {
  if (typeof value === 'string') return text === value;
  const read = readNumber(text);
  if (!read) return false;
  if (value === null || value === undefined) return read.value === null;
  if (read.value === null) return false;
  return Math.abs(read.value - value) <= 0.5 * 10 ** -read.digits * (1 + 1e-6) + 1e-12 * Math.abs(value);
}

// Runs a program to its end: {code, signal, output}.
export function run(command, args) {
  const child = spawn(command, args, { stdio: ['ignore', 'pipe', 'pipe'] });
  return finished(child);
}

export function finished(child) {
  let output = '';
  for (const stream of [child.stdout, child.stderr]) stream.setEncoding('utf8').on('data', (text) => { output += text; });
  return new Promise((resolve, reject) => {
    child.on('error', reject);
    child.on('close', (code, signal) => resolve({ code, signal, output }));
  });
}

// Tables as they stand on a page, and the texts of their cells.
export const TABLES = `[...document.querySelectorAll('table.data')].map((table) => ({
  section: table.closest('section')?.id ?? '',
  head: [...table.tHead.rows[0].cells].map((cell) => cell.textContent),
  rows: [...table.tBodies[0].rows].map((row) => [...row.cells].map((cell) => cell.textContent)),
}))`;

export function checkTable(failures, shown, section) {
  const name = `table "${section.title ?? section.id}"`;
  // Hidden columns must not be on the page.
  const columns = section.columns.map((column, index) => ({ ...column, index })).filter(({ hidden }) => !hidden);
  failures.same(shown.head.join('|'), columns.map((column) => column.title + (column.unit ?? '')).join('|'), `head of ${name}`);
  if (!failures.same(shown.rows.length, section.rows.length, `rows of ${name}`)) return 0;
  let numbers = 0;
  section.rows.forEach((row, r) => columns.forEach(({ digits, index }, c) => {
    const text = shown.rows[r][c];
    const value = row[index] ?? null;
    failures.check(shows(text, value), `${name}, row ${r + 1}, column ${c + 1}: the page says "${text}", the JSON ${JSON.stringify(value)}`);
    if (typeof value !== 'number') return;
    ++numbers;
    if (digits !== undefined) failures.same(readNumber(text)?.digits, digits, `decimals of ${name}, row ${r + 1}, column ${c + 1}`);
  }));
  return numbers;
}

// node seeds_test.mjs FOLDER VOLCOMP
//
// Nothing in a report is typed in. The same command gives the same report; another seed gives other
// numbers where the seed acts, the same ones where it does not, and the report says which seed it was.

import { mkdir, readFile, rm, writeFile } from 'node:fs/promises';
import { createHash } from 'node:crypto';
import { join } from 'node:path';
import { Failures, run } from './checks.mjs';

const failures = new Failures('seeds');
const [folder, volcomp] = process.argv.slice(2);

async function report(name, ...command) {
  const target = join(folder, name);
  const { code, output } = await run(volcomp, ['run', ...command, '--report', target]);
  failures.check(code === 0 || code === 1, `${command.join(' ')} ended with ${code}: ${output}`);
  return JSON.parse(await readFile(join(target, 'report.json'), 'utf8'));
}

// All numbers of a document by their place in it.
function numbers(value, place = '', found = new Map()) {
  if (typeof value === 'number') found.set(place, value);
  else if (value && typeof value === 'object') Object.entries(value).forEach(([key, inner]) => numbers(inner, `${place}/${key}`, found));
  return found;
}

const section = (document, id) => document.sections.find((candidate) => candidate.id === id);
// Cells of a table and points of curves; not how many decimals they have.
const data = (part) => [...numbers(part)].filter(([place]) => !/(digits|highlight_row|bins)$/.test(place));
const changed = (one, other) => {
  const before = new Map(data(one));
  return data(other).filter(([place, value]) => before.get(place) !== value).length;
};
// The command names the folder of the report and thus differs.
const lines = (document) => document.provenance.filter(([name]) => name !== 'command').map((row) => row.join(': '));

function differs(one, other, ids, what) {
  for (const id of ids) {
    const part = section(one, id);
    if (!failures.check(part && section(other, id), `${what}: there is no section "${id}"`)) continue;
    failures.check(changed(part, section(other, id)) > 0, `${what}: "${part.title}" stays the same`);
  }
  failures.check(lines(one).join() !== lines(other).join(), `${what}: the provenance does not say that something else was run`);
}

function isSame(one, other, ids, what) {
  for (const id of ids) {
    failures.check(section(one, id), `${what}: there is no section "${id}"`);
    failures.same(changed(section(one, id) ?? {}, section(other, id) ?? {}), 0, `${what}: numbers of "${id}" that changed`);
  }
}

async function xyfz() {
  const quick = ['xyfz', '--draws', '2', '--volume-points', '50'];
  const one = await report('xyfz', ...quick, '--seed', '1');
  const again = await report('xyfz_again', ...quick, '--seed', '1');
  failures.same(changed(one, again), 0, 'the same command twice: numbers that changed');
  failures.same(lines(again).join(), lines(one).join(), 'the same command twice: provenance');
  const other = await report('xyfz_seed', ...quick, '--seed', '2');
  differs(one, other, ['positioning', 'positioning-figures', 'draws', 'before-after', 'functions'], 'another --seed');
  isSame(one, other, ['diagonals', 'volume', 'faces'], 'another --seed, noise-free');
  failures.check(lines(other).includes('noise seed: 2'), 'the noise seed is not told');
  const machine = await report('xyfz_machine', ...quick, '--machine-seed', '2');
  differs(one, machine, ['diagonals', 'volume', 'faces', 'before-after', 'models', 'positioning', 'functions', 'ticks-axes'], 'another --machine-seed');
  failures.check(machine.verdict.text !== one.verdict.text, 'another --machine-seed: the verdict stays the same');
}

async function l300g() {
  const varied = ['l300g', '--noise-free', '--errors', 'p8-variation'];
  const one = await report('l300g', ...varied, '--seed', '1');
  const other = await report('l300g_seed', ...varied, '--seed', '2');
  differs(one, other, ['before-after', 'functions', 'ticks-axes'], 'l300g, another --seed');
}

async function faceGear() {
  const one = await report('face_gear', 'face-gear', '--seed', '1');
  const other = await report('face_gear_seed', 'face-gear', '--seed', '2');
  differs(one, other, ['before-after', 'ticks-axes'], 'face-gear, another --seed');
}

async function internalHelical() {
  const one = await report('helical', 'internal-helical', '--seeds', '1');
  const other = await report('helical_two', 'internal-helical', '--seeds', '2');
  differs(one, other, ['before-after', 'deviations', 'ticks-run'], 'internal-helical, more seeds');
}

// What the report says it has read is what there is: another file, another sum.
async function inputs() {
  const text = await readFile(join(import.meta.dirname ?? new URL('.', import.meta.url).pathname, '../../host_sim/machines/xyfz.toml'), 'utf8');
  const machine = join(folder, 'mine.toml');
  await writeFile(machine, `${text}# mine\n`);
  const document = await report('xyfz_mine', 'xyfz', '--draws', '1', '--volume-points', '50', '--machine', machine);
  const told = (name) => document.inputs.find((file) => file.name === name);
  const sum = async (path) => createHash('sha256').update(await readFile(path)).digest('hex');
  failures.same(told('mine.toml')?.sha256, await sum(machine), 'SHA-256 of the machine file');
  failures.same(told('mine.toml')?.bytes, Buffer.byteLength(`${text}# mine\n`), 'size of the machine file');
  for (const name of ['runs_X.csv', 'runs_Y.csv', 'runs_Z.csv']) {
    failures.same(told(name)?.sha256, await sum(join(folder, 'xyfz_mine/campaign/draw_001', name)), `SHA-256 of ${name}`);
  }
}

await rm(folder, { recursive: true, force: true });
await mkdir(folder, { recursive: true });
for (const part of [xyfz, l300g, faceGear, internalHelical, inputs]) await part();
failures.end();

// node live_test.mjs FOLDER VOLCOMP
//
// volcomp run … --serve: for this computer and for its own name only, a page without complaints whose
// last numbers are those of the report, and an end that is clean whenever it comes. FOLDER keeps the
// pictures.

import { spawn } from 'node:child_process';
import { mkdir, readFile, rm } from 'node:fs/promises';
import { connect } from 'node:net';
import { networkInterfaces } from 'node:os';
import { join } from 'node:path';
import { withBrowser } from './browser.mjs';
import { checkTable, Failures, finished, shows, TABLES } from './checks.mjs';

const failures = new Failures('live');
const [folder, volcomp] = process.argv.slice(2);

// Starts a run and waits for the address of its page: {child, end, port, url}.
async function begin(...options) {
  const child = spawn(volcomp, ['run', ...options, '--serve', '0'], { stdio: ['ignore', 'pipe', 'pipe'] });
  const end = finished(child);
  const url = await new Promise((resolve, reject) => {
    let text = '';
    child.stdout.on('data', (piece) => {
      text += piece;
      const found = /^live: (\S+)$/m.exec(text);
      if (found) resolve(found[1]);
    });
    end.then(({ output }) => reject(new Error(`no page: ${output}`)));
  });
  return { child, end, url, port: Number(new URL(url).port) };
}

// One request as it goes over the wire: {status, head, body}; status 0: nobody answers.
function ask(port, path, { host, method = 'GET', address = '127.0.0.1' } = {}) {
  const lines = [`${method} ${path} HTTP/1.1`, ...[host ?? []].flat().map((name) => `Host: ${name}`), 'Connection: close', '', ''];
  return new Promise((resolve) => {
    let text = '';
    const socket = connect({ port, host: address, timeout: 5000 }, () => socket.write(lines.join('\r\n')));
    socket.setEncoding('utf8').on('data', (piece) => { text += piece; });
    socket.on('timeout', () => socket.destroy());
    socket.on('error', () => {});
    socket.on('close', () => {
      const [head, ...body] = text.split('\r\n\r\n');
      resolve({ status: Number(/^HTTP\/1\.[01] (\d+)/.exec(head)?.[1] ?? 0), head, body: body.join('\r\n\r\n') });
    });
  });
}

// Who may ask, and what the answers say to browsers.
async function checkDoor({ port }) {
  for (const host of [`127.0.0.1:${port}`, `localhost:${port}`, `LOCALHOST:${port}`]) {
    for (const path of ['/', '/live.js', '/live.css', '/state.json']) {
      failures.same((await ask(port, path, { host })).status, 200, `${path} for ${host}`);
    }
  }
  const strangers = [
    'example.com', `example.com:${port}`, 'localhost', `localhost.example.com:${port}`, `127.0.0.1:${port + 1}`, `127.0.0.1.nip.io:${port}`,
    `127.0.0.2:${port}`, `[::1]:${port}`, `0.0.0.0:${port}`, `localhost:0${port}`, '', [], [`localhost:${port}`, 'example.com'],
  ];
  for (const host of strangers) {
    for (const path of ['/', '/state.json', '/nothing']) {
      const { status, body } = await ask(port, path, { host });
      const refused = status === 421 || status === 400;
      failures.check(refused, `${path} for host ${JSON.stringify(host)} is answered with ${status} instead of 421`);
      failures.check(!body.includes('"axes"'), `${path} for host ${JSON.stringify(host)} tells the state`);
    }
  }
  const host = `localhost:${port}`;
  for (const path of ['/', '/state.json', '/nothing', '/live.js']) {
    const { head } = await ask(port, path, { host });
    failures.check(/content-security-policy: default-src 'none'/i.test(head), `${path} has no content security policy`);
    failures.check(/x-content-type-options: nosniff/i.test(head) && !/access-control-allow/i.test(head), `${path} has wrong headers: ${head}`);
  }
  failures.same((await ask(port, '/nothing', { host })).status, 404, 'what is not there');
  failures.same((await ask(port, '/../etc/passwd', { host })).status, 404, 'what is elsewhere');
  for (const method of ['POST', 'PUT', 'DELETE']) {
    const { status } = await ask(port, '/state.json', { host, method });
    failures.same(status, 405, `status of ${method}`);
  }
}

// The kernel's table of listeners: address and port in hexadecimal, 0A: listening.
async function checkLoopbackOnly({ port }) {
  const hex = port.toString(16).toUpperCase().padStart(4, '0');
  const tables = await Promise.all(['/proc/net/tcp', '/proc/net/tcp6'].map((file) => readFile(file, 'utf8').catch(() => '')));
  const listeners = tables.join('\n').split('\n').map((line) => line.trim().split(/\s+/))
    .filter(([, local, , state]) => local?.endsWith(`:${hex}`) && state === '0A').map(([, local]) => local);
  failures.same(listeners.join(' '), `0100007F:${hex}`, 'listening at');
  for (const { address, internal, family } of Object.values(networkInterfaces()).flat()) {
    if (internal || family !== 'IPv4') continue;
    failures.same((await ask(port, '/', { host: `localhost:${port}`, address })).status, 0, `answer at ${address}`);
  }
}

async function checkTakenPort({ port }) {
  const { code, output } = await finished(spawn(volcomp, ['run', 'l300g', '--noise-free', '--serve', String(port)], { stdio: ['ignore', 'pipe', 'pipe'] }));
  failures.check(code === 2 && output.includes(`port ${port}`) && output.trim().split('\n').length === 1,
    `a port that is taken: exit code ${code}, ${output}`);
}

const textOf = (page, selector) => page.value(`document.querySelector(${JSON.stringify(selector)})?.textContent ?? ''`);

async function checkRunning(page) {
  await page.until('(document.documentElement.dataset.phase ?? "running") !== "running" || document.querySelectorAll("#axes td").length > 0');
  failures.same(await page.value('document.documentElement.dataset.phase'), 'running', 'phase while it runs');
  const axes = await page.value('[...document.querySelectorAll("#axes tbody tr")].map((row) => [...row.cells].map((cell) => cell.textContent))');
  failures.same(axes.map(([letter]) => letter).join(''), 'XYZC', 'axes');
  failures.check(axes.every((row) => row[3] === 'mm' || row[3] === 'deg'), 'an axis without unit');
  failures.check(axes.every((row) => /6041h/.test(row[7])), 'an axis without the state of its drive');
  for (const id of ['machines', 'time', 'edges', 'load', 'node', 'node-state', 'status', 'emergencies']) {
    failures.check((await textOf(page, `#${id}`)) !== '', `no ${id} on the page`);
  }
  const load = Number((await textOf(page, '#load')).split('\u00a0')[0]);
  failures.check(load >= 0 && load <= 100, `bus load ${load} %`);
  await page.until('document.querySelectorAll("#corrections svg path").length > 0');
}

// The page has its numbers from the live state, the report from the end: they coincide.
async function checkEnd(page, report) {
  await page.until('document.documentElement.dataset.phase !== "running"');
  failures.same(await textOf(page, '#phase'), 'the run has ended', 'the end');
  failures.same(await textOf(page, '.verdict span'), report.verdict.text, 'verdict');
  const shown = await page.value(TABLES);
  const ticks = report.sections.filter(({ chapter }) => chapter === 'Tick statistics');
  failures.same(ticks.length, 2, 'tables of tick statistics');
  const counted = shown.filter(({ section }) => section === 'ticks');
  ticks.forEach((section, index) => failures.check(checkTable(failures, counted[index], section) > 0, `no numbers in ${section.title}`));
  checkTable(failures, shown.find(({ section }) => section === 'result'), report.sections[0]);
  const edges = ticks[1].rows.find(([what]) => what.startsWith('edges of the touch probe'))[1];
  failures.check(edges > 0 && shows(await textOf(page, '#edges'), edges), 'edges of the probe');
  const time = ticks[1].rows.find(([what]) => what === 'machine time');
  failures.check(shows(await textOf(page, '#time'), time[1]), 'machine time');
}

async function checkPage() {
  await withBrowser(async (browser) => {
    const page = await browser.newPage();
    await page.media('screen', 'light');
    const run = await begin('face-gear', '--report', folder);
    await page.open(run.url);
    await checkRunning(page);
    failures.same((await ask(run.port, '/report.html', { host: `localhost:${run.port}` })).status, 404, 'the report before the end');
    await page.screenshot(join(folder, 'running.png'));
    const { code, output } = await run.end;
    failures.same(code, 0, `exit code (${output})`);
    const report = JSON.parse(await readFile(join(folder, 'report.json'), 'utf8'));
    await checkEnd(page, report);
    await page.media('screen', 'dark');
    await page.settled();
    await page.screenshot(join(folder, 'ended.png'));
    const foreign = page.requests.filter((address) => !address.startsWith(run.url) && !address.startsWith('data:'));
    failures.same(foreign.join(' '), '', 'requests to elsewhere');
    failures.same(page.complaints.join(' | '), '', 'complaints of the console');
    failures.same((await ask(run.port, '/', { host: `localhost:${run.port}` })).status, 0, 'answer after the end');
  });
}

async function checkInterruption() {
  const run = await begin('l300g');
  await ask(run.port, '/state.json', { host: `localhost:${run.port}` });
  const asked = Date.now();
  run.child.kill('SIGINT');
  const { signal } = await run.end;
  failures.same(signal, 'SIGINT', 'how an interrupted run ends');
  failures.check(Date.now() - asked < 5000, `an interrupted run needs ${Date.now() - asked} ms to end`);
  failures.same((await ask(run.port, '/', { host: `localhost:${run.port}` })).status, 0, 'answer after the interruption');
}

async function checkStaying() {
  const run = await begin('xyfz', '--draws', '0', '--stay', '--report', join(folder, 'stay'));
  const host = `localhost:${run.port}`;
  let state;
  do {
    await new Promise((resolve) => { setTimeout(resolve, 200); });
    state = JSON.parse((await ask(run.port, '/state.json', { host })).body);
  } while (state.phase === 'running');
  failures.same(state.bus, null, 'bus of a run without one');
  for (const name of ['report.html', 'report.json']) {
    const { status, body } = await ask(run.port, `/${name}`, { host });
    failures.same(status, 200, `${name} after the end`);
    failures.check(body === await readFile(join(folder, 'stay', name), 'utf8'), `${name} differs from the file`);
  }
  await withBrowser(async (browser) => {
    const page = await browser.newPage();
    await page.open(`${run.url}report.html`);
    await page.until('document.documentElement.dataset.report !== undefined');
    failures.same(await page.value('document.documentElement.dataset.report'), 'ready', 'the report from the server');
    failures.same(page.complaints.join(' | '), '', 'complaints of the console about the report');
  });
  await checkDoor(run);
  await checkLoopbackOnly(run);
  await checkTakenPort(run);
  run.child.kill('SIGINT');
  failures.same((await run.end).code, 0, 'exit code of a page that stayed');
}

await rm(folder, { recursive: true, force: true });
await mkdir(folder, { recursive: true });
await checkPage();
await checkInterruption();
await checkStaying();
failures.end();

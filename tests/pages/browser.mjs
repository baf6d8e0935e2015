// A headless Chromium, driven by its own protocol over two pipes: no port, no package.

import { spawn } from 'node:child_process';
import { mkdtemp, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const PATIENCE_MS = 60_000;

const FLAGS = [
  '--headless', '--no-sandbox', '--remote-debugging-pipe', '--disable-gpu', '--disable-dev-shm-usage', '--no-first-run',
  '--disable-background-networking', '--disable-component-update', '--disable-sync', '--disable-extensions',
  '--disable-default-apps', '--mute-audio', '--hide-scrollbars', '--force-color-profile=srgb',
];

// Starts the browser; `use(browser)` has it; then it is gone, with its profile.
export async function withBrowser(use) {
  const profile = await mkdtemp(join(tmpdir(), 'volcomp-pages-'));
  const browser = new Browser(profile);
  try {
    return await use(browser);
  } finally {
    await browser.end();
    await rm(profile, { recursive: true, force: true, maxRetries: 5, retryDelay: 100 });
  }
}

class Browser {
  #child; #next = 0; #waiting = new Map(); #pages = new Map(); #rest = ''; #said = ''; #ended;

  constructor(profile) {
    this.#child = spawn('chromium', [...FLAGS, `--user-data-dir=${profile}`, 'about:blank'], {
      stdio: ['ignore', 'ignore', 'pipe', 'pipe', 'pipe'],
    });
    this.#child.stderr.on('data', (text) => { this.#said = (this.#said + text).slice(-2000); });
    this.#child.stdio[4].setEncoding('utf8').on('data', (text) => this.#take(text));
    this.#ended = new Promise((resolve) => {
      this.#child.on('error', (error) => { this.#fail(`chromium cannot be started: ${error.message}`); resolve(); });
      this.#child.on('exit', () => { this.#fail(`chromium has ended: ${this.#said}`); resolve(); });
    });
    this.#child.stdio[3].on('error', () => {});
  }

  async newPage() {
    const { targetId } = await this.send('Target.createTarget', { url: 'about:blank' });
    const { sessionId } = await this.send('Target.attachToTarget', { targetId, flatten: true });
    const page = new Page(this, sessionId, targetId);
    this.#pages.set(sessionId, page);
    await page.begin();
    return page;
  }

  send(method, params = {}, sessionId = undefined) {
    const id = ++this.#next;
    return new Promise((resolve, reject) => {
      const timer = setTimeout(() => reject(new Error(`${method}: no answer within ${PATIENCE_MS} ms`)), PATIENCE_MS);
      this.#waiting.set(id, { method, resolve, reject, timer });
      this.#child.stdio[3].write(`${JSON.stringify({ id, method, params, sessionId })}\0`);
    });
  }

  #take(text) {
    const messages = (this.#rest + text).split('\0');
    this.#rest = messages.pop();
    for (const message of messages.map((json) => JSON.parse(json))) {
      if (message.id === undefined) {
        this.#pages.get(message.sessionId)?.happened(message.method, message.params);
        continue;
      }
      const { method, resolve, reject, timer } = this.#waiting.get(message.id);
      this.#waiting.delete(message.id);
      clearTimeout(timer);
      if (message.error) reject(new Error(`${method}: ${message.error.message}`));
      else resolve(message.result);
    }
  }

  #fail(why) {
    for (const { reject, timer } of this.#waiting.values()) {
      clearTimeout(timer);
      reject(new Error(why));
    }
    this.#waiting.clear();
  }

  async end() {
    this.send('Browser.close').catch(() => {});
    const timer = setTimeout(() => this.#child.kill('SIGKILL'), 5000);
    await this.#ended;
    clearTimeout(timer);
  }
}

class Page {
  #browser; #session; #target; #loaded = () => {};

  complaints = [];  // of the console, errors and warnings, and what was thrown
  requests = [];    // addresses asked for

  constructor(browser, session, target) {
    this.#browser = browser;
    this.#session = session;
    this.#target = target;
  }

  send(method, params) {
    return this.#browser.send(method, params, this.#session);
  }

  async begin() {
    await Promise.all(['Page', 'Runtime', 'Log', 'Network'].map((domain) => this.send(`${domain}.enable`)));
    await this.size(1240, 900);
  }

  size(width, height, scale = 1) {
    return this.send('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: scale, mobile: false });
  }

  happened(method, params) {
    if (method === 'Runtime.consoleAPICalled' && ['error', 'warning', 'assert'].includes(params.type)) {
      this.complaints.push(params.args.map((argument) => argument.value ?? argument.description).join(' '));
    }
    if (method === 'Runtime.exceptionThrown') {
      const { exception, text } = params.exceptionDetails;
      this.complaints.push(exception?.description ?? text);
    }
    if (method === 'Log.entryAdded' && ['error', 'warning'].includes(params.entry.level)) {
      this.complaints.push(`${params.entry.text} ${params.entry.url ?? ''}`);
    }
    if (method === 'Network.requestWillBeSent') this.requests.push(params.request.url);
    if (method === 'Page.loadEventFired') this.#loaded();
  }

  async open(url) {
    const loaded = new Promise((resolve) => { this.#loaded = resolve; });
    const { errorText } = await this.send('Page.navigate', { url });
    if (errorText) throw new Error(`${url}: ${errorText}`);
    await loaded;
  }

  // The value of an expression in the page; promises are awaited.
  async value(expression) {
    const { result, exceptionDetails } = await this.send('Runtime.evaluate', {
      expression, returnByValue: true, awaitPromise: true,
    });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }

  // Waits until an expression is true.
  async until(expression, patience_ms = PATIENCE_MS) {
    const end = Date.now() + patience_ms;
    while (!(await this.value(expression))) {
      if (Date.now() > end) throw new Error(`it never came true: ${expression}`);
      await new Promise((resolve) => { setTimeout(resolve, 50); });
    }
  }

  // Two frames: what was changed has been drawn.
  settled() {
    return this.value('new Promise((resolve) => { requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(resolve, 20))); })');
  }

  media(media, scheme) {
    return this.send('Emulation.setEmulatedMedia', { media, features: [{ name: 'prefers-color-scheme', value: scheme }] });
  }

  mouse(type, x, y, more = {}) {
    return this.send('Input.dispatchMouseEvent', { type, x, y, ...more });
  }

  async screenshot(file) {
    const { cssContentSize: { width, height } } = await this.send('Page.getLayoutMetrics');
    const clip = { x: 0, y: 0, width, height: Math.min(height, 16000), scale: 1 };
    const { data } = await this.send('Page.captureScreenshot', { captureBeyondViewport: true, clip });
    await writeFile(file, Buffer.from(data, 'base64'));
  }

  // Returns how many pages there are.
  async pdf(file) {
    const { data } = await this.send('Page.printToPDF', { preferCSSPageSize: true, printBackground: false });
    const pdf = Buffer.from(data, 'base64');
    await writeFile(file, pdf);
    return (pdf.toString('latin1').match(/\/Type\s*\/Page\b/g) ?? []).length;
  }

  close() {
    return this.#browser.send('Target.closeTarget', { targetId: this.#target });
  }
}

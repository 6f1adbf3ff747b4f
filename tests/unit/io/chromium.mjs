// Chromium without a window, controlled through pipes [Chrome DevTools Protocol], and its pictures as pixels.
import {spawn, spawnSync} from 'node:child_process';
import {mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {inflateSync} from 'node:zlib';

/** The program's name, or null if none is installed. */
export function findChromium() {
  return ['chromium', 'chromium-browser', 'google-chrome'].find((name) => spawnSync(name, ['--version']).status === 0) ?? null;
}

export class Chromium {
  constructor(program, width, height) {
    this.folder = mkdtempSync(join(tmpdir(), 'polybody-chromium-'));
    this.waiting = new Map();
    this.last = 0;
    this.text = '';
    this.messages = []; // errors that pages threw or logged
    this.process = spawn(program, [
      '--headless=new', '--no-sandbox', '--disable-dev-shm-usage', '--remote-debugging-pipe', `--user-data-dir=${this.folder}`,
      `--window-size=${width},${height}`, '--hide-scrollbars', '--force-device-scale-factor=1', '--no-first-run', '--disable-extensions',
      '--disable-background-networking', '--disable-component-update', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
      '--ignore-gpu-blocklist',
    ], {stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe']});
    this.process.stdio[4].setEncoding('utf8').on('data', (text) => this.take(text));
    this.process.on('exit', () => {
      for (const {reject} of this.waiting.values()) reject(new Error('chromium ended'));
    });
  }

  take(text) {
    const parts = (this.text + text).split('\0');
    this.text = parts.pop();
    for (const part of parts) {
      const message = JSON.parse(part), call = this.waiting.get(message.id);
      if (call) {
        this.waiting.delete(message.id);
        if (message.error) call.reject(new Error(message.error.message));
        else call.resolve(message.result);
      } else if (message.method === 'Runtime.exceptionThrown') {
        this.messages.push(message.params.exceptionDetails.exception?.description ?? message.params.exceptionDetails.text);
      } else if (message.method === 'Runtime.consoleAPICalled' && message.params.type === 'error') {
        this.messages.push(message.params.args.map((a) => a.value ?? a.description).join(' '));
      } else if (message.method === 'Page.loadEventFired' && this.loaded) {
        this.loaded();
      } else if (message.method === 'Network.requestWillBeSent' && !/^(file|data|blob):/.test(message.params.request.url)) {
        this.messages.push(`asks the network for ${message.params.request.url}`);
      }
    }
  }

  send(method, params = {}) {
    const id = ++this.last;
    this.process.stdio[3].write(`${JSON.stringify({id, method, params, ...(this.session && {sessionId: this.session})})}\0`);
    return new Promise((resolve, reject) => this.waiting.set(id, {resolve, reject}));
  }

  async start(width, height) {
    const {targetId} = await this.send('Target.createTarget', {url: 'about:blank'});
    this.session = (await this.send('Target.attachToTarget', {targetId, flatten: true})).sessionId;
    for (const domain of ['Page', 'Runtime', 'Network']) await this.send(`${domain}.enable`);
    await this.resize(width, height);
  }
  resize(width, height) {
    return this.send('Emulation.setDeviceMetricsOverride', {width, height, deviceScaleFactor: 1, mobile: false});
  }

  async open(url) {
    this.messages.length = 0;
    const done = new Promise((resolve) => (this.loaded = resolve));
    await this.send('Page.navigate', {url});
    await done;
  }

  /** Value of a JavaScript expression of the page, or of its promise, as JSON. */
  async ask(expression) {
    const {result, exceptionDetails} =
        await this.send('Runtime.evaluate', {expression: `(async () => JSON.stringify(await (${expression})))()`, awaitPromise: true, returnByValue: true});
    if (exceptionDetails) throw new Error(`${expression}: ${exceptionDetails.exception?.description}`);
    return result.value === undefined ? undefined : JSON.parse(result.value);
  }

  async press(key, modifiers = 0) {
    const text = key.length === 1 ? {text: key} : {};
    await this.send('Input.dispatchKeyEvent', {type: 'keyDown', key, modifiers, ...text});
    await this.send('Input.dispatchKeyEvent', {type: 'keyUp', key, modifiers});
  }

  async picture() {
    return Buffer.from((await this.send('Page.captureScreenshot', {format: 'png'})).data, 'base64');
  }

  async stop() {
    const ended = new Promise((resolve) => this.process.once('exit', resolve));
    this.session = undefined;
    this.send('Browser.close').catch(() => {});
    const late = setTimeout(() => this.process.kill('SIGKILL'), 5000);
    await ended;
    clearTimeout(late);
    rmSync(this.folder, {recursive: true, force: true, maxRetries: 5});
  }
}

/** Pixels of an 8-bit PNG without interlacing [ISO/IEC 15948]. */
export function pixelsOf(png) {
  const width = png.readUInt32BE(16), height = png.readUInt32BE(20), channels = png[25] === 6 ? 4 : 3, data = [];
  for (let at = 8; at < png.length; at += 12 + png.readUInt32BE(at))
    if (png.toString('latin1', at + 4, at + 8) === 'IDAT') data.push(png.subarray(at + 8, at + 8 + png.readUInt32BE(at)));
  const raw = inflateSync(Buffer.concat(data)), line = width * channels, out = new Uint8Array(line * height);
  for (let y = 0; y < height; ++y) {
    const filter = raw[y * (line + 1)];
    for (let i = 0; i < line; ++i) {
      const left = i < channels ? 0 : out[y * line + i - channels], above = y === 0 ? 0 : out[(y - 1) * line + i];
      const corner = i < channels || y === 0 ? 0 : out[(y - 1) * line + i - channels], p = left + above - corner;
      const paeth = Math.abs(p - left) <= Math.abs(p - above) && Math.abs(p - left) <= Math.abs(p - corner) ? left
          : Math.abs(p - above) <= Math.abs(p - corner) ? above : corner;
      out[y * line + i] = raw[y * (line + 1) + 1 + i] + [0, left, above, (left + above) >> 1, paeth][filter];
    }
  }
  return {width, height, channels, data: out};
}

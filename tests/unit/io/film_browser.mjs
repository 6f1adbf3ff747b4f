// node film_browser.mjs FILM [--places RUN.pvd]... [--pictures FOLDER] [--damage] [--rate N]
//
// Plays a film in chromium without a window, by software GL, 800 x 600 pixels, and prints its findings. It fails unless
//   the page opens without an error and makes no network request; pixels differ from the background, also from frame to
//   frame; the film has a frame for each time; keys have the effects that the page lists;
//   --places    the points of scene k on the graphics card are those of the k-th collection of a VtkWriter, at all common
//               times, within 1e-4 of the size of the visible scene;
//   --rate      during playback, it draws at least N pictures per second;
//   --damage    the page shows a message that describes the error if the file is cut off or changed.
// --pictures keeps pictures of the page. Exits with 77 if there is no film or no chromium.
import {existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {basename, dirname, join, resolve} from 'node:path';
import {pathToFileURL} from 'node:url';

import {Chromium, findChromium, pixelsOf} from './chromium.mjs';

const options = {places: []};
for (let i = 2; i < process.argv.length; ++i) {
  const word = process.argv[i];
  if (word === '--places') options.places.push(process.argv[++i]);
  else if (word === '--pictures' || word === '--rate') options[word.slice(2)] = process.argv[++i];
  else if (word === '--damage') options.damage = true;
  else options.film = resolve(word);
}
const program = findChromium();
if (!program || !existsSync(options.film)) {
  console.log(program ? `There is no film ${options.film}.` : 'There is no chromium.');
  process.exit(77);
}

const width = 800, height = 600;
const twoPictures = 'new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))';
let failures = 0;
function check(holds, what) {
  console.log(`${holds ? 'ok' : 'FAILS'}: ${what}`);
  if (!holds) ++failures;
}

/** The share of pixels of the canvas that differ from the colour of its background. */
function drawnShare(png, {background = [246, 247, 249]} = {}) {
  const {channels, data} = pixelsOf(png);
  let count = 0;
  for (let i = 0; i < data.length; i += channels)
    if (Math.abs(data[i] - background[0]) + Math.abs(data[i + 1] - background[1]) + Math.abs(data[i + 2] - background[2]) > 60) ++count;
  return count * channels / data.length;
}
function differing(a, b) {
  const p = pixelsOf(a), q = pixelsOf(b);
  let count = 0;
  for (let i = 0; i < p.data.length; i += p.channels)
    if (p.data[i] !== q.data[i] || p.data[i + 1] !== q.data[i + 1] || p.data[i + 2] !== q.data[i + 2]) ++count;
  return count;
}

/** Times and points of the states in the files of a VtkWriter. */
function statesOf(collection) {
  const text = readFileSync(collection, 'utf8');
  return [...text.matchAll(/timestep="([^"]*)" part="0" file="([^"]*)"/g)].map(([, time, file]) => {
    const grid = readFileSync(join(dirname(collection), file.replace(/&quot;/g, '"').replace(/&amp;/g, '&')));
    const raw = grid.indexOf('<AppendedData encoding="raw">\n_') + '<AppendedData encoding="raw">\n_'.length;
    const offset = Number(/Name="points"[^>]*offset="(\d+)"/.exec(grid.toString('latin1', 0, raw))[1]);
    const length = Number(grid.readBigUInt64LE(raw + offset)), points = [];
    for (let i = 0; i < length; i += 4) points.push(grid.readFloatLE(raw + offset + 8 + i));
    return {time: Number(time), points};
  });
}

async function comparePlaces(page, scene, collection) {
  const {times, parts} = (await page.ask('polybodyFilm.scenes'))[scene];
  let worst = 0, compared = 0, size = 0;
  for (const {time, points} of statesOf(collection)) {
    const frame = times.findIndex((t) => Math.abs(t - time) < 1e-9);
    if (frame < 0) continue;
    const found = await page.ask(`(polybodyFilm.show(${times[frame]}), ${JSON.stringify(parts)}.flatMap((_, i) => polybodyFilm.points(${scene}, i)))`);
    if (found.length !== points.length) check(false, `scene ${scene} has ${found.length / 3} points, its ParaView files have ${points.length / 3}`);
    for (let i = 0; i < points.length; ++i) worst = Math.max(worst, Math.abs(points[i] - found[i]));
    for (const c of [0, 1, 2]) {
      const of = points.filter((_, i) => i % 3 === c);
      size = Math.max(size, of.reduce((a, b) => Math.max(a, b), -Infinity) - of.reduce((a, b) => Math.min(a, b), Infinity));
    }
    ++compared;
  }
  check(compared > 0, `${compared} states of scene ${scene} are in its ParaView files, too`);
  check(worst <= 1e-4 * size, `their points are where ParaView has them: within ${(1e3 * worst).toFixed(4)} mm of ${size.toFixed(2)} m`);
}

async function play(page) {
  const scenes = await page.ask('polybodyFilm.scenes'), range = await page.ask('polybodyFilm.range');
  await page.ask(`polybodyFilm.show(${range[0]})`);
  await page.ask(twoPictures);
  const first = await page.picture();
  check(drawnShare(first) > 0.01, `the first frame covers ${(100 * drawnShare(first)).toFixed(1)} % of the page`);
  await page.ask(`polybodyFilm.show(${0.5 * (range[0] + range[1])})`);
  await page.ask(twoPictures);
  const middle = await page.picture();
  check(scenes.every((s) => s.times.length < 2) || differing(first, middle) > 50, `${differing(first, middle)} pixels differ half way`);
  if (options.pictures) {
    mkdirSync(options.pictures, {recursive: true});
    const name = basename(options.film, '.html');
    writeFileSync(join(options.pictures, `${name}_small.png`), middle);
    await page.resize(1280, 800);
    await page.open('about:blank');
    await page.open(`${pathToFileURL(options.film).href}#smooth`);
    for (const [k, share] of [0.02, 0.35, 0.7, 1].entries()) {
      await page.ask(`polybodyFilm.show(${range[0] + share * (range[1] - range[0])})`);
      await page.ask('new Promise((done) => setTimeout(done, 300))');
      writeFileSync(join(options.pictures, `${name}_${k}.png`), await page.picture());
    }
    await page.resize(width, height);
    await page.open('about:blank');
    await page.open(pathToFileURL(options.film).href);
  }
}

/** The values of plots are next to their titles, or below them in narrow plots. */
async function readOuts(page) {
  const range = await page.ask('polybodyFilm.range');
  const unnamed = await page.ask(`[...document.querySelectorAll('.plot canvas')].filter((canvas) => !canvas.ariaLabel).length`);
  check(unnamed === 0, 'each plot says its title to a reader of the page');
  for (const across of [1280, width]) {
    await page.resize(across, height);
    await page.ask(`polybodyFilm.show(${range[0] + 0.35 * (range[1] - range[0])})`);
    await page.ask(twoPictures);
    const hidden = await page.ask(`[...document.querySelectorAll('.plot')].map((plot) => {
      const canvas = plot.querySelector('canvas'), g = document.createElement('canvas').getContext('2d');
      g.font = '12px system-ui, sans-serif';
      const title = canvas.getBoundingClientRect(), numbers = plot.querySelector('figcaption').getBoundingClientRect();
      return numbers.top >= title.top + 18 || numbers.left > title.left + 62 + g.measureText(canvas.ariaLabel).width ? '' : String(canvas.ariaLabel);
    }).filter((name) => name)`);
    const uneven = await page.ask(`[...document.querySelectorAll('.plot figcaption')].filter((numbers) =>
      new Set([...numbers.children].map((b) => b.textContent).filter((text) => text && !/e/.test(text)).map((text) => (text.split('.')[1] ?? '').length)).size > 1).length`);
    check(uneven === 0, 'read-outs of one plot have equally many decimals');
    check(hidden.length === 0, `no read-out stands on the title of its plot, ${across} pixels across ${JSON.stringify(hidden)}`);
  }
}

/** An address with a time opens the film paused at this time. Hidden arrows are a button that shows them. */
async function openAtTime(page) {
  const [begin, end] = await page.ask('polybodyFilm.range'), time = Number((0.6 * begin + 0.4 * end).toFixed(3));
  await page.open('about:blank');
  await page.open(`${pathToFileURL(options.film).href}#t=${time}`);
  check(await page.ask('polybodyFilm.time') === time && !(await page.ask('polybodyFilm.playing')), `#t=${time} opens the film paused at this time`);
  const entry = `document.querySelector('.arrow')`;
  if (await page.ask(`!${entry}`)) return;
  const shown = await page.ask(`${entry}.textContent`);
  await page.ask(`(${entry}.click(), 0)`);
  const clicked = await page.ask(`${entry}.textContent`);
  check(/^show /.test(shown) !== /^show /.test(clicked), `a click on "${shown}" gives "${clicked}"`);
}

async function pressKeys(page) {
  const film = (what) => page.ask(`polybodyFilm.${what}`);
  const [begin, end] = await film('range'), scenes = await film('scenes');
  const settle = () => page.ask(twoPictures);
  await page.press('Home');
  check(await film('time') === begin && !(await film('playing')), 'home goes to the first frame');
  const times = [...new Set(scenes.flatMap((s) => s.times))].sort((a, b) => a - b);
  await page.press('ArrowRight');
  await settle();
  check(await film('time') === (times[1] ?? begin), 'right goes to the next frame');
  const frames = await film('frames()'), time = await film('time');
  check(scenes.every((s, k) => frames[k] === s.times.filter((t) => t <= time + 1e-9).length - 1), 'every scene shows its frame');
  await page.press('ArrowLeft');
  check(await film('time') === begin, 'left goes back');
  await page.press('End');
  check(await film('time') === end, 'end goes to the last frame');
  await page.press('Home');
  await page.press('+');
  check(await film('speed') === 2, '+ doubles the speed');
  await page.press('-');
  check(await film('speed') === 1, '- halves it');
  await page.press(' ');
  check(await film('playing'), 'space plays');
  await page.press(' ');
  check(!(await film('playing')), 'space pauses');
  const start = await film('camera');
  await page.press('t');
  const top = await film('camera');
  check(Math.hypot(...top.map((x, i) => x - start[i])) > 1e-6 * Math.hypot(...top), 't looks from the top');
  await page.press('r');
  check(Math.hypot(...(await film('camera')).map((x, i) => x - start[i])) < 1e-6 * Math.hypot(...top), 'r looks as at the start');
  if (scenes.length > 1) {
    await page.press('2');
    check(JSON.stringify(await film('shown')) === '[1]', '2 shows the second scene alone');
    await page.press('0');
    check((await film('shown')).length === scenes.length, '0 shows all of them');
  }
}

/** Pictures per second during a playback of three seconds; each picture is drawn again. */
async function measureRate(page, least) {
  const [begin, end] = await page.ask('polybodyFilm.range');
  await page.ask(`(polybodyFilm.race(${(end - begin) / 3}, true), 0)`);
  await page.press('Home');
  await page.press(' ');
  await page.ask(twoPictures);
  const found = await page.ask(`new Promise((done) => {
    const began = performance.now(), before = polybodyFilm.drawn;
    setTimeout(() => done([polybodyFilm.drawn - before, performance.now() - began]), 2500);
  })`);
  const rate = 1000 * found[0] / found[1], size = await page.ask('polybodyFilm.size');
  check(rate >= least, `it draws ${rate.toFixed(1)} pictures a second, ${least} are asked for, on a canvas of ${size[0]} x ${size[1]}`);
  await page.ask('(polybodyFilm.race(1, false), 0)');
}

/** A page that is cut off or changed shows a message, or plays if no data is lost, such as the padding "=" at the end. */
async function damage(page) {
  const folder = mkdtempSync(join(tmpdir(), 'polybody-film-')), file = join(folder, 'damaged.html');
  const whole = readFileSync(options.film, 'latin1'), data = whole.indexOf('id="film">') + 10, end = whole.indexOf('</script>', data);
  const told = async (text) => {
    writeFileSync(file, text, 'latin1');
    await page.open(pathToFileURL(file).href);
    // The first picture is drawn some time after the page is loaded, later on a busy machine.
    return page.ask(`(async () => {
      const element = (id) => document.getElementById(id), last = performance.now() + 10000;
      for (;;) {
        const playing = !element('player')?.hidden && !!window.polybodyFilm?.drawn;
        const notice = element('notice')?.hidden ? '' : element('notice')?.textContent ?? '';
        if (playing || notice || performance.now() > last) return {playing, notice};
        await new Promise((resolve) => setTimeout(resolve, 20));
      }
    })()`);
  };
  const script = whole.indexOf('<script>'), last = data + whole.slice(data, end).trimEnd().replace(/=*$/, '').length - 1;
  const cuts = [script - 1, script + 1000, Math.floor((script + data) / 2), data - 60, data - 20, data, data + 1, data + 10, data + 43,
                Math.floor((data + end) / 2), Math.floor((data + end) / 2) + 1, end - 4, last];
  for (const cut of cuts) {
    const {playing, notice} = await told(whole.slice(0, cut));
    check(!playing && /cut off|damaged|not complete/.test(notice), `cut off at ${cut} of ${whole.length}: "${notice}"`);
  }
  for (const cut of [end, end + 4, end + 9, whole.length - 3])
    check((await told(whole.slice(0, cut))).playing, `cut off at ${cut} of ${whole.length}, behind the data: it plays`);
  const middle = Math.floor((data + end) / 2), other = whole[middle] === 'A' ? 'B' : 'A';
  const {playing, notice} = await told(whole.slice(0, middle) + other + whole.slice(middle + 1));
  check(!playing && /damaged/.test(notice), `one letter changed: "${notice}"`);
  const bare = await told(whole.slice(0, whole.lastIndexOf('<script', data)) + '<!--polybody-film-->' + whole.slice(end + 9));
  check(!bare.playing && /no film in this page/.test(bare.notice), `without a film: "${bare.notice}"`);
  rmSync(folder, {recursive: true});
}

const page = new Chromium(program, width, height);
try {
  await page.start(width, height);
  await page.open(pathToFileURL(options.film).href);
  const errors = await page.ask('window.polybodyFilm?.errors');
  check(Array.isArray(errors) && errors.length === 0 && page.messages.length === 0,
        `the page opens without an error ${JSON.stringify([...(errors ?? ['no viewer']), ...page.messages])}`);
  if (failures === 0) {
    for (const scene of await page.ask('polybodyFilm.scenes'))
      console.log(`scene "${scene.name}": ${scene.times.length} frames, ${scene.parts.length} parts, arrows ${JSON.stringify(scene.arrows)}, plots ${JSON.stringify(scene.plots)}`);
    await play(page);
    await readOuts(page);
    await pressKeys(page);
    await openAtTime(page);
    for (const [scene, collection] of options.places.entries()) await comparePlaces(page, scene, resolve(collection));
    if (options.rate) await measureRate(page, Number(options.rate));
    check(page.messages.length === 0, `no error came later ${JSON.stringify(page.messages)}`);
    if (options.damage) await damage(page);
  }
} finally {
  await page.stop();
}
console.log(failures === 0 ? 'The film is as it should be.' : `${failures} checks fail.`);
process.exit(failures === 0 ? 0 : 1);

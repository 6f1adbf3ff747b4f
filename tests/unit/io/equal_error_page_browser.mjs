// node equal_error_page_browser.mjs PAGE [--pictures FOLDER]
//
// Opens the page of a comparison at equal error in chromium without a window, at 1280 and 390 pixels, and prints its
// findings. It fails unless
//   the page opens without an error and makes no network request; nothing is wider than the window; labels of the
//   charts do not overlap; each chart has curves; a formulation has one colour in all charts and tables; a click and a
//   key on the head of a column change the order of the rows; a name below a chart hides its curve; a dark page is
//   dark.
// --pictures keeps pictures of the page. Exits with 77 if there is no chromium.
import {mkdirSync, writeFileSync} from 'node:fs';
import {join, resolve} from 'node:path';
import {pathToFileURL} from 'node:url';

import {Chromium, findChromium} from './chromium.mjs';

const [file, option, folder] = process.argv.slice(2);
const program = findChromium();
if (!program) {
  console.log('There is no chromium.');
  process.exit(77);
}

let failures = 0;
function check(holds, what) {
  console.log(`${holds ? 'ok' : 'FAILS'}: ${what}`);
  if (!holds) ++failures;
}

/** Elements that are wider than the window, apart from the contents of boxes that scroll. */
const tooWide = `[...document.querySelectorAll('body *')]
  .filter((e) => !e.closest('.scroll, svg') || e.matches('.scroll'))
  .filter((e) => e.getBoundingClientRect().right > innerWidth + 0.5 || e.getBoundingClientRect().left < -0.5)
  .map((e) => e.tagName + '.' + e.className)`;
/** Labels of charts that overlap one another, or that are outside of their chart. */
const badLabels = `[...document.querySelectorAll('.chart > svg')].flatMap((svg) => {
  const frame = svg.closest('figure').getBoundingClientRect();
  const boxes = [...svg.querySelectorAll('text')].map((t) => ({text: t.textContent, box: t.getBoundingClientRect()}));
  const apart = (a, b) => a.right <= b.left + 1 || b.right <= a.left + 1 ||
      a.bottom <= b.top + 3 || b.bottom <= a.top + 3;
  return boxes.filter(({box}, i) => box.left < frame.left || box.right > frame.right ||
      boxes.some((other, k) => k < i && !apart(box, other.box)))
      .map(({text}) => svg.closest('figure').id + ': ' + text);
})`;
/** Numbers of different colours of each formulation, and of colours in all. */
const colours = `(() => {
  const found = {};
  for (const e of document.querySelectorAll('[data-formulation]'))
    (found[e.dataset.formulation] ??= new Set()).add(getComputedStyle(e).color);
  const all = new Set(Object.values(found).flatMap((set) => [...set]));
  const most = Math.max(...Object.values(found).map((set) => set.size));
  return {formulations: Object.keys(found).length, most, all: all.size};
})()`;
const names = `[...document.querySelector('#ranking tbody').rows].map((row) => row.cells[0].textContent)`;
const head = (text) =>
    `[...document.querySelector('#ranking thead').rows[0].cells].find((c) => c.textContent.startsWith('${text}'))`;
const values = `[...document.querySelector('#ranking tbody').rows]
  .map((row) => Number(row.cells[${head('unknowns')}.cellIndex].dataset.v))`;
const ascending = (list) => list.every((x, i) => i === 0 || list[i - 1] <= x);

async function examine(page, width) {
  await page.resize(width, 900);
  await page.open(pathToFileURL(resolve(file)).href);
  await page.ask(`(document.querySelectorAll('details').forEach((d) => (d.open = true)), 1)`);
  const wide = await page.ask('document.documentElement.scrollWidth');
  check(wide <= width, `${width} pixels: the page is ${wide} pixels wide`);
  const out = await page.ask(tooWide);
  check(out.length === 0, `${width} pixels: elements outside of the window: ${out.slice(0, 5)}`);
  const labels = await page.ask(badLabels);
  check(labels.length === 0, `${width} pixels: labels that overlap or are outside: ${labels.slice(0, 5)}`);
  const size = await page.ask(
      `Math.min(...[...document.querySelectorAll('.chart > svg text')].map((t) => t.getBoundingClientRect().height))`);
  check(size >= 10, `${width} pixels: the smallest label of a chart is ${size} pixels high`);
}

async function useTables(page) {
  const before = await page.ask(names);
  check(before.length === 3, `the first ranking has ${before.length} rows`);
  await page.ask(`(${head('unknowns')}.querySelector('button').click(), 1)`);
  check(ascending(await page.ask(values)), 'a click sorts by the unknowns, ascending');
  check(await page.ask(`${head('unknowns')}.getAttribute('aria-sort')`) === 'ascending', 'the head says ascending');
  check(await page.ask(`${head('CPU')}.hasAttribute('aria-sort')`) === false, 'the earlier head says nothing');
  await page.ask(`(${head('unknowns')}.querySelector('button').focus(), 1)`);
  await page.press(' ');
  check(ascending((await page.ask(values)).reverse()), 'a key sorts by the unknowns, descending');
  check(await page.ask(`${head('unknowns')}.getAttribute('aria-sort')`) === 'descending', 'the head says descending');
  await page.ask(`(${head('formulation')}.querySelector('button').click(), 1)`);
  const after = await page.ask(names);
  const same = [...after].sort().join() === [...before].sort().join();
  check(after.join() !== before.join() && same, 'the names change their order');
}

async function useCharts(page) {
  const curves = await page.ask(`[...document.querySelectorAll('.chart')].map((f) => ({id: f.id, lines:
    [...f.querySelectorAll('.curve path.line')].filter((p) => p.getTotalLength() > 20).length,
    markers: f.querySelectorAll('.curve path.marker').length}))`);
  for (const {id, lines, markers} of curves) check(lines >= 1, `chart ${id} has ${lines} lines and ${markers} markers`);
  check(curves.length === 6, `there are ${curves.length} charts`);
  const titles = await page.ask(`[...document.querySelectorAll('#work path.marker title')].map((t) => t.textContent)`);
  const full = (t) => /elements, h = .* s, GeneralisedAlpha/.test(t.replaceAll('\u00a0', ' '));
  check(titles.length === 35 && titles.every(full), 'each run has a tooltip');
  const found = await page.ask(colours);
  check(found.formulations === 3 && found.most === 1 && found.all === 3,
      `colours of the formulations: ${JSON.stringify(found)}`);
  const hidden = `getComputedStyle(document.querySelector('#work .curve[data-curve="1"]')).display`;
  await page.ask(`(document.querySelector('#work .legend button[data-curve="1"]').focus(), 1)`);
  await page.press(' ');
  check(await page.ask(hidden) === 'none', 'a key on a name hides its curve');
  await page.press(' ');
  check(await page.ask(hidden) !== 'none', 'a second key shows it again');
}

async function picture(page, name) {
  if (option !== '--pictures') return;
  mkdirSync(folder, {recursive: true});
  const height = await page.ask('document.documentElement.scrollHeight');
  const {data} = await page.send('Page.captureScreenshot', {format: 'png', captureBeyondViewport: true,
    clip: {x: 0, y: 0, width: await page.ask('innerWidth'), height, scale: 1}});
  writeFileSync(join(folder, `${name}.png`), Buffer.from(data, 'base64'));
}

const page = new Chromium(program, 1280, 900);
try {
  await page.start(1280, 900);
  for (const width of [1280, 390]) {
    await examine(page, width);
    await useTables(page);
    await useCharts(page);
    await picture(page, `equal_error_${width}`);
  }
  const brightness = `getComputedStyle(document.body).backgroundColor.match(/\\d+/g).slice(0, 3)
    .reduce((a, b) => a + Number(b), 0) / 765`;
  const light = await page.ask(brightness);
  await page.send('Emulation.setEmulatedMedia', {features: [{name: 'prefers-color-scheme', value: 'dark'}]});
  const dark = await page.ask(brightness);
  check(light > 0.8 && dark < 0.2, `the brightness is ${light.toFixed(2)}, and ${dark.toFixed(2)} on a dark page`);
  check((await page.ask(colours)).most === 1, 'a formulation has one colour on a dark page');
  const colour = await page.ask(`getComputedStyle(document.querySelector('[data-formulation="2"]')).color`);
  check(colour !== 'rgb(0, 0, 0)', 'black is not black on a dark page');
  await picture(page, 'equal_error_dark');
  check(page.messages.length === 0, `messages of the page: ${page.messages}`);
} finally {
  await page.stop();
}
process.exit(failures === 0 ? 0 : 1);

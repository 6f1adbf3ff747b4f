// node film_stress.mjs FILM
//
// Checks that links of the film of track_stress have the colours of their stress. In each scene all 128 links have a stress
// in each point and frame. For the link with a plotted history, the mean over its sections equals the history at each frame
// with a point of the history at its time. Exits with 77 if there is no film.
import {existsSync, readFileSync} from 'node:fs';

import {bytesOfBase64, decodeFilm} from '../../../cmake/viewer/src/decode.js';

const file = process.argv[2];
if (!existsSync(file)) {
  console.log(`There is no film ${file}.`);
  process.exit(77);
}
const html = readFileSync(file, 'latin1'), begin = html.indexOf('id="film">') + 10;
const film = decodeFilm(bytesOfBase64(html.slice(begin, html.indexOf('</script>', begin))));
let failures = 0;
function check(holds, what) {
  console.log(`${holds ? 'ok' : 'FAILS'}: ${what}`);
  if (!holds) ++failures;
}

/** Mean stress along a link in a frame: trapezoidal rule over the rings of four points. */
function meanStress(scene, part, frame) {
  const {low, high} = scene.scalars[0], n = scene.shapes[part.shape].points.length / 3, rings = n / 4;
  let sum = 0;
  for (let i = 0; i < n; ++i) {
    const ring = Math.floor(i / 4), weight = (ring === 0 || ring === rings - 1 ? 0.5 : 1) / (rings - 1);
    sum += 0.25 * weight * (low + (high - low) * part.scalars[0][frame * n + i] / 65534);
  }
  return sum;
}

check(film.scenes.length === 2, `scenes ${JSON.stringify(film.scenes.map((scene) => scene.name))}`);
check(JSON.stringify(Array.from(film.scenes[0].times)) === JSON.stringify(Array.from(film.scenes[1].times)), 'they have frames at the same times');
for (const scene of film.scenes) {
  const links = scene.parts.filter((part) => /^(left|right) link \d+$/.test(part.name) && part.scalars[0]);
  check(links.length === 128, `${scene.name}: ${links.length} links know their stress`);
  check(links.every((part) => !part.scalars[0].includes(65535)), 'in each point and frame');
  const plot = scene.plots.find((p) => p.label.startsWith('axial stress of '));
  const watched = links.find((part) => plot?.label === `axial stress of ${part.name}`);
  check(watched !== undefined, `the history is "${plot?.label}"`);
  if (!watched) continue;
  const common = []; // frame, value of the history
  for (const [frame, t] of scene.times.entries()) {
    const point = plot.times.findIndex((time) => Math.abs(time - t) < 1e-9);
    if (point >= 0) common.push([frame, plot.values[point]]);
  }
  check(common.length > 2, `${common.length} frames are at points of the history`);
  const off = (part) => Math.sqrt(common.reduce((sum, [frame, value]) => sum + (meanStress(scene, part, frame) - value) ** 2, 0) / common.length);
  const size = Math.max(...common.map(([, value]) => Math.abs(value)));
  let others = Infinity;
  // the other track is the mirror image
  for (const part of links) if (part !== watched && part.name.slice(0, 5) === watched.name.slice(0, 5)) others = Math.min(others, off(part));
  check(off(watched) < 0.01 * size && off(watched) < 0.2 * others, `its colours are the history of ${size.toFixed(3)} MPa: off by an rms of ${off(watched).toExponential(2)} MPa, the nearest other link of the track by ${others.toExponential(2)} MPa`);
}
process.exit(failures === 0 ? 0 : 1);

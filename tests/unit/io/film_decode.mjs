// node film_decode.mjs FILM: the data of a film, read by the viewer's own decoder. The film is cut off at every length, and
// changed in every byte of head and table and in many bytes of the arrays. Each time the decoder must throw an error with a
// message. Prints the contents as lines for film_test.cpp:  part SCENE FRAME PART X Y Z ...   for the points of every part.
import {readFileSync} from 'node:fs';

import {bytesOfBase64, decodeFilm, FilmError, pointsOf} from '../../../cmake/viewer/src/decode.js';

const html = readFileSync(process.argv[2], 'latin1'), begin = html.indexOf('id="film">') + 10;
const letters = html.slice(begin, html.indexOf('</script>', begin)), bytes = bytesOfBase64(letters);
let failures = 0;

function refused(what, act) {
  try {
    act();
  } catch (error) {
    if (error instanceof FilmError && /^[A-Z][^]*\.$/.test(error.message)) return;
    console.error(`${what}: not a sentence, but ${error.stack}`);
  }
  ++failures;
  console.error(`${what}: is not refused`);
}

for (let n = 0; n < bytes.length; ++n) refused(`cut off at byte ${n}`, () => decodeFilm(bytes.slice(0, n)));
for (let n = 0; n < letters.length; n += n < 400 ? 1 : 7) refused(`cut off at letter ${n}`, () => decodeFilm(bytesOfBase64(letters.slice(0, n))));
const head = new DataView(bytes.buffer), table = head.getUint32(8, true);
for (let n = 0; n < bytes.length; n += n < 32 + table ? 1 : 11) {
  const changed = bytes.slice();
  changed[n] ^= 1 << (n % 8);
  refused(`byte ${n} changed`, () => decodeFilm(changed));
}

/** The film with another table, with the correct checksum. */
function withTable(text) {
  const words = new TextEncoder().encode(text), out = new Uint8Array(32 + words.length + bytes.length - 32 - table);
  out.set(bytes.subarray(0, 32));
  out.set(words, 32);
  out.set(bytes.subarray(32 + table), 32 + words.length);
  const view = new DataView(out.buffer);
  view.setUint32(8, words.length, true);
  let h = 0xcbf29ce484222325n;
  for (const b of out.subarray(32)) h = ((h ^ BigInt(b)) * 0x100000001b3n) & 0xffffffffffffffffn;
  view.setBigUint64(24, h, true);
  return out;
}
const text = new TextDecoder().decode(bytes.subarray(32, 32 + table));
decodeFilm(withTable(text)); // this checksum equals that of the film
const places = [...text.matchAll(/\["(f4|f8|i2|u2|u4)",(\d+),(\d+)\]/g)];
for (const [place, type, first, count] of places)
  for (const bad of [`["${type}",${first},${Number(count) + 1000000}]`, `["${type}",${Number(first) + 1},${count}]`, `["${type}",-8,${count}]`, '7', '["x1",0,0]', 'null', '{}'])
    if (bad !== 'null' || !text.includes(`"scalars":[${place}`)) refused(`${bad} for ${place}`, () => decodeFilm(withTable(text.replace(place, bad))));
for (const [from, to] of [['"shape":0', '"shape":99'], ['"shape":0', '"shape":-1'], ['"scenes":[', '"scenes":7,"x":['], ['"parts":[', '"parts":[null,'], ['{"title"', '[{"title"'],
                          ['"up":[', '"up":["a",'], ['"step":', '"step":null,"x":'], ['"name":', '"name":{},"x":'], ['"colour":', '"colour":-1,"x":'], ['"colour":', '"colour":"red","x":']])
  refused(`${to} for ${from}`, () => decodeFilm(withTable(text.replace(from, to))));

const film = decodeFilm(bytes);
for (const [s, scene] of film.scenes.entries()) {
  console.log('colour', s, 0, 0, scene.colour);
  for (let f = 0; f < scene.times.length; ++f)
    for (const [p, part] of scene.parts.entries()) {
      console.log('part', s, f, p, ...pointsOf(scene, part, f, new Float64Array(scene.shapes[part.shape].points.length)));
      const n = scene.shapes[part.shape].points.length / 3;
      for (const [k, values] of part.scalars.entries()) {
        const {low, high} = scene.scalars[k];
        if (values) console.log('scalar', s, f, p, k, ...Array.from(values.subarray(f * n, (f + 1) * n), (u) => u === 65535 ? 'none' : low + (high - low) * u / 65534));
      }
    }
  for (const [k, set] of scene.arrows.entries())
    for (let f = 0; f < scene.times.length; ++f)
      for (let i = set.firsts[f]; i < set.firsts[f + 1]; ++i)
        console.log('arrow', s, f, k, ...set.places.subarray(3 * i, 3 * i + 3), ...Array.from(set.vectors.subarray(3 * i, 3 * i + 3), (v) => v * set.step));
  for (const [k, plot] of scene.plots.entries()) console.log('plot', s, 0, k, ...plot.times, ...plot.values);
}
process.exit(failures === 0 ? 0 : 1);

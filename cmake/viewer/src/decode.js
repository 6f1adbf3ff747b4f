// The data of a film (include/polybody/io/film.hpp), read and checked. What is wrong with them is said in a
// sentence by a FilmError; nothing that passes can lead outside an array.

export class FilmError extends Error {}

const magic = 'pbfilm01';
const headBytes = 32;
const remedy = 'Write the film again, or copy it again from where it is whole.';

function refuse(what) {
  throw new FilmError(`${what} ${remedy}`);
}

/** Letters of base 64 as bytes. */
export function bytesOfBase64(text) {
  let letters;
  try {
    letters = atob(text.trim());
  } catch {
    return refuse('This film is damaged: its data are not complete, or not what was written.');
  }
  const bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; ++i) bytes[i] = letters.charCodeAt(i);
  return bytes;
}

/** FNV-1a of 64 bits, as [high, low] halves. The prime is 2^40 + 0x1b3. */
export function checksum(bytes, begin) {
  let high = 0xcbf29ce4, low = 0x84222325;
  for (let i = begin; i < bytes.length; ++i) {
    low = (low ^ bytes[i]) >>> 0;
    const product = low * 0x1b3;
    const carry = Math.floor(product / 0x100000000);
    high = (Math.imul(high, 0x1b3) + carry + (low << 8)) >>> 0;
    low = product >>> 0;
  }
  return [high, low];
}

/** The table of contents and the arrays behind it, both of the length and the sum that the head tells. */
function partsOf(bytes) {
  for (let i = 0; i < Math.min(magic.length, bytes.length); ++i)
    if (bytes[i] !== magic.charCodeAt(i))
      refuse(i < 6 ? 'These data are not a film of polybody.'
                   : 'This film was written by another version of polybody than its viewer is of.');
  if (bytes.length < headBytes) refuse(`This film is cut off: only ${bytes.length} bytes of its data are there.`);
  const head = new DataView(bytes.buffer, bytes.byteOffset, headBytes);
  const tableBytes = head.getUint32(8, true), arrayBytes = head.getUint32(16, true);
  if (head.getUint32(12, true) !== 0 || head.getUint32(20, true) !== 0) refuse('The head of this film is damaged.');
  const whole = headBytes + tableBytes + arrayBytes;
  if (bytes.length !== whole)
    refuse(`This film is ${bytes.length < whole ? 'cut off' : 'damaged'}: ${bytes.length} of ${whole} bytes of its data are there.`);
  const [high, low] = checksum(bytes, headBytes);
  if (head.getUint32(24, true) !== low || head.getUint32(28, true) !== high)
    refuse('This film is damaged: the sum of its data is not the one that was written.');
  return {table: bytes.subarray(headBytes, headBytes + tableBytes), arrays: bytes.slice(headBytes + tableBytes).buffer};
}

const types = {i1: Int8Array, f4: Float32Array, f8: Float64Array, i2: Int16Array, u2: Uint16Array, u4: Uint32Array};

/** Reads the members of a table of contents and refuses those that do not fit. */
class Reader {
  constructor(arrays) {
    this.arrays = arrays;
  }
  array(place, wantedTypes, count) {
    if (!Array.isArray(place) || place.length !== 3 || !wantedTypes.includes(place[0])) this.refuse('an array has no place');
    const Type = types[place[0]], [, first, numbers] = place;
    const fits = Number.isInteger(first) && Number.isInteger(numbers) && first >= 0 && numbers >= 0 && first % 8 === 0 &&
        first + numbers * Type.BYTES_PER_ELEMENT <= this.arrays.byteLength;
    if (!fits) this.refuse('an array lies outside the data');
    if (count !== undefined && numbers !== count) this.refuse(`an array has ${numbers} numbers in place of ${count}`);
    const values = new Type(this.arrays, first, numbers);
    if (place[0][0] === 'f')
      for (const x of values)
        if (!Number.isFinite(x)) this.refuse('a number is not finite');
    return values;
  }
  text(value) {
    return typeof value === 'string' ? value : this.refuse('a name is missing');
  }
  number(value) {
    return Number.isFinite(value) ? value : this.refuse('a number is missing');
  }
  list(value) {
    return Array.isArray(value) ? value : this.refuse('a list is missing');
  }
  vector(value) {
    if (this.list(value).length !== 3) this.refuse('a direction is missing');
    return value.map((x) => this.number(x));
  }
  rising(times) {
    for (let i = 1; i < times.length; ++i)
      if (!(times[i] > times[i - 1])) this.refuse('times do not rise');
    return times;
  }
  refuse(what) {
    return refuse(`The contents of this film are damaged: ${what}.`);
  }
}

function readShape(r, s) {
  const points = r.array(s.points, ['f4']), corners = r.array(s.corners, ['u4']), ends = r.array(s.ends, ['u4']);
  if (points.length % 3 !== 0) r.refuse('a point lacks a coordinate');
  let begin = 0;
  for (const end of ends) {
    if (end < begin + 3 || end > corners.length) r.refuse('a polygon has too few corners');
    begin = end;
  }
  if (begin !== corners.length) r.refuse('a corner belongs to no polygon');
  for (const c of corners)
    if (3 * c >= points.length) r.refuse('a corner is no point');
  return {points, corners, ends};
}

function readPart(r, p, scene) {
  const frames = scene.times.length;
  if (!Number.isInteger(p.shape) || p.shape < 0 || p.shape >= scene.shapes.length) r.refuse('a part has no shape');
  const points = scene.shapes[p.shape].points.length / 3;
  const rigid = p.deviations === undefined;
  if (r.list(p.scalars).length !== scene.scalars.length) r.refuse('a part lacks colours');
  return {
    name: r.text(p.name),
    shape: p.shape,
    rigid,
    places: r.array(p.places, ['f4'], 3 * frames),
    turns: r.array(p.turns, ['i2'], 4 * frames),
    deviations: rigid ? null : r.array(p.deviations, ['i1', 'i2'], 3 * points * frames),
    step: rigid ? 0 : r.number(p.step),
    scalars: p.scalars.map((s) => s === null ? null : r.array(s, ['u2'], points * frames)),
  };
}

function readArrows(r, a, frames) {
  const counts = r.array(a.counts, ['u4'], frames), firsts = new Float64Array(frames + 1);
  for (let i = 0; i < frames; ++i) firsts[i + 1] = firsts[i] + counts[i];
  const all = firsts[frames];
  return {
    label: r.text(a.label),
    unit: r.text(a.unit),
    shown: a.shown !== false,
    firsts,
    places: r.array(a.places, ['f4'], 3 * all),
    vectors: r.array(a.vectors, ['i2'], 3 * all),
    step: r.number(a.step),
  };
}

function readScene(r, s, k) {
  const colour = s.colour ?? k;
  if (!Number.isInteger(colour) || colour < 0) r.refuse('a scene has no colour');
  const times = r.rising(r.array(s.times, ['f8']));
  if (times.length === 0) r.refuse('a scene has no frame');
  const scene = {name: r.text(s.name), colour, times, withoutShape: r.list(s.withoutShape ?? []).map((name) => r.text(name))};
  scene.scalars = r.list(s.scalars).map(
      (c) => ({label: r.text(c.label), unit: r.text(c.unit), low: r.number(c.low), high: r.number(c.high)}));
  scene.shapes = r.list(s.shapes).map((shape) => readShape(r, shape));
  scene.parts = r.list(s.parts).map((part) => readPart(r, part, scene));
  scene.arrows = r.list(s.arrows).map((set) => readArrows(r, set, times.length));
  scene.plots = r.list(s.plots).map((h) => {
    const at = r.rising(r.array(h.times, ['f8']));
    return {label: r.text(h.label), unit: r.text(h.unit), times: at, values: r.array(h.values, ['f4'], at.length)};
  });
  return scene;
}

/** A film from its bytes. */
export function decodeFilm(bytes) {
  const {table, arrays} = partsOf(bytes);
  let contents;
  try {
    contents = JSON.parse(new TextDecoder('utf-8', {fatal: true}).decode(table));
  } catch {
    refuse('The table of contents of this film cannot be read.');
  }
  const r = new Reader(arrays);
  if (contents === null || typeof contents !== 'object') r.refuse('they are no object');
  try {
    const film = {
      title: r.text(contents.title),
      framesPerSecond: r.number(contents.framesPerSecond),
      lookFrom: r.vector(contents.lookFrom),
      up: r.vector(contents.up),
      follow: r.text(contents.follow),
      floor: r.text(contents.floor),
      scenes: r.list(contents.scenes).map((s, k) => readScene(r, s, k)),
    };
    if (film.scenes.length === 0) r.refuse('there is no scene');
    return film;
  } catch (error) {
    if (error instanceof FilmError) throw error;
    return r.refuse('a member is missing'); // a list or an object that is none
  }
}

/** The frame that is shown at a time: the last one that is not after it. */
export function frameAt(times, t) {
  let low = 0, high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= t + 1e-9) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** Rotation of a part in a frame as a matrix of nine numbers, row by row. */
export function rotationOf(turns, frame, out) {
  let w = turns[4 * frame], x = turns[4 * frame + 1], y = turns[4 * frame + 2], z = turns[4 * frame + 3];
  const size = Math.hypot(w, x, y, z) || 1;
  w /= size, x /= size, y /= size, z /= size;
  out[0] = 1 - 2 * (y * y + z * z), out[1] = 2 * (x * y - w * z), out[2] = 2 * (x * z + w * y);
  out[3] = 2 * (x * y + w * z), out[4] = 1 - 2 * (x * x + z * z), out[5] = 2 * (y * z - w * x);
  out[6] = 2 * (x * z - w * y), out[7] = 2 * (y * z + w * x), out[8] = 1 - 2 * (x * x + y * y);
  return out;
}

const matrix = new Float64Array(9);

/** Points of a part in a frame, in world axes, three numbers each. */
export function pointsOf(scene, part, frame, out) {
  const base = scene.shapes[part.shape].points, n = base.length, first = frame * n;
  const a = rotationOf(part.turns, frame, matrix);
  const px = part.places[3 * frame], py = part.places[3 * frame + 1], pz = part.places[3 * frame + 2];
  for (let i = 0; i < n; i += 3) {
    let x = base[i], y = base[i + 1], z = base[i + 2];
    if (part.deviations) {
      x += part.step * part.deviations[first + i];
      y += part.step * part.deviations[first + i + 1];
      z += part.step * part.deviations[first + i + 2];
    }
    out[i] = px + a[0] * x + a[1] * y + a[2] * z;
    out[i + 1] = py + a[3] * x + a[4] * y + a[5] * z;
    out[i + 2] = pz + a[6] * x + a[7] * y + a[8] * z;
  }
  return out;
}

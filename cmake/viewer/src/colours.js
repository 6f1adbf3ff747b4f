// Colours of scalars: blue, white and red about zero, or dark to light where all values have one sign; and the bar
// that says which is which.

const diverging = [[33, 82, 163], [104, 158, 211], [190, 214, 233], [240, 239, 235], [246, 199, 165], [221, 116, 82], [165, 28, 48]];
const rising = [[46, 30, 92], [45, 86, 142], [36, 135, 141], [66, 180, 116], [164, 212, 62], [250, 229, 60]];

/** Colours that colour-blind readers can tell apart [Okabe & Ito 2008], as the library's figures have them. */
export const palette = ['#0072b2', '#d55e00', '#009e73', '#e69f00', '#cc79a7', '#56b4e9', '#333333', '#b8a800'];

/** Colours of arrows, which no formulation has. */
export const arrowColours = ['#6a3d9a', '#1f6f78', '#8c510a', '#555b66', '#a6123a'];

/** 256 colours of three numbers in [0, 1], as they are seen (sRGB). */
function table(stops) {
  const out = new Float32Array(3 * 256);
  for (let i = 0; i < 256; ++i) {
    const at = i / 255 * (stops.length - 1), k = Math.min(Math.floor(at), stops.length - 2), u = at - k;
    for (let c = 0; c < 3; ++c) out[3 * i + c] = (stops[k][c] * (1 - u) + stops[k + 1][c] * u) / 255;
  }
  return out;
}
const tables = {diverging: table(diverging), rising: table(rising)};

/** Scalars of one label in all scenes share a scale. The scale ends where all but a hundredth of the values end on each
 *  side; beyond it colours stay as they are at its end. */
export function scaleOf(scenes, label) {
  let low = Infinity, high = -Infinity, unit = '';
  const found = [];
  for (const scene of scenes) {
    const k = scene.scalars.findIndex((s) => s.label === label);
    if (k < 0) continue;
    found.push([scene, k]);
    unit = scene.scalars[k].unit;
    if (!scene.parts.some((part) => part.scalars[k])) continue;
    low = Math.min(low, scene.scalars[k].low);
    high = Math.max(high, scene.scalars[k].high);
  }
  if (!(low <= high)) low = high = 0;
  const inner = innerRange(found, low, high);
  let [from, to] = inner;
  const signed = low < 0 && high > 0;
  if (signed) from = -(to = Math.max(-from, to));
  if (!(from < to)) from -= 0.5, to += 0.5;
  return {label, unit, low, high, from, to, colours: signed ? tables.diverging : tables.rising};
}

function innerRange(found, low, high) {
  const bins = 2048, counts = new Float64Array(bins), width = (high - low) / bins || 1;
  let all = 0;
  for (const [scene, k] of found) {
    const {low: a, high: b} = scene.scalars[k], step = (b - a) / 65534;
    for (const part of scene.parts) {
      const values = part.scalars[k];
      if (!values) continue;
      for (let i = 0; i < values.length; i += 3) { // a third of them tells enough
        if (values[i] === 65535) continue;
        ++counts[Math.min(bins - 1, Math.floor((a + step * values[i] - low) / width))];
        ++all;
      }
    }
  }
  let first = 0, last = bins - 1;
  for (let sum = counts[0]; first < last && sum < 0.01 * all; sum += counts[++first]);
  for (let sum = counts[last]; last > first && sum < 0.01 * all; sum += counts[--last]);
  return [low + first * width, low + (last + 1) * width];
}

/** Place of a value's colour in the table of a scale. */
export function colourIndex(scale, value) {
  return 3 * Math.max(0, Math.min(255, Math.round(255 * (value - scale.from) / (scale.to - scale.from))));
}

/** Numbers for the marks of an axis: 1, 2 or 5 times a power of ten apart. */
export function marks(low, high, most) {
  const raw = (high - low) / Math.max(1, most), power = Math.pow(10, Math.floor(Math.log10(raw)));
  const step = [1, 2, 5, 10].map((f) => f * power).find((s) => s >= raw * (1 - 1e-9)) || 10 * power;
  const out = [];
  for (let k = Math.ceil(low / step - 1e-9); k <= high / step + 1e-9; ++k) out.push(k * step);
  return {step, values: out};
}

/** A number as it stands at a mark. */
export function markText(value, step) {
  if (Math.abs(value) < 1e-9 * step) return '0';
  const size = Math.max(Math.abs(value), step);
  if (size >= 1e5 || step < 1e-4) return value.toExponential(Math.max(0, Math.min(3, Math.ceil(Math.log10(size / step) - 1e-9)))).replace('-', '−').replace('e+', 'e');
  return value.toFixed(Math.max(0, Math.ceil(-Math.log10(step) - 1e-9))).replace('-', '−');
}

/** A number with four digits, for read-outs. */
export function readOut(value) {
  const size = Math.abs(value);
  if (size !== 0 && (size >= 1e5 || size < 1e-3)) return value.toExponential(2).replace('-', '−').replace('e+', 'e');
  return Number(value.toPrecision(4)).toString().replace('-', '−');
}

/** Numbers of one quantity side by side: the largest has four digits, and all have the same number of decimals. */
export function readOuts(values) {
  const size = Math.max(...values.map(Math.abs));
  if (!(size >= 1e-3 && size < 1e5)) return values.map(readOut);
  const decimals = Math.max(0, 3 - Math.floor(Math.log10(size)));
  return values.map((value) => value.toFixed(decimals).replace('-', '−'));
}

export function drawBar(canvas, scale) {
  const ratio = devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
  canvas.width = width * ratio;
  canvas.height = height * ratio;
  const g = canvas.getContext('2d');
  g.scale(ratio, ratio);
  const left = 14, right = width - 14, top = 20, tall = 10;
  for (let x = left; x < right; ++x) {
    const i = 3 * Math.round(255 * (x - left) / (right - left - 1));
    g.fillStyle = `rgb(${[0, 1, 2].map((c) => Math.round(255 * scale.colours[i + c])).join()})`;
    g.fillRect(x, top, 1.5, tall);
  }
  g.fillStyle = '#333';
  g.font = '12px system-ui, sans-serif';
  g.textAlign = 'left';
  g.fillText(`${scale.label} [${scale.unit}]`, left, 13);
  g.textAlign = 'center';
  const {step, values} = marks(scale.from, scale.to, 5);
  for (const v of values) {
    const x = left + (right - left) * (v - scale.from) / (scale.to - scale.from);
    g.fillRect(x - 0.5, top + tall, 1, 4);
    g.fillText(markText(v, step), x, top + tall + 15);
  }
}

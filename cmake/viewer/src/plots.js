// Histories under the scenes, with a cursor at the time that is shown. Histories of one label share a plot.
import {markText, marks, palette, readOuts} from './colours.js';
import {frameAt} from './decode.js';

const left = 62, right = 14, top = 26, bottom = 36;

export class Plot {
  /** \param seek called with the time [s] under the pointer */
  constructor(label, film, range, seek) {
    this.label = label;
    this.range = range;
    this.curves = [];
    film.scenes.forEach((scene) => {
      for (const plot of scene.plots)
        if (plot.label === label) this.curves.push({...plot, name: scene.name, colour: palette[scene.colour % palette.length]});
    });
    this.unit = this.curves[0].unit;
    this.low = Infinity;
    this.high = -Infinity;
    for (const {values} of this.curves)
      for (const v of values) this.low = Math.min(this.low, v), this.high = Math.max(this.high, v);
    if (!(this.low < this.high)) {
      const size = Math.abs(this.high) || 1;
      this.low -= 0.1 * size, this.high += 0.1 * size;
    }
    const room = 0.06 * (this.high - this.low);
    this.low -= room, this.high += room;
    this.element = document.createElement('figure');
    this.element.className = 'plot';
    this.canvas = document.createElement('canvas');
    this.canvas.ariaLabel = `${label} [${this.unit}]`;
    this.cursor = document.createElement('div');
    this.cursor.className = 'cursor';
    const numbers = document.createElement('figcaption');
    for (const curve of this.curves) {
      curve.dot = document.createElement('i');
      curve.number = document.createElement('b');
      curve.number.style.color = curve.dot.style.background = curve.colour;
      numbers.append(curve.number);
    }
    this.element.append(this.canvas, this.cursor, ...this.curves.map((curve) => curve.dot), numbers);
    const drag = (event) => {
      if (event.buttons !== 1) return;
      const box = this.canvas.getBoundingClientRect(), u = (event.clientX - box.left - left) / (box.width - left - right);
      seek(this.range[0] + Math.max(0, Math.min(1, u)) * (this.range[1] - this.range[0]));
    };
    this.canvas.addEventListener('pointerdown', (event) => {
      this.canvas.setPointerCapture(event.pointerId);
      drag(event);
    });
    this.canvas.addEventListener('pointermove', drag);
  }

  x(t) {
    return left + (this.width - left - right) * (t - this.range[0]) / (this.range[1] - this.range[0] || 1);
  }
  y(v) {
    return this.height - bottom - (this.height - top - bottom) * (v - this.low) / (this.high - this.low);
  }

  /** Draws axes and curves, once for each size: the cursor goes over them. */
  resize() {
    const ratio = devicePixelRatio || 1;
    this.width = this.canvas.clientWidth;
    this.height = this.canvas.clientHeight;
    this.canvas.width = Math.round(this.width * ratio);
    this.canvas.height = Math.round(this.height * ratio);
    const g = this.canvas.getContext('2d');
    g.scale(ratio, ratio);
    this.drawAxes(g);
    g.save();
    g.beginPath();
    g.rect(left, top, this.width - left - right, this.height - top - bottom);
    g.clip();
    for (const curve of this.curves) this.drawCurve(g, curve);
    g.restore();
  }

  drawAxes(g) {
    g.font = '12px system-ui, sans-serif';
    g.fillStyle = '#222';
    g.textAlign = 'left';
    g.fillText(this.canvas.ariaLabel, left, 15);
    g.lineWidth = 1;
    g.strokeStyle = '#e1e4e8';
    g.fillStyle = '#555';
    const across = marks(this.range[0], this.range[1], Math.max(2, (this.width - left) / 70));
    g.textAlign = 'center';
    for (const t of across.values) {
      g.beginPath();
      g.moveTo(this.x(t), top);
      g.lineTo(this.x(t), this.height - bottom);
      g.stroke();
      g.fillText(markText(t, across.step), this.x(t), this.height - bottom + 15);
    }
    g.fillText('t [s]', left + (this.width - left - right) / 2, this.height - 6);
    const up = marks(this.low, this.high, Math.max(2, (this.height - top - bottom) / 26));
    g.textAlign = 'right';
    for (const v of up.values) {
      g.beginPath();
      g.moveTo(left, this.y(v));
      g.lineTo(this.width - right, this.y(v));
      g.stroke();
      g.fillText(markText(v, up.step), left - 7, this.y(v) + 4);
    }
    g.strokeStyle = '#888';
    g.beginPath();
    g.moveTo(left, top);
    g.lineTo(left, this.height - bottom);
    g.lineTo(this.width - right, this.height - bottom);
    g.stroke();
  }

  /** Of points within one pixel the first, the least, the largest and the last. */
  drawCurve(g, {times, values, colour}) {
    g.strokeStyle = colour;
    g.lineWidth = 1.5;
    g.lineJoin = 'round';
    g.beginPath();
    for (let i = 0; i < times.length;) {
      const column = Math.round(this.x(times[i]));
      let low = values[i], high = values[i], k = i;
      for (; k < times.length && Math.round(this.x(times[k])) === column; ++k)
        low = Math.min(low, values[k]), high = Math.max(high, values[k]);
      if (k - i <= 2)
        for (let j = i; j < k; ++j) g.lineTo(this.x(times[j]), this.y(values[j]));
      else
        for (const v of [values[i], low, high, values[k - 1]]) g.lineTo(column, this.y(v));
      i = k;
    }
    g.stroke();
  }

  draw(t) {
    const x = this.x(t), shown = this.curves.map((curve) => valueAt(curve, t));
    const texts = readOuts(shown.filter((value) => value !== null));
    this.cursor.style.transform = `translateX(${x}px)`;
    for (const [k, curve] of this.curves.entries()) {
      const value = shown[k];
      curve.number.textContent = value === null ? '' : texts.shift();
      curve.dot.hidden = value === null;
      if (value !== null) curve.dot.style.transform = `translate(${x}px, ${this.y(value)}px)`;
    }
  }
}

/** Between two points of a history on the line through them; nothing before its first and after its last. */
function valueAt({times, values}, t) {
  const k = frameAt(times, t), last = times.length - 1;
  if (t < times[0] - 1e-9 || t > times[last] + 1e-9) return null;
  if (k === last) return values[last];
  const u = Math.max(0, (t - times[k]) / (times[k + 1] - times[k]));
  return values[k] * (1 - u) + values[k + 1] * u;
}

/** The plots of a film, one for each label. */
export function plotsOf(film, range, seek) {
  const labels = [...new Set(film.scenes.flatMap((scene) => scene.plots.filter((p) => p.times.length > 0).map((p) => p.label)))];
  return labels.map((label) => new Plot(label, film, range, seek));
}

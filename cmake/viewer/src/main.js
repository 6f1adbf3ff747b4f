// The page: reads the film that stands in it, and plays it.
import {drawBar, palette, readOut, scaleOf} from './colours.js';
import {Clock} from './clock.js';
import {bytesOfBase64, decodeFilm, FilmError} from './decode.js';
import {plotsOf} from './plots.js';
import {Theatre} from './theatre.js';

const $ = (id) => document.getElementById(id);
const errors = [];

function say(sentence) {
  errors.push(sentence);
  $('notice').textContent = sentence;
  $('notice').hidden = false;
  $('player').hidden = true;
}

class Player {
  constructor(film) {
    this.film = film;
    this.clock = new Clock(film);
    $('player').hidden = false;
    $('title').textContent = film.title;
    try {
      this.theatre = new Theatre($('canvas'), film);
    } catch (error) {
      throw /webgl/i.test(String(error)) ? new FilmError('This browser cannot draw this film: it has no WebGL. Switch it on, or take another browser.') : error;
    }
    this.plots = plotsOf(film, [this.clock.first, this.clock.last], (t) => this.seek(t));
    $('plots').replaceChildren(...this.plots.map((plot) => plot.element));
    $('plots').hidden = this.plots.length === 0;
    this.labels = [...new Set(film.scenes.flatMap((s) => s.scalars.map((c) => c.label)))];
    this.colour = -1;
    if (this.labels.length > 0) this.nextColour();
    this.makeControls();
    this.makeLegends();
    document.addEventListener('keydown', (event) => this.key(event));
    new ResizeObserver(() => this.resize()).observe($('view'));
    this.resize();
    this.theatre.reset();
    const loop = (now) => {
      this.tick(now / 1000);
      requestAnimationFrame(loop);
    };
    requestAnimationFrame(loop);
    const at = /[#&]t=([\d.]+)/.exec(location.hash); // of an address such as film.html#t=2.5
    if (at) this.seek(Number(at[1]));
    else this.clock.playing = true;
  }

  makeControls() {
    const {clock} = this, scrub = $('scrub');
    scrub.min = clock.first;
    scrub.max = clock.last;
    scrub.step = 'any';
    scrub.addEventListener('input', () => this.seek(Number(scrub.value)));
    $('play').addEventListener('click', () => clock.toggle());
    $('back').addEventListener('click', () => clock.step(-1));
    $('forth').addEventListener('click', () => clock.step(1));
    $('slower').addEventListener('click', () => clock.change(-1));
    $('faster').addEventListener('click', () => clock.change(1));
    $('reset').addEventListener('click', () => this.theatre.reset());
    $('follow').hidden = !this.film.follow;
    $('follow').addEventListener('click', () => this.follow());
    $('colour').hidden = this.labels.length === 0;
    $('colour').addEventListener('click', () => this.nextColour());
    $('help').addEventListener('click', () => ($('keys').hidden = !$('keys').hidden));
    for (const button of document.querySelectorAll('button')) // keys stay with the page
      button.addEventListener('pointerup', () => button.blur());
    scrub.addEventListener('pointerup', () => scrub.blur());
  }

  /** Names of the scenes over their cells, and what arrows mean. */
  makeLegends() {
    $('cells').replaceChildren(...this.film.scenes.map((scene, k) => {
      const cell = document.createElement('div');
      cell.className = 'cell';
      const name = document.createElement('h2');
      name.textContent = scene.name;
      if (this.film.scenes.length > 1 && this.plots.length > 0) {
        const dot = document.createElement('i');
        dot.style.background = palette[scene.colour % palette.length];
        name.prepend(dot);
      }
      cell.append(name);
      if (scene.withoutShape.length > 0) {
        const note = document.createElement('p');
        note.textContent = `without a shape: ${scene.withoutShape.join(', ')}`;
        cell.append(note);
      }
      return cell;
    }));
    const arrows = this.theatre.arrowSets;
    $('arrows').hidden = arrows.length === 0;
    $('arrows').replaceChildren(...arrows.map((set) => {
      const item = document.createElement('button');
      set.item = item;
      item.className = 'arrow';
      item.style.setProperty('--colour', set.colour);
      item.addEventListener('click', () => {
        set.visible = !set.visible;
        this.theatre.dirty = true;
        this.tellArrows();
        item.blur();
      });
      return item;
    }));
    this.tellArrows();
    $('grid').textContent = this.film.floor === 'none' ? '' : `grid ${readOut(this.theatre.spacing)} m`;
  }

  tellArrows() {
    for (const set of this.theatre.arrowSets) {
      const one = set.scale * this.theatre.arrowFactor;
      set.item.textContent = !set.visible ? `show ${set.label}` : one > 0 ? `${set.label}, 1 m = ${readOut(Number((1 / one).toPrecision(2)))} ${set.unit}` : `${set.label}, all zero`;
      set.item.classList.toggle('off', !set.visible);
    }
  }

  nextColour() {
    this.colour = this.colour + 1 >= this.labels.length ? -1 : this.colour + 1;
    this.scale = this.colour < 0 ? null : scaleOf(this.film.scenes, this.labels[this.colour]);
    this.theatre.colourBy(this.labels[this.colour], this.scale);
    $('bar').hidden = !this.scale;
    if (this.scale) {
      drawBar($('bar'), this.scale);
      $('bar').title = `All values: ${readOut(this.scale.low)} to ${readOut(this.scale.high)} ${this.scale.unit}. ` +
          'Colours end where all but a hundredth of the values end on each side.';
    }
  }

  seek(t) {
    this.clock.playing = false;
    this.clock.seek(t);
  }
  follow() {
    this.theatre.follow(!this.theatre.following);
    $('follow').classList.toggle('off', !this.theatre.following);
  }
  show(scene) {
    this.theatre.only = scene < this.film.scenes.length ? scene : this.theatre.only;
    this.resize();
  }

  key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const {clock, theatre} = this, views = {s: 'side', f: 'front', t: 'top', r: 'start'};
    const actions = {
      ' ': () => clock.toggle(),
      ArrowRight: () => clock.step(event.shiftKey ? 10 : 1),
      ArrowLeft: () => clock.step(event.shiftKey ? -10 : -1),
      Home: () => this.seek(clock.first),
      End: () => this.seek(clock.last),
      '+': () => clock.change(1),
      '-': () => clock.change(-1),
      g: () => this.follow(),
      c: () => this.labels.length > 0 && this.nextColour(),
      '[': () => this.scaleArrows(1 / 1.5),
      ']': () => this.scaleArrows(1.5),
      '?': () => ($('keys').hidden = !$('keys').hidden),
      0: () => this.show(-1),
    };
    const key = event.key === '=' ? '+' : event.key;
    if (actions[key]) actions[key]();
    else if (views[key]) theatre.reset(views[key]);
    else if (/^[1-9]$/.test(key)) this.show(Number(key) - 1);
    else return;
    event.preventDefault();
  }

  scaleArrows(factor) {
    this.theatre.arrowFactor *= factor;
    this.theatre.dirty = true;
    this.tellArrows();
  }

  resize() {
    const {clientWidth: width, clientHeight: height} = $('view');
    if (width === 0 || height === 0) return;
    this.theatre.resize(width, height);
    const cells = this.theatre.cells(width, height);
    [...$('cells').children].forEach((element, k) => {
      const cell = cells.find((c) => c.scene === k);
      element.hidden = !cell;
      if (cell)
        for (const side of ['left', 'top']) element.style[side] = `${cell[side]}px`;
    });
    if (this.fitted !== `${width} ${height} ${this.theatre.only}`) this.theatre.reset();
    this.fitted = `${width} ${height} ${this.theatre.only}`;
    for (const plot of this.plots) plot.resize();
    if (this.scale) drawBar($('bar'), this.scale);
    this.shown = null;
  }

  tick(now) {
    const {clock, theatre} = this;
    clock.run(now);
    theatre.controls.update();
    if (theatre.draw(clock.time)) this.drawAxes();
    const state = `${clock.time} ${clock.playing} ${clock.speed}`;
    if (state === this.shown || (clock.playing && now - this.told < 0.06)) return;
    this.shown = state;
    this.told = now;
    const digits = clock.last - clock.first < 1 ? 4 : 2;
    $('time').textContent = `${clock.time.toFixed(digits)} s`;
    $('of').textContent = `of ${clock.last.toFixed(digits)} s`;
    $('speed').textContent = clock.speedText;
    $('scrub').value = clock.time;
    $('play').classList.toggle('playing', clock.playing);
    $('play').setAttribute('aria-label', clock.playing ? 'pause' : 'play');
    for (const plot of this.plots) plot.draw(clock.time);
  }

  /** The axes of the world in the corner. */
  drawAxes() {
    const canvas = $('axes'), ratio = devicePixelRatio || 1, size = 76, seen = `${ratio} ${this.theatre.camera.quaternion.toArray()}`;
    if (seen === this.axesSeen) return;
    this.axesSeen = seen;
    if (canvas.width !== size * ratio) canvas.width = canvas.height = size * ratio;
    const g = canvas.getContext('2d');
    g.setTransform(ratio, 0, 0, ratio, 0, 0);
    g.clearRect(0, 0, size, size);
    g.font = '600 12px system-ui, sans-serif';
    g.textAlign = 'center';
    g.lineWidth = 2;
    const colours = ['#c0392b', '#2e8b57', '#2c6fbb'], axes = this.theatre.axes();
    for (const i of [0, 1, 2].sort((a, b) => axes[a][2] - axes[b][2])) {
      const [x, y] = axes[i];
      g.strokeStyle = g.fillStyle = colours[i];
      g.beginPath();
      g.moveTo(size / 2, size / 2);
      g.lineTo(size / 2 + 24 * x, size / 2 - 24 * y);
      g.stroke();
      if (Math.hypot(x, y) > 0.15) g.fillText('xyz'[i], size / 2 + 32 * x, size / 2 - 32 * y + 4);
    }
  }
}

/** What tests ask the page. */
function testInterface(player) {
  const {theatre, clock, film} = player;
  return {
    errors,
    get drawn() { return theatre.drawn; },
    get time() { return clock.time; },
    get playing() { return clock.playing; },
    get speed() { return clock.speed; },
    get range() { return [clock.first, clock.last]; },
    get camera() { return theatre.camera.position.toArray(); },
    get shown() { return theatre.cells(theatre.width, theatre.height).map((c) => c.scene); },
    get size() { return [theatre.canvas.width, theatre.canvas.height]; },
    scale: () => player.scale && {from: player.scale.from, to: player.scale.to, label: player.scale.label},
    scenes: film.scenes.map((s) => ({
      name: s.name,
      times: [...s.times],
      parts: s.parts.map((p) => p.name),
      arrows: s.arrows.map((a) => ({label: a.label, count: a.places.length / 3})),
      plots: s.plots.map((p) => p.label),
    })),
    frames: () => theatre.stages.map((stage) => stage.frame),
    show(t) {
      player.seek(t);
      theatre.draw(clock.time);
    },
    points: (scene, part) => theatre.stages[scene].drawnPoints(part),
    /** The speed, and whether each picture of the screen is drawn anew, also where nothing has changed. */
    race(speed, always) {
      clock.speed = speed;
      theatre.always = always;
    },
  };
}

function start() {
  try {
    const data = $('film');
    if (!data)
      throw new FilmError([...document.body.childNodes].some((node) => node.nodeType === Node.COMMENT_NODE && node.data === 'polybody-film')
          ? 'There is no film in this page: it is the viewer alone. A Film of polybody writes pages with one.'
          : 'This film is cut off before its data begin. Write it again, or copy it again from where it is whole.');
    const [letters] = data.textContent.split('<'); // without the rest of a tag that is cut off
    const film = decodeFilm(bytesOfBase64(letters));
    data.remove(); // its letters are no longer needed
    $('notice').hidden = true;
    window.polybodyFilm = testInterface(new Player(film));
  } catch (error) {
    say(error instanceof FilmError ? error.message : `The viewer failed: ${error.message}`);
    if (!(error instanceof FilmError)) console.error(error);
    window.polybodyFilm = {errors};
  }
}

window.addEventListener('error', (event) => errors.push(event.message));
if (document.readyState === 'loading') document.addEventListener('DOMContentLoaded', start);
else start();

// All scenes on one canvas, side by side, seen by one camera at one time.
import * as THREE from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';

import {Arrows, longest} from './arrows.js';
import {arrowColours, marks} from './colours.js';
import {frameAt} from './decode.js';
import {cornersOf, gridOf, lookAtAll} from './extent.js';
import {flatMaterial} from './materials.js';
import {Stage} from './stage.js';

const background = '#f6f7f9', sheetColour = '#eef0f3', lineColour = '#d3d8de';

/** Edges are smoothed and shadows fall but where a processor draws in place of graphics hardware: there they cost half of the
 *  pictures. An address with #smooth has them there, too. */
function smooths() {
  if (/[#&]smooth\b/.test(location.hash)) return true;
  const gl = document.createElement('canvas').getContext('webgl2'), info = gl?.getExtension('WEBGL_debug_renderer_info');
  const name = info ? String(gl.getParameter(info.UNMASKED_RENDERER_WEBGL)) : '';
  gl?.getExtension('WEBGL_lose_context')?.loseContext();
  return !/swiftshader|llvmpipe|software/i.test(name);
}

export class Theatre {
  constructor(canvas, film) {
    this.film = film;
    this.canvas = canvas;
    this.smooth = smooths();
    this.renderer = new THREE.WebGLRenderer({canvas, antialias: this.smooth, powerPreference: 'high-performance'});
    this.renderer.setScissorTest(true);
    this.renderer.setClearColor(background);
    this.camera = new THREE.PerspectiveCamera(28, 1, 0.1, 1000);
    this.up = new THREE.Vector3(...film.up).normalize();
    this.from = new THREE.Vector3(...film.lookFrom).normalize();
    this.camera.up.copy(this.up);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => (this.dirty = true));
    const side = this.up.clone().cross(this.from).normalize();
    this.sun = this.up.clone().multiplyScalar(1.6).addScaledVector(this.from, 0.9).addScaledVector(side, -0.8).normalize();
    this.stages = film.scenes.map((scene) => new Stage(scene, film, this.up, this.sun));
    this.following = Boolean(film.follow);
    this.only = -1; // the one scene that is shown, or all
    this.dirty = true;
    this.always = false; // draw also what has not changed
    this.drawn = 0; // pictures since the page was opened
    this.arrowFactor = 1;
    this.measure();
    for (const stage of this.stages) this.furnish(stage);
    this.addArrows();
    this.reset();
  }

  /** Corners of what is seen: of all frames where they are, and with the camera going along. */
  measure() {
    this.corners = [];
    this.lowest = Infinity;
    for (const stage of this.stages) {
      stage.corners = cornersOf(stage.scene, (f, out) => out.set(0, 0, 0));
      this.corners.push(...cornersOf(stage.scene, (f, out) => this.following ? stage.offset(f, out) : out.set(0, 0, 0)));
    }
    const {size} = lookAtAll(this.camera, this.corners, this.from, this.up);
    this.size = size;
    this.spacing = marks(0, size, 14).step;
  }

  furnish(stage) {
    if (this.film.floor === 'none') return;
    const ground = this.film.floor === 'ground', normal = ground ? this.up : this.from;
    let height = Infinity;
    for (const c of stage.corners) height = Math.min(height, c.dot(normal));
    height -= (ground ? 1e-4 : 0.02) * this.size;
    const {lines, sheet} = gridOf(stage.corners, normal, height, this.spacing, (ground ? 0.35 : 0.1) * this.size);
    const paper = new THREE.Mesh(sheet, flatMaterial(
        sheetColour, {side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 2}));
    paper.renderOrder = -2;
    const grid = new THREE.LineSegments(lines, flatMaterial(lineColour));
    grid.renderOrder = -1;
    stage.root.add(paper, grid);
    if (ground && this.smooth) stage.castShadows(this.up, height, this.sun);
  }

  addArrows() {
    const labels = [...new Set(this.film.scenes.flatMap((scene) => scene.arrows.map((set) => set.label)))];
    const shown = new Map(this.film.scenes.flatMap((scene) => scene.arrows.map((set) => [set.label, set.shown])));
    this.arrowSets = labels.map((label, k) => {
      const most = longest(this.film.scenes, label), unit = this.film.scenes.flatMap((s) => s.arrows).find((s) => s.label === label).unit;
      return {label, unit, most, colour: arrowColours[k % arrowColours.length], scale: most > 0 ? 0.18 * this.size / most : 0, visible: shown.get(label)};
    });
    for (const stage of this.stages)
      stage.arrows = stage.scene.arrows.map((set) => {
        const kind = this.arrowSets.find((s) => s.label === set.label);
        return {kind, drawn: new Arrows(set, kind.colour, 0.003 * this.size, stage)};
      });
  }

  /** The camera of the start, or one along an axis: "front", "side" or "top". */
  reset(view = 'start') {
    const along = this.from.clone().addScaledVector(this.up, -this.from.dot(this.up));
    if (along.length() < 1e-6) along.set(1, 0, 0);
    const axes = [new THREE.Vector3(1, 0, 0), new THREE.Vector3(0, 1, 0), new THREE.Vector3(0, 0, 1)]
                     .filter((a) => Math.abs(a.dot(this.up)) < 0.5)
                     .map((a) => a.multiplyScalar(Math.sign(a.dot(this.from)) || 1));
    axes.sort((a, b) => b.dot(this.from) - a.dot(this.from));
    const from = {start: this.from, side: axes[0], front: axes[1], top: this.up.clone().addScaledVector(along.normalize(), 1e-3)}[view];
    const {target} = lookAtAll(this.camera, this.corners, from, this.up);
    this.controls.target.copy(target);
    this.controls.update();
    this.dirty = true;
  }

  follow(on) {
    this.following = on && Boolean(this.film.follow);
    this.measureAgain();
  }
  measureAgain() {
    this.corners = this.stages.flatMap(
        (stage) => cornersOf(stage.scene, (f, out) => this.following ? stage.offset(f, out) : out.set(0, 0, 0)));
    this.reset();
  }

  colourBy(label, scale) {
    for (const stage of this.stages) stage.colourBy(scale);
    this.dirty = true;
  }

  /** Rectangles of the scenes on the canvas, from its upper left corner [CSS pixels]. */
  cells(width, height) {
    const shown = this.only < 0 ? this.stages.map((_, i) => i) : [this.only], n = shown.length;
    let columns = 1, best = -1;
    for (let c = 1; c <= n; ++c) {
      const w = width / c, h = height / Math.ceil(n / c), fit = Math.min(w / 1.6, h);
      if (fit > best) best = fit, columns = c;
    }
    const rows = Math.ceil(n / columns);
    return shown.map((scene, k) => ({
      scene,
      left: (k % columns) * Math.floor(width / columns),
      top: Math.floor(k / columns) * Math.floor(height / rows),
      width: Math.floor(width / columns),
      height: Math.floor(height / rows),
    }));
  }

  resize(width, height) {
    this.renderer.setPixelRatio(Math.min(devicePixelRatio || 1, 2));
    this.renderer.setSize(width, height, false);
    this.width = width;
    this.height = height;
    const [cell] = this.cells(width, height);
    this.camera.aspect = cell.width / cell.height;
    this.camera.updateProjectionMatrix();
    this.dirty = true;
  }

  fill(colour, left, bottom, width, height) {
    this.renderer.setScissor(left, bottom, width, height);
    this.renderer.setClearColor(colour);
    this.renderer.clear();
  }

  /** Draws the time t [s], unless nothing has changed. Returns whether it drew. */
  draw(t) {
    for (const stage of this.stages) {
      const frame = frameAt(stage.scene.times, t);
      if (frame !== stage.frame) this.dirty = true;
    }
    if (!this.dirty && !this.always) return false;
    this.dirty = false;
    this.fill(background, 0, 0, this.width, this.height); // where no scene is
    for (const cell of this.cells(this.width, this.height)) {
      const stage = this.stages[cell.scene], frame = frameAt(stage.scene.times, t);
      stage.setFrame(frame);
      if (this.following) stage.offset(frame, stage.root.position);
      else stage.root.position.set(0, 0, 0);
      for (const {kind, drawn} of stage.arrows) {
        drawn.visible = kind.visible;
        if (kind.visible) drawn.setFrame(frame, kind.scale * this.arrowFactor);
      }
      const bottom = this.height - cell.top - cell.height;
      const line = {left: cell.left > 0 ? 1 : 0, top: cell.top > 0 ? 1 : 0}; // between the scenes
      if (line.left) this.fill(lineColour, cell.left, bottom, 1, cell.height);
      if (line.top) this.fill(lineColour, cell.left, bottom + cell.height - 1, cell.width, 1);
      this.renderer.setClearColor(background);
      this.renderer.setViewport(cell.left, bottom, cell.width, cell.height);
      this.renderer.setScissor(cell.left + line.left, bottom, cell.width - line.left, cell.height - line.top);
      this.renderer.render(stage.world, this.camera);
    }
    ++this.drawn;
    return true;
  }

  /** The axes x, y, z as the camera sees them: [right, up, towards the eye] of each. */
  axes() {
    const turn = this.camera.quaternion.clone().invert();
    return [0, 1, 2].map((i) => new THREE.Vector3().setComponent(i, 1).applyQuaternion(turn).toArray());
  }
}

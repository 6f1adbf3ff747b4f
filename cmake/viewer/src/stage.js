// One scene of a film as one mesh of three.js, whose vertices are written for each frame: instances cost far more where a
// processor draws in place of graphics hardware.
import * as THREE from 'three';

import {colourIndex} from './colours.js';
import {pointsOf} from './decode.js';
import {flatMaterial, litMaterial} from './materials.js';
import {meshOf, writeVertices} from './surfaces.js';

const paints = ['#7d93a8', '#c8b48c', '#5f7f78', '#b58a73', '#8f89b0', '#a9b0b6', '#9fae7e', '#6a86b0'];
const plain = ['#b3b9ad', '#c4c8cc', '#98a2ac', '#bab4a9', '#a5adb8'];
const shadowColour = '#d9dee4';

/** Parts are of one kind when their names differ in numbers and sides only. */
const kindOf = (name) => name.replace(/\b(left|right)\b/g, '').replace(/[0-9]+/g, '').replace(/\s+/g, ' ').trim();

const linear = (r, g, b) => new THREE.Color().setRGB(r, g, b, THREE.SRGBColorSpace);

export class Stage {
  /** \param sky, sun directions to where light comes from */
  constructor(scene, film, sky, sun) {
    this.sky = sky;
    this.sun = sun;
    this.scene = scene;
    this.film = film;
    this.root = new THREE.Group(); // moved against the part that the camera follows
    this.world = new THREE.Scene();
    this.world.add(this.root);
    this.followed = film.follow ? scene.parts.findIndex((part) => part.name === film.follow) : -1;
    this.frame = -1;
    this.scale = null;
    this.scalar = -1;
    this.colours = this.paintsOf(scene);
    this.build();
  }

  paintsOf(scene) {
    const kinds = new Map(), coloured = this.film.scenes.some((other) => other.scalars.length > 0), paint = coloured ? plain : paints;
    return scene.parts.map((part) => {
      const kind = kindOf(part.name);
      if (!kinds.has(kind)) kinds.set(kind, kinds.size);
      return new THREE.Color(paint[kinds.get(kind) % paint.length]);
    });
  }

  /** Which scalar gives the colours, by its scale; null for none. */
  colourBy(scale) {
    this.scale = scale;
    this.scalar = scale ? this.scene.scalars.findIndex((s) => s.label === scale.label) : -1;
    for (const w of this.drawn) this.paint(w, this.colours[w.index]);
    this.mesh.geometry.attributes.color.needsUpdate = true;
    this.frame = -1;
  }

  coloured(part) {
    return this.scalar >= 0 && part.scalars[this.scalar] !== null;
  }

  build() {
    const meshes = this.scene.shapes.map(meshOf);
    let vertices = 0, triangles = 0;
    this.drawn = this.scene.parts.map((part, index) => {
      const mesh = meshes[part.shape], first = vertices, {points} = this.scene.shapes[part.shape];
      vertices += mesh.pointOf.length;
      triangles += mesh.triangles.length;
      return {index, mesh, first, points: new Float32Array(points.length), normals: new Float32Array(3 * mesh.ends.length)};
    });
    const geometry = new THREE.BufferGeometry(), index = new Uint32Array(triangles);
    let at = 0;
    for (const w of this.drawn)
      for (const v of w.mesh.triangles) index[at++] = w.first + v;
    for (const name of ['position', 'normal', 'color']) {
      const attribute = new THREE.BufferAttribute(new Float32Array(3 * vertices), 3);
      attribute.setUsage(THREE.DynamicDrawUsage);
      geometry.setAttribute(name, attribute);
    }
    geometry.setIndex(new THREE.BufferAttribute(index, 1));
    this.mesh = new THREE.Mesh(geometry, litMaterial(null, this.sky, this.sun));
    this.mesh.frustumCulled = false;
    this.root.add(this.mesh);
    for (const w of this.drawn) this.paint(w, this.colours[w.index]);
  }

  paint(w, colour) {
    const colours = this.mesh.geometry.attributes.color.array;
    for (let v = 0; v < w.mesh.pointOf.length; ++v) colour.toArray(colours, 3 * (w.first + v));
  }

  /** Flat pictures of all that is drawn on the plane normal·x = height, along the light. */
  castShadows(normal, height, light) {
    const d = light.clone().divideScalar(light.dot(normal)), n = normal, m = new THREE.Matrix4();
    // x − d (n·x − height)
    m.set(1 - d.x * n.x, -d.x * n.y, -d.x * n.z, d.x * height,
          -d.y * n.x, 1 - d.y * n.y, -d.y * n.z, d.y * height,
          -d.z * n.x, -d.z * n.y, 1 - d.z * n.z, d.z * height,
          0, 0, 0, 1);
    const shadow = new THREE.Mesh(this.mesh.geometry, flatMaterial(
        shadowColour, {side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -1}));
    shadow.frustumCulled = shadow.matrixAutoUpdate = false;
    shadow.matrix.copy(m);
    this.root.add(shadow);
  }

  /** Where the root stands, so that the part that is followed stays where it is in the first frame. */
  offset(frame, out) {
    if (this.followed < 0) return out.set(0, 0, 0);
    const p = this.scene.parts[this.followed].places;
    return out.set(p[0] - p[3 * frame], p[1] - p[3 * frame + 1], p[2] - p[3 * frame + 2]);
  }

  setFrame(frame) {
    if (frame === this.frame) return;
    const {position, normal, color} = this.mesh.geometry.attributes, before = this.frame;
    this.frame = frame;
    let painted = false;
    for (const w of this.drawn) {
      const part = this.scene.parts[w.index];
      if (before < 0 || !part.rigid || moves(part, before, frame)) {
        pointsOf(this.scene, part, frame, w.points);
        writeVertices(w.mesh, w.points, w.normals, position.array, normal.array, w.first);
      }
      if (!this.coloured(part)) continue;
      this.paintScalar(w, part, frame);
      painted = true;
    }
    position.needsUpdate = normal.needsUpdate = true;
    color.needsUpdate ||= painted;
  }

  paintScalar(w, part, frame) {
    const values = part.scalars[this.scalar], {low, high} = this.scene.scalars[this.scalar], n = w.points.length / 3;
    const table = this.linearTable(), colours = this.mesh.geometry.attributes.color.array, grey = this.colours[w.index];
    for (let v = 0; v < w.mesh.pointOf.length; ++v) {
      const u = values[frame * n + w.mesh.pointOf[v]], at = 3 * (w.first + v);
      if (u === 65535) {
        colours[at] = grey.r, colours[at + 1] = grey.g, colours[at + 2] = grey.b;
        continue;
      }
      const i = colourIndex(this.scale, low + (high - low) * u / 65534);
      colours[at] = table[i], colours[at + 1] = table[i + 1], colours[at + 2] = table[i + 2];
    }
  }

  /** The colours of the scale as light is added, not as it is seen. */
  linearTable() {
    if (this.tableOf === this.scale) return this.table;
    this.tableOf = this.scale;
    this.table = new Float32Array(768);
    for (let i = 0; i < 768; i += 3) linear(...this.scale.colours.subarray(i, i + 3)).toArray(this.table, i);
    return this.table;
  }

  /** Points of a part as they were given to the graphics: places of its vertices, put back to their points. */
  drawnPoints(index) {
    const w = this.drawn[index], out = new Array(w.points.length), p = this.mesh.geometry.attributes.position.array;
    w.mesh.pointOf.forEach((point, v) => {
      for (let c = 0; c < 3; ++c) out[3 * point + c] = p[3 * (w.first + v) + c];
    });
    return out;
  }
}

function moves({places, turns}, before, frame) {
  for (let c = 0; c < 3; ++c)
    if (places[3 * before + c] !== places[3 * frame + c]) return true;
  for (let c = 0; c < 4; ++c)
    if (turns[4 * before + c] !== turns[4 * frame + c]) return true;
  return false;
}

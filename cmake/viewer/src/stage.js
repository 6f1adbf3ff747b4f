// One scene of a film as objects of three.js: shapes that only move are instances, shapes that deform or are coloured
// point by point share one mesh whose vertices are written for each frame.
import * as THREE from 'three';

import {colourIndex} from './colours.js';
import {pointsOf, rotationOf} from './decode.js';
import {meshOf, writeVertices} from './surfaces.js';

const paints = ['#7d93a8', '#c8b48c', '#5f7f78', '#b58a73', '#8f89b0', '#a9b0b6', '#9fae7e', '#6a86b0'];
const plain = ['#b4bcc4', '#9aa4ad', '#c6ccd2'];
const shadowColour = '#d9dee4';

/** Parts are of one kind when their names differ in numbers and sides only. */
const kindOf = (name) => name.replace(/\b(left|right)\b/g, '').replace(/[0-9]+/g, '').replace(/\s+/g, ' ').trim();

const linear = (r, g, b) => new THREE.Color().setRGB(r, g, b, THREE.SRGBColorSpace);

export class Stage {
  constructor(scene, film) {
    this.scene = scene;
    this.film = film;
    this.root = new THREE.Group(); // moved against the part that the camera follows
    this.world = new THREE.Scene();
    this.world.add(this.root);
    this.followed = film.follow ? scene.parts.findIndex((part) => part.name === film.follow) : -1;
    this.frame = -1;
    this.scale = null;
    this.scalar = -1;
    this.meshes = scene.shapes.map(meshOf);
    this.material = new THREE.MeshPhongMaterial({color: '#ffffff', specular: '#222222', shininess: 24});
    this.colours = this.paintsOf(scene);
    this.rebuild();
  }

  paintsOf(scene) {
    const kinds = new Map(), coloured = scene.scalars.length > 0, paint = coloured ? plain : paints;
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
    this.rebuild();
  }

  coloured(part) {
    return this.scalar >= 0 && part.scalars[this.scalar] !== null;
  }

  /** Sorts the parts into instances and the mesh that is written anew. */
  rebuild() {
    for (const object of this.drawn || []) {
      this.root.remove(object);
      if (object.geometry) object.geometry.dispose();
      if (object.isInstancedMesh) object.dispose();
    }
    this.drawn = [];
    this.instances = [];
    this.written = [];
    const ofShape = this.scene.shapes.map(() => []);
    this.scene.parts.forEach((part, i) => {
      if (part.rigid && !this.coloured(part)) ofShape[part.shape].push(i);
      else this.written.push({index: i, first: 0});
    });
    ofShape.forEach((parts, shape) => {
      if (parts.length > 0) this.addInstances(shape, parts);
    });
    if (this.written.length > 0) this.addWritten();
    this.frame = -1;
    if (this.shadow) this.addShadows();
  }

  addInstances(shape, parts) {
    const mesh = this.meshes[shape], geometry = new THREE.BufferGeometry(), n = mesh.pointOf.length;
    const positions = new Float32Array(3 * n), normals = new Float32Array(3 * n);
    writeVertices(mesh, this.scene.shapes[shape].points, new Float32Array(3 * mesh.ends.length), positions, normals, 0);
    geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
    geometry.setAttribute('normal', new THREE.BufferAttribute(normals, 3));
    geometry.setIndex(new THREE.BufferAttribute(mesh.triangles, 1));
    const object = new THREE.InstancedMesh(geometry, this.material, parts.length);
    object.frustumCulled = false;
    object.instanceMatrix.setUsage(THREE.DynamicDrawUsage);
    parts.forEach((part, i) => object.setColorAt(i, this.colours[part]));
    this.instances.push({object, parts});
    this.show(object);
  }

  addWritten() {
    let vertices = 0, triangles = 0;
    for (const w of this.written) {
      const mesh = this.meshes[this.scene.parts[w.index].shape];
      w.mesh = mesh;
      w.first = vertices;
      w.points = new Float32Array(this.scene.shapes[this.scene.parts[w.index].shape].points.length);
      w.normals = new Float32Array(3 * mesh.ends.length);
      vertices += mesh.pointOf.length;
      triangles += mesh.triangles.length;
    }
    const geometry = new THREE.BufferGeometry(), index = new Uint32Array(triangles);
    let at = 0;
    for (const w of this.written)
      for (const v of w.mesh.triangles) index[at++] = w.first + v;
    for (const name of ['position', 'normal', 'color']) {
      const attribute = new THREE.BufferAttribute(new Float32Array(3 * vertices), 3);
      attribute.setUsage(THREE.DynamicDrawUsage);
      geometry.setAttribute(name, attribute);
    }
    geometry.setIndex(new THREE.BufferAttribute(index, 1));
    const material = this.material.clone();
    material.vertexColors = true;
    this.deforming = new THREE.Mesh(geometry, material);
    this.deforming.frustumCulled = false;
    for (const w of this.written) this.paint(w, () => this.colours[w.index]);
    this.show(this.deforming);
  }

  show(object) {
    this.drawn.push(object);
    this.root.add(object);
  }

  paint(w, colourOf) {
    const colours = this.deforming.geometry.attributes.color.array;
    for (let v = 0; v < w.mesh.pointOf.length; ++v) {
      const c = colourOf(w.mesh.pointOf[v]), at = 3 * (w.first + v);
      colours[at] = c.r, colours[at + 1] = c.g, colours[at + 2] = c.b;
    }
  }

  /** Flat pictures of all that is drawn on the plane normal·x = height, along the light. */
  castShadows(normal, height, light) {
    const d = light.clone().divideScalar(light.dot(normal)), n = normal, m = new THREE.Matrix4();
    // x − d (n·x − height)
    m.set(1 - d.x * n.x, -d.x * n.y, -d.x * n.z, d.x * height,
          -d.y * n.x, 1 - d.y * n.y, -d.y * n.z, d.y * height,
          -d.z * n.x, -d.z * n.y, 1 - d.z * n.z, d.z * height,
          0, 0, 0, 1);
    this.shadow = new THREE.Group();
    this.shadow.matrixAutoUpdate = false;
    this.shadow.matrix.copy(m);
    this.shadowMaterial = new THREE.MeshBasicMaterial(
        {color: shadowColour, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -1});
    this.root.add(this.shadow);
    this.addShadows();
  }

  addShadows() {
    this.shadow.clear();
    for (const {object, parts} of this.instances) {
      const flat = new THREE.InstancedMesh(object.geometry, this.shadowMaterial, parts.length);
      flat.instanceMatrix = object.instanceMatrix;
      flat.frustumCulled = false;
      this.shadow.add(flat);
    }
    if (this.written.length > 0) {
      const flat = new THREE.Mesh(this.deforming.geometry, this.shadowMaterial);
      flat.frustumCulled = false;
      this.shadow.add(flat);
    }
  }

  /** Where the root stands, so that the part that is followed stays where it is in the first frame. */
  offset(frame, out) {
    if (this.followed < 0) return out.set(0, 0, 0);
    const p = this.scene.parts[this.followed].places;
    return out.set(p[0] - p[3 * frame], p[1] - p[3 * frame + 1], p[2] - p[3 * frame + 2]);
  }

  setFrame(frame) {
    if (frame === this.frame) return;
    this.frame = frame;
    const a = new Float64Array(9);
    for (const {object, parts} of this.instances) {
      const m = object.instanceMatrix.array;
      parts.forEach((index, i) => {
        const {places, turns} = this.scene.parts[index], at = 16 * i;
        rotationOf(turns, frame, a);
        for (let row = 0; row < 3; ++row) {
          for (let column = 0; column < 3; ++column) m[at + 4 * column + row] = a[3 * row + column];
          m[at + 4 * 3 + row] = places[3 * frame + row];
          m[at + 4 * row + 3] = 0;
        }
        m[at + 15] = 1;
      });
      object.instanceMatrix.needsUpdate = true;
    }
    if (this.written.length > 0) this.writeFrame(frame);
  }

  writeFrame(frame) {
    const {position, normal, color} = this.deforming.geometry.attributes;
    for (const w of this.written) {
      const part = this.scene.parts[w.index];
      pointsOf(this.scene, part, frame, w.points);
      writeVertices(w.mesh, w.points, w.normals, position.array, normal.array, w.first);
      if (this.coloured(part)) this.paintScalar(w, part, frame);
    }
    position.needsUpdate = normal.needsUpdate = color.needsUpdate = true;
  }

  paintScalar(w, part, frame) {
    const values = part.scalars[this.scalar], {low, high} = this.scene.scalars[this.scalar], n = w.points.length / 3;
    const table = this.linearTable(), colours = this.deforming.geometry.attributes.color.array, grey = this.colours[w.index];
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
    const out = new Array(this.scene.shapes[this.scene.parts[index].shape].points.length);
    const w = this.written.find((x) => x.index === index);
    if (w) {
      const p = this.deforming.geometry.attributes.position.array;
      w.mesh.pointOf.forEach((point, v) => {
        for (let c = 0; c < 3; ++c) out[3 * point + c] = p[3 * (w.first + v) + c];
      });
      return out;
    }
    const {object, parts} = this.instances.find((x) => x.parts.includes(index));
    const matrix = new THREE.Matrix4(), point = new THREE.Vector3();
    object.getMatrixAt(parts.indexOf(index), matrix);
    const p = object.geometry.attributes.position.array;
    this.meshes[this.scene.parts[index].shape].pointOf.forEach((k, v) => {
      point.fromArray(p, 3 * v).applyMatrix4(matrix).toArray(out, 3 * k);
    });
    return out;
  }
}

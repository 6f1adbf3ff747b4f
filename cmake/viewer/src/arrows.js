// Forces and other vectors of a scene as arrows: one mesh, whose vertices are written for each frame.
import * as THREE from 'three';

import {litMaterial} from './materials.js';

const sides = 6, verticesOf = 4 * sides + 1;

/** The longest vector of a label in all scenes. */
export function longest(scenes, label) {
  let most = 0;
  for (const scene of scenes)
    for (const set of scene.arrows) {
      if (set.label !== label) continue;
      const v = set.vectors;
      for (let i = 0; i < v.length; i += 3) most = Math.max(most, set.step * Math.hypot(v[i], v[i + 1], v[i + 2]));
    }
  return most;
}

export class Arrows {
  /** \param width of a shaft [m] */
  constructor(set, colour, width, {root, sky, sun}) {
    this.set = set;
    this.width = width;
    let most = 1;
    for (let i = 0; i + 1 < set.firsts.length; ++i) most = Math.max(most, set.firsts[i + 1] - set.firsts[i]);
    const geometry = new THREE.BufferGeometry(), index = [];
    for (let i = 0; i < most; ++i)
      for (let k = 0; k < sides; ++k) {
        const at = i * verticesOf, next = (k + 1) % sides, tip = at + 4 * sides;
        index.push(at + k, at + next, at + sides + next, at + k, at + sides + next, at + sides + k); // shaft
        index.push(at + 2 * sides + k, at + 2 * sides + next, tip); // head, and its base as a ring from the shaft
        index.push(at + 3 * sides + next, at + 3 * sides + k, at + sides + k, at + 3 * sides + next, at + sides + k, at + sides + next);
      }
    for (const name of ['position', 'normal']) {
      const attribute = new THREE.BufferAttribute(new Float32Array(3 * verticesOf * most), 3);
      attribute.setUsage(THREE.DynamicDrawUsage);
      geometry.setAttribute(name, attribute);
    }
    geometry.setIndex(index);
    // over all else, for most begin inside of bodies
    const material = litMaterial(colour, sky, sun, {depthTest: false, depthWrite: false});
    this.mesh = new THREE.Mesh(geometry, material);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 1;
    root.add(this.mesh);
  }

  set visible(on) {
    this.mesh.visible = on;
  }

  /** \param scale metres for each unit of the vectors */
  setFrame(frame, scale) {
    const {firsts, places, vectors, step} = this.set, first = firsts[frame], count = firsts[frame + 1] - first;
    const {position, normal} = this.mesh.geometry.attributes;
    const place = new THREE.Vector3(), along = new THREE.Vector3(), a = new THREE.Vector3(), b = new THREE.Vector3();
    const out = new THREE.Vector3(), p = new THREE.Vector3();
    let at = 0;
    const put = (from, radial, axial, n) => {
      p.copy(place).addScaledVector(along, from).addScaledVector(out, radial).toArray(position.array, at);
      p.copy(out).multiplyScalar(1 - Math.abs(n)).addScaledVector(along, axial + n).toArray(normal.array, at);
      at += 3;
    };
    for (let i = 0; i < count; ++i) {
      place.fromArray(places, 3 * (first + i));
      along.fromArray(vectors, 3 * (first + i)).multiplyScalar(step * scale);
      const length = along.length();
      if (length > 0) along.divideScalar(length);
      else along.set(0, 0, 1);
      a.set(Math.abs(along.x) < 0.9 ? 1 : 0, Math.abs(along.x) < 0.9 ? 0 : 1, 0).cross(along).normalize();
      b.copy(along).cross(a);
      const head = Math.min(4 * this.width, length), thick = 0.5 * this.width * head / (4 * this.width); // short ones are thin
      const ring = (from, radius, axial, n) => {
        for (let k = 0; k < sides; ++k) {
          const angle = 2 * Math.PI * k / sides;
          out.copy(a).multiplyScalar(Math.cos(angle)).addScaledVector(b, Math.sin(angle));
          put(from, radius, axial, n);
        }
      };
      ring(0, thick, 0, 0);
      ring(length - head, thick, 0, 0);
      ring(length - head, 2.8 * thick, 0.35, 0);
      ring(length - head, 2.8 * thick, 0, -1);
      put(length, 0, 1, 0);
    }
    this.mesh.geometry.setDrawRange(0, 15 * sides * count);
    position.needsUpdate = normal.needsUpdate = true;
  }
}

// How far scenes reach: what the camera has to see, and where the floor lies.
import * as THREE from 'three';

import {pointsOf} from './decode.js';

/** Boxes of the parts in some frames of a scene: eight corners each, less `offset` of the frame. */
export function cornersOf(scene, offsetOf, most = 24) {
  const frames = scene.times.length, every = Math.max(1, Math.ceil(frames / most)), out = [];
  const offset = new THREE.Vector3(), box = new THREE.Box3(), p = new THREE.Vector3();
  for (let f = 0; f < frames; f += every) {
    offsetOf(f, offset);
    for (const part of scene.parts) {
      const points = pointsOf(scene, part, f, new Float32Array(scene.shapes[part.shape].points.length));
      box.makeEmpty();
      for (let i = 0; i < points.length; i += 3) box.expandByPoint(p.fromArray(points, i));
      for (let c = 0; c < 8; ++c)
        out.push(new THREE.Vector3(c & 1 ? box.max.x : box.min.x, c & 2 ? box.max.y : box.min.y, c & 4 ? box.max.z : box.min.z)
                     .add(offset));
    }
  }
  return out;
}

/** Puts the camera as near as it can stand along `from` and see all corners; returns what it looks at. */
export function lookAtAll(camera, corners, from, up, room = 1.08) {
  const toEye = from.clone().normalize(), right = up.clone().cross(toEye).normalize(), above = toEye.clone().cross(right);
  const low = new THREE.Vector3(Infinity, Infinity, Infinity), high = low.clone().negate();
  for (const c of corners) {
    const v = new THREE.Vector3(c.dot(right), c.dot(above), c.dot(toEye));
    low.min(v);
    high.max(v);
  }
  const middle = low.clone().add(high).multiplyScalar(0.5);
  const target = right.clone().multiplyScalar(middle.x).addScaledVector(above, middle.y).addScaledVector(toEye, middle.z);
  const tall = Math.tan(0.5 * camera.fov * Math.PI / 180) / room, wide = tall * camera.aspect;
  let distance = 1e-6;
  for (const c of corners) {
    const x = Math.abs(c.dot(right) - middle.x), y = Math.abs(c.dot(above) - middle.y), near = c.dot(toEye) - middle.z;
    distance = Math.max(distance, near + y / tall, near + x / wide);
  }
  camera.up.copy(up);
  camera.position.copy(target).addScaledVector(toEye, distance);
  const size = Math.max(high.distanceTo(low), 1e-9);
  camera.near = Math.max(1e-3 * size, 0.02 * distance);
  camera.far = 20 * (distance + size);
  camera.lookAt(target);
  camera.updateProjectionMatrix();
  return {target, distance, size};
}

/** Lines of a grid on the plane normal·x = height, over the corners and a margin. */
export function gridOf(corners, normal, height, spacing, margin) {
  const seed = Math.abs(normal.x) > 0.9 ? new THREE.Vector3(0, 1, 0) : new THREE.Vector3(1, 0, 0);
  const b = normal.clone().cross(seed).normalize(), a = b.clone().cross(normal);
  const span = (axis) => {
    let low = Infinity, high = -Infinity;
    for (const c of corners) low = Math.min(low, c.dot(axis)), high = Math.max(high, c.dot(axis));
    return [Math.floor((low - margin) / spacing), Math.ceil((high + margin) / spacing)];
  };
  const [a0, a1] = span(a), [b0, b1] = span(b), points = [];
  const at = (u, v) => a.clone().multiplyScalar(u * spacing).addScaledVector(b, v * spacing).addScaledVector(normal, height);
  for (let u = a0; u <= a1; ++u) points.push(at(u, b0), at(u, b1));
  for (let v = b0; v <= b1; ++v) points.push(at(a0, v), at(a1, v));
  const sheet = new THREE.BufferGeometry().setFromPoints([at(a0, b0), at(a1, b0), at(a1, b1), at(a0, b1)]);
  sheet.setIndex([0, 1, 2, 0, 2, 3]);
  return {lines: new THREE.BufferGeometry().setFromPoints(points), sheet};
}

// Forces and other vectors of a scene as arrows.
import * as THREE from 'three';

const z = new THREE.Vector3(0, 0, 1);

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
  constructor(set, colour, width, root) {
    this.set = set;
    let most = 1;
    for (let i = 0; i + 1 < set.firsts.length; ++i) most = Math.max(most, set.firsts[i + 1] - set.firsts[i]);
    // over all else, for most begin inside of bodies
    const material = new THREE.MeshPhongMaterial({color: colour, specular: '#111111', depthTest: false, transparent: true});
    const shaft = new THREE.CylinderGeometry(0.5 * width, 0.5 * width, 1, 10).rotateX(Math.PI / 2).translate(0, 0, 0.5);
    const head = new THREE.ConeGeometry(1.4 * width, 4 * width, 14).rotateX(Math.PI / 2).translate(0, 0, -2 * width);
    this.headLength = 4 * width;
    this.shafts = new THREE.InstancedMesh(shaft, material, most);
    this.heads = new THREE.InstancedMesh(head, material, most);
    for (const mesh of [this.shafts, this.heads]) {
      mesh.frustumCulled = false;
      mesh.renderOrder = 1;
      mesh.instanceMatrix.setUsage(THREE.DynamicDrawUsage);
      root.add(mesh);
    }
  }

  set visible(on) {
    this.shafts.visible = this.heads.visible = on;
  }

  /** \param scale metres for each unit of the vectors */
  setFrame(frame, scale) {
    const {firsts, places, vectors, step} = this.set, first = firsts[frame], count = firsts[frame + 1] - first;
    const matrix = new THREE.Matrix4(), place = new THREE.Vector3(), vector = new THREE.Vector3();
    const turn = new THREE.Quaternion(), size = new THREE.Vector3();
    for (let i = 0; i < count; ++i) {
      place.fromArray(places, 3 * (first + i));
      vector.fromArray(vectors, 3 * (first + i)).multiplyScalar(step * scale);
      const length = vector.length(), unit = length > 0 ? vector.clone().divideScalar(length) : z;
      turn.setFromUnitVectors(z, unit);
      const head = Math.min(1, length / this.headLength); // short arrows have small heads
      const shaft = Math.max(1e-9, length - 0.9 * head * this.headLength);
      this.shafts.setMatrixAt(i, matrix.compose(place, turn, size.set(head, head, shaft)));
      this.heads.setMatrixAt(i, matrix.compose(place.addScaledVector(unit, length), turn, size.setScalar(Math.max(head, 1e-9))));
    }
    for (const mesh of [this.shafts, this.heads]) {
      mesh.count = count;
      mesh.instanceMatrix.needsUpdate = true;
    }
  }
}

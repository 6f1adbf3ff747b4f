// Polygons as triangles with normals: smooth where faces meet at a blunt angle, sharp at edges.

import {ShapeUtils, Vector2} from 'three';

const creaseCosine = Math.cos(40 * Math.PI / 180);

/** What a shape is drawn by. A vertex is a point with one normal: corners of polygons that meet smoothly share it.
 *  pointOf: vertex -> point; triangles: vertices; the normal of vertex v averages those of the polygons
 *  shared[sharedFirst[v]] to shared[sharedFirst[v + 1] - 1]. */
export function meshOf(shape) {
  const {points, corners, ends} = shape, around = Array.from({length: points.length / 3}, () => []);
  for (let k = 0, begin = 0; k < ends.length; begin = ends[k++])
    for (let c = begin; c < ends[k]; ++c) around[corners[c]].push(k);
  const mesh = {corners, ends}, normals = polygonNormals(mesh, points, new Float32Array(3 * ends.length));
  const size = (k) => Math.hypot(normals[3 * k], normals[3 * k + 1], normals[3 * k + 2]) || 1;
  const vertexOf = new Uint32Array(corners.length), pointOf = [], shared = [], sharedFirst = [0], known = new Map();
  for (let k = 0, begin = 0; k < ends.length; begin = ends[k++])
    for (let c = begin; c < ends[k]; ++c) {
      const smooth = around[corners[c]].filter((other) => {
        const dot = normals[3 * k] * normals[3 * other] + normals[3 * k + 1] * normals[3 * other + 1] + normals[3 * k + 2] * normals[3 * other + 2];
        return other === k || dot > creaseCosine * size(k) * size(other);
      });
      const key = `${corners[c]}:${smooth}`;
      if (!known.has(key)) {
        known.set(key, pointOf.length);
        pointOf.push(corners[c]);
        shared.push(...smooth);
        sharedFirst.push(shared.length);
      }
      vertexOf[c] = known.get(key);
    }
  const triangles = trianglesOf(mesh, points, normals).map((c) => vertexOf[c]);
  return Object.assign(mesh, {
    pointOf: Uint32Array.from(pointOf),
    triangles: Uint32Array.from(triangles),
    shared: Uint32Array.from(shared),
    sharedFirst: Uint32Array.from(sharedFirst),
  });
}

/** Triangles of all polygons as corners, of those that are not convex, too, facing as their polygon does. */
function trianglesOf(mesh, points, normals) {
  const out = [];
  for (let k = 0, begin = 0; k < mesh.ends.length; begin = mesh.ends[k++]) {
    if (mesh.ends[k] - begin <= 4) {
      for (let v = begin + 2; v < mesh.ends[k]; ++v) out.push(begin, v - 1, v);
      continue;
    }
    // seen along the axis that is nearest to the normal
    const size = [0, 1, 2].map((c) => Math.abs(normals[3 * k + c])), along = size.indexOf(Math.max(...size));
    const [a, b] = [(along + 1) % 3, (along + 2) % 3], facing = Math.sign(normals[3 * k + along]) || 1, outline = [];
    for (let v = begin; v < mesh.ends[k]; ++v)
      outline.push(new Vector2(points[3 * mesh.corners[v] + a], points[3 * mesh.corners[v] + b]));
    for (const [i, j, l] of ShapeUtils.triangulateShape(outline, [])) {
      const [p, q, r] = [outline[i], outline[j], outline[l]];
      const turns = (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
      out.push(begin + i, begin + (turns * facing >= 0 ? j : l), begin + (turns * facing >= 0 ? l : j));
    }
  }
  return out;
}

/** Twice the area of each polygon times its normal, by its corners [Newell]. */
export function polygonNormals(mesh, points, out) {
  let begin = 0;
  for (let k = 0; k < mesh.ends.length; ++k) {
    const end = mesh.ends[k];
    let x = 0, y = 0, z = 0, p = 3 * mesh.corners[end - 1];
    for (let v = begin; v < end; ++v) {
      const q = 3 * mesh.corners[v];
      x += (points[p + 1] - points[q + 1]) * (points[p + 2] + points[q + 2] - 2 * points[3 * mesh.corners[begin] + 2]);
      y += (points[p + 2] - points[q + 2]) * (points[p] + points[q] - 2 * points[3 * mesh.corners[begin]]);
      z += (points[p] - points[q]) * (points[p + 1] + points[q + 1] - 2 * points[3 * mesh.corners[begin] + 1]);
      p = q;
    }
    out[3 * k] = x, out[3 * k + 1] = y, out[3 * k + 2] = z;
    begin = end;
  }
  return out;
}

/** Writes places and normals of the vertices from vertex `first` on. */
export function writeVertices(mesh, points, normals, positions, out, first) {
  polygonNormals(mesh, points, normals);
  for (let v = 0; v < mesh.pointOf.length; ++v) {
    const p = 3 * mesh.pointOf[v], at = 3 * (first + v);
    let x = 0, y = 0, z = 0;
    for (let s = mesh.sharedFirst[v]; s < mesh.sharedFirst[v + 1]; ++s) {
      const k = 3 * mesh.shared[s];
      x += normals[k], y += normals[k + 1], z += normals[k + 2];
    }
    const size = Math.hypot(x, y, z) || 1;
    positions[at] = points[p], positions[at + 1] = points[p + 1], positions[at + 2] = points[p + 2];
    out[at] = x / size, out[at + 1] = y / size, out[at + 2] = z / size;
  }
}

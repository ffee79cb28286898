// SPDX-License-Identifier: BSD-3-Clause
// Springs: coils whose wire stays round at any length. Parts that are stretched along z alone would make ribbons of it.
"use strict";
// Gives the mesh `o` of a spring, scaled by radius, radius and length, a surface that follows its scale by what is
// returned. `most`: its largest length beside its radius; a long one has more turns.
const se3dCoil = (o, most) => {
  const turns = Math.min(40, Math.max(8, Math.round(most / 1.2))), steps = 16, sides = 8, rings = turns * steps + 1;
  const points = new Float32Array(3 * rings * sides), normals = new Float32Array(points.length), corners = [];
  for (let i = 0; i + 1 < rings; ++i) for (let k = 0; k < sides; ++k) {
    const a = i * sides + k, b = i * sides + (k + 1) % sides;
    corners.push(a, b, b + sides, a, b + sides, a + sides);
  }
  const shape = new THREE.BufferGeometry();
  shape.setAttribute("position", new THREE.BufferAttribute(points, 3));
  shape.setAttribute("normal", new THREE.BufferAttribute(normals, 3));
  shape.setIndex(corners);
  o.geometry = shape;
  let last = 0;
  const at = new THREE.Vector3(), along = new THREE.Vector3(), out = new THREE.Vector3(), beside = new THREE.Vector3(), n = new THREE.Vector3();
  const bend = () => {
    const long = o.scale.z / o.scale.x; // in radii
    if (long === last || !Number.isFinite(long)) return;
    last = long;
    const pitch = Math.abs(long) / turns, wire = Math.min(0.12, 0.45 * pitch), flat = long || 1e-9;
    for (let i = 0; i < rings; ++i) {
      // The ends come out of the middle within a turn.
      const turn = i / steps, angle = 2 * Math.PI * turn, end = Math.min(1, turn, turns - turn), side = turn < 1 ? 1 : -1;
      const radius = end * end * (3 - 2 * end), widen = end < 1 ? 6 * side * end * (1 - end) / (2 * Math.PI) : 0;
      const c = Math.cos(angle), s = Math.sin(angle);
      at.set(radius * c, radius * s, long * (turn / turns - 0.5));
      along.set(widen * c - radius * s, widen * s + radius * c, long / turns / (2 * Math.PI)).normalize();
      out.set(c, s, 0).addScaledVector(along, -(along.x * c + along.y * s)).normalize();
      beside.crossVectors(along, out);
      for (let k = 0; k < sides; ++k) {
        const a = 2 * Math.PI * k / sides, v = 3 * (i * sides + k);
        n.copy(out).multiplyScalar(Math.cos(a)).addScaledVector(beside, Math.sin(a));
        points[v] = at.x + wire * n.x; points[v + 1] = at.y + wire * n.y; points[v + 2] = (at.z + wire * n.z) / flat;
        normals[v] = n.x; normals[v + 1] = n.y; normals[v + 2] = n.z * flat; // a scale divides them
      }
    }
    shape.attributes.position.needsUpdate = shape.attributes.normal.needsUpdate = true;
  };  bend();
  shape.computeBoundingBox();
  shape.computeBoundingSphere();
  shape.boundingSphere.radius *= 1.2; // whatever its length will be
  return bend;
};

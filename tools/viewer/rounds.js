// SPDX-License-Identifier: BSD-3-Clause
// Spheres and cylinders with every second corner, for pictures that have to be quick: without a GPU what a picture costs
// are its triangles.
"use strict";
// `nodes`: all of them; `userData.unit` says which are spheres and cylinders as libse3d-io writes them: points ring by
// ring, in each the first one again at its end; those of a cylinder's ends come after its two rings. `show` lets all
// have few corners or many.
const se3dRounds = (nodes) => {
  const coarse = new Map();
  const make = ({ geometry }, unit) => {
    const { position, normal } = geometry.attributes, points = position.count, quads = geometry.index.count / 6, corners = [];
    // A sphere has (rings + 1) (around + 1) points and rings * around quads, more around than rings.
    const sum = points - quads - 1, rings = unit === "sphere" ? (sum - Math.sqrt(sum * sum - 4 * quads)) / 2 : 1;
    const around = unit === "sphere" ? quads / rings : (points - 2) / 4, up = Math.min(2, rings), row = around + 1;
    for (let i = 0; i < rings; i += up) for (let k = 0; k < around; k += 2) {
      const a = i * row + k, b = a + up * row;
      corners.push(a, a + 2, b + 2, a, b + 2, b);
    }
    for (let end = 0; unit === "cylinder" && end < 2; ++end) for (let k = 2, first = 2 * row + end * around; k + 2 < around; k += 2) {
      corners.push(first, first + k + (end ? 0 : 2), first + k + (end ? 2 : 0));
    }
    const few = new THREE.BufferGeometry();
    few.setAttribute("position", position);
    few.setAttribute("normal", normal);
    few.setIndex(corners);
    geometry.computeBoundingBox();
    geometry.computeBoundingSphere();
    return Object.assign(few, { boundingBox: geometry.boundingBox, boundingSphere: geometry.boundingSphere });
  };
  const all = nodes.filter((o) => o.isMesh && ["sphere", "cylinder"].includes(o.userData.unit)).map((o) => {
    if (!coarse.has(o.geometry)) coarse.set(o.geometry, make(o, o.userData.unit));
    return { o, many: o.geometry, few: coarse.get(o.geometry) };
  });
  let are = false;
  return {
    show: (few) => { if (few !== are) all.forEach((r) => { r.o.geometry = few ? r.few : r.many; }); are = few; },
    close: () => all.forEach(({ many, few }) => { many.dispose(); few.dispose(); }),
  };
};

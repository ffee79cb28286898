// SPDX-License-Identifier: BSD-3-Clause
// Grains: one quad each, drawn as a sphere that faces the camera.
"use strict";
// Between which two of `count` times list(k) t is, and how far from the first to the second, 0 to 1.
const se3dLocate = (list, count, t) => {
  let low = 0, high = count - 1;
  while (high - low > 1) { const mid = (low + high) >> 1; if (list(mid) <= t) low = mid; else high = mid; }
  const width = list(high) - list(low);
  return [low, high, width > 0 ? Math.min(1, Math.max(0, (t - list(low)) / width)) : 0];
};
// What is `packed` in the page; live there is only what `feed` gets. `around` gives the floor and what is solid; `cut`
// of what is returned is a plane behind which no grain is shown, or null.
const se3dGrains = (packed, { isLive, scene, root, renderer, camera, around }) => {
  const self = { cut: null }, times = packed.times || [], va = new THREE.Vector3();
  let count = packed.count || 0, place, paints, places, paint;
  const { low = [0, 0, 0], high = [0, 0, 0] } = packed, radii = new Float32Array(se3dDecode(packed.radii || ""));
  const frames = (packed.frames || []).map((text) => new Uint16Array(se3dDecode(text))), forces = (packed.forces || []).map((text) => new Uint16Array(se3dDecode(text)));
  const set = new Uint8Array(se3dDecode(packed.set || ""));
  // With room for so many.
  const make = (most) => {
    const shape = new THREE.InstancedBufferGeometry();
    place = new Float32Array(4 * most); paints = new Float32Array(3 * most).map((v, k) => [0.93, 0.72, 0.42][k % 3]);
    places = new THREE.InstancedBufferAttribute(place, 4); paint = new THREE.InstancedBufferAttribute(paints, 3);
    shape.setAttribute("position", new THREE.BufferAttribute(new Float32Array([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]), 3));
    shape.setIndex([0, 1, 2, 0, 2, 3]);
    shape.setAttribute("place", places);
    shape.setAttribute("shade", new THREE.InstancedBufferAttribute(new Float32Array(most).map((v, k) => 0.8 + 0.2 * ((k * 0.618034) % 1)), 1));
    shape.setAttribute("paint", paint);
    shape.instanceCount = count;
    return shape;
  };
  const flat = { value: 0 }; // 1: the colours as they are, to count what is seen
  const cloud = new THREE.Mesh(make(isLive ? 1000 : count), new THREE.ShaderMaterial({
    uniforms: { flat_: flat },
    vertexShader: `attribute vec4 place; attribute float shade; attribute vec3 paint; varying vec2 corner; varying float tone; varying vec3 tint;
      void main() {
        corner = position.xy; tone = shade; tint = paint;
        vec4 at = modelViewMatrix * vec4(place.xyz, 1.0);
        at.xy += place.w * corner;
        gl_Position = projectionMatrix * at;
      }`,
    fragmentShader: `varying vec2 corner; varying float tone; varying vec3 tint; uniform float flat_;
      void main() {
        float d = dot(corner, corner);
        if (d > 1.0) discard;
        float light = 0.4 + 0.6 * max(0.0, dot(vec3(corner, sqrt(1.0 - d)), vec3(0.42, 0.52, 0.74)));
        gl_FragColor = vec4(flat_ > 0.5 ? tint : light * tone * tint, 1.0);
      }`,
  }));
  cloud.frustumCulled = false;
  scene.add(cloud);
  const scale = [0, 1, 2].map((i) => (high[i] - low[i]) / 65534);
  // A grain that is missing has the radius 0; one that goes stays where it was until then.
  const move = (t) => {
    const [a, b, part] = se3dLocate((k) => times[k], times.length, t);
    const from = frames[part < 1 ? a : b], to = frames[part > 0 ? b : a];
    for (let k = 0; k < count; ++k) {
      place[4 * k + 3] = from[3 * k] === 65535 ? 0 : radii[k];
      const way = to[3 * k] === 65535 ? 0 : part;
      if (self.cut && place[4 * k + 3] > 0 && self.cut.distanceToPoint(va.set(...[0, 1, 2].map((i) => low[i] + scale[i] * from[3 * k + i]))) < 0) place[4 * k + 3] = 0;
      for (let i = 0; i < 3; ++i) place[4 * k + i] = low[i] + scale[i] * (from[3 * k + i] + way * (to[3 * k + i] - from[3 * k + i]));
    }
    places.needsUpdate = true;
  };
  const speed = (k, a, b) => (a === b || frames[a][3 * k] === 65535 || frames[b][3 * k] === 65535 ? 0
    : Math.hypot(...[0, 1, 2].map((i) => scale[i] * (frames[b][3 * k + i] - frames[a][3 * k + i]))) / (times[b] - times[a]));
  let shownAt = [0, 0];
  const sizes = () => [radii.reduce((a, b) => Math.min(a, b)), radii.reduce((a, b) => Math.max(a, b))];
  // Live: centres and radii as they come.
  self.feed = (data) => {
    count = data.length / 4;
    if (data.length > place.length) { cloud.geometry.dispose(); cloud.geometry = make(2 * count); }
    place.set(data);
    if (self.cut) for (let k = 0; k < count; ++k) if (self.cut.distanceToPoint(va.fromArray(place, 4 * k)) < 0) place[4 * k + 3] = 0;
    cloud.geometry.instanceCount = count;
    places.needsUpdate = true;
  };
  self.move = isLive ? () => {} : (t) => { const [a, b] = se3dLocate((k) => times[k], times.length, t); shownAt = [a, b]; move(t); };
  self.list = () => ({ place, count });
  const force = (k, a) => forces[a][k] / 65535 * packed.most;
  self.fastest = () => { let most = 0; for (let k = 0; k < count; ++k) most = Math.max(most, speed(k, ...shownAt)); return most; };
  self.paint = (what, span) => {
    for (let k = 0; k < count; ++k) {
      const part = what === "size" ? (radii[k] - span[0]) / (span[1] - span[0] || 1) : what === "force" ? (forces.length ? force(k, shownAt[0]) / (span[1] || 1) : 0)
        : what === "speed" ? speed(k, ...shownAt) / (span[1] || 1) : 0;
      const c = what === "set" ? se3dPalette(set[k]) : what ? se3dRamp(part).map((v) => v / 255) : [0.93, 0.72, 0.42];
      for (let i = 0; i < 3; ++i) paints[3 * k + i] = c[i];
    }
    paint.needsUpdate = true;
  };
  self.seen = () => {
    const kept = Float32Array.from(paints), found = new Map(), w = renderer.domElement.width, h = renderer.domElement.height, gl = renderer.getContext();
    const back = scene.background, all = new Uint8Array(4 * w * h);
    const { floor, solids } = around();
    // Numbers as colours; what is seen through is no colour of its own, so that it is left out here.
    const through = []; root.traverse((o) => { if (o.visible && o.material && o.material.transparent) { through.push(o); o.visible = false; } });
    floor.visible = false;
    for (let k = 0; k < count; ++k) { const id = k + 1; paints.set([id & 255, id >> 8 & 255, id >> 16 & 255].map((v) => v / 255), 3 * k); }
    paint.needsUpdate = true; flat.value = 1; scene.background = new THREE.Color(0);
    solids.forEach((o) => { o.userData.lit = o.material; if (o.visible) o.material = new THREE.MeshBasicMaterial({ color: 0 }); });
    renderer.render(scene, camera);
    gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, all);
    for (let k = 0; k < all.length; k += 4) { const id = all[k] + 256 * all[k + 1] + 65536 * all[k + 2]; if (id > 0 && id <= count) found.set(id, (found.get(id) || 0) + 1); }
    solids.forEach((o) => { o.material = o.userData.lit; });
    through.forEach((o) => { o.visible = true; });
    paints.set(kept); paint.needsUpdate = true; flat.value = 0; scene.background = back; floor.visible = true;
    let there = 0;
    for (let k = 0; k < count; ++k) there += place[4 * k + 3] > 0;
    return { there, seen: [...found.values()].filter((points) => points > 1).length }; // a single point may be the edge of two
  };
  return Object.assign(self, { sizes });
};

// SPDX-License-Identifier: BSD-3-Clause
// The viewer: reads the embedded glTF (as libse3d-io writes it) and results; z is upwards inside.
"use strict";
addEventListener("error", (e) => { window.se3dProblem = String(e.message).replace(/["\\]/g, "'"); });
(() => {
  const $ = (id) => document.getElementById(id);
  const decode = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
  const glb = decode($("glb").textContent.trim());
  const results = JSON.parse($("results").textContent);
  results.values = new Float32Array(decode(results.data));
  const head = new DataView(glb);
  const jsonLength = head.getUint32(12, true);
  const gltf = JSON.parse(new TextDecoder().decode(new Uint8Array(glb, 20, jsonLength)));
  const binary = 28 + jsonLength;

  const accessor = (k) => {
    const a = gltf.accessors[k];
    const width = { SCALAR: 1, VEC3: 3, VEC4: 4 }[a.type];
    const type = { 5126: Float32Array, 5122: Int16Array, 5123: Uint16Array }[a.componentType];
    const raw = new type(glb.slice(binary + gltf.bufferViews[a.bufferView].byteOffset).slice(0, a.count * width * type.BYTES_PER_ELEMENT));
    return { width, values: a.normalized ? Float32Array.from(raw, (v) => v / 32767) : raw };
  };
  const geometries = new Map();
  const geometry = (primitive) => {
    const key = primitive.attributes.POSITION;
    if (!geometries.has(key)) {
      const made = new THREE.BufferGeometry();
      made.setAttribute("position", new THREE.BufferAttribute(accessor(key).values, 3));
      if (primitive.attributes.NORMAL !== undefined) {
        made.setAttribute("normal", new THREE.BufferAttribute(accessor(primitive.attributes.NORMAL).values, 3));
        if (primitive.indices !== undefined) made.setIndex(new THREE.BufferAttribute(accessor(primitive.indices).values, 1));
      }
      geometries.set(key, made);
    }
    return geometries.get(key);
  };
  const drawn = (mesh) => {
    const p = mesh.primitives[0];
    const c = gltf.materials[p.material].pbrMetallicRoughness.baseColorFactor;
    const look = { color: new THREE.Color(c[0], c[1], c[2]), transparent: c[3] < 1, opacity: c[3] };
    if (p.mode === 1) return new THREE.LineSegments(geometry(p), new THREE.LineBasicMaterial(look));
    if (p.mode === 3) return new THREE.Line(geometry(p), new THREE.LineBasicMaterial(look));
    return new THREE.Mesh(geometry(p), new THREE.MeshStandardMaterial({ ...look, metalness: 0.1, roughness: 0.6, side: 2 }));
  };
  const nodes = gltf.nodes.map((n) => {
    const o = n.mesh === undefined ? new THREE.Group() : drawn(gltf.meshes[n.mesh]);
    o.name = n.name;
    if (n.translation) o.position.fromArray(n.translation);
    if (n.rotation) o.quaternion.fromArray(n.rotation);
    if (n.scale) o.scale.fromArray(n.scale);
    return o;
  });
  gltf.nodes.forEach((n, k) => (n.children || []).forEach((c) => nodes[k].add(nodes[c])));
  document.title = $("title").textContent = gltf.scenes[0].name || "se3d";
  const root = nodes[gltf.scenes[0].nodes[0]];
  root.quaternion.set(0, 0, 0, 1); // our z is this camera's up
  const bodies = gltf.nodes.map((n, k) => (n.extras && n.extras.body !== undefined ? nodes[k] : null)).filter(Boolean);
  const grid = root.children.find((o) => o.name === "grid");

  // Motion: samples at the times of accessor 0, linear in between.
  const motion = (gltf.animations || [{ channels: [], samplers: [] }])[0];
  const times = motion.samplers.length ? accessor(motion.samplers[0].input).values : new Float32Array([0]);
  const tracks = motion.channels.map((c) => ({
    node: nodes[c.target.node], path: c.target.path, values: accessor(motion.samplers[c.sampler].output).values,
  }));
  const packed = JSON.parse($("grains").textContent);
  const grainTimes = packed ? packed.times : [];
  const start = Math.min(times[0], ...grainTimes.slice(0, 1)), end = Math.max(times[times.length - 1], ...grainTimes.slice(-1));
  const qa = new THREE.Quaternion(), qb = new THREE.Quaternion(), va = new THREE.Vector3(), vb = new THREE.Vector3();
  // A long motion was thinned out to more than half of the most samples: then a curve through its points.
  const curved = times.length > 625;
  const tangent = (values, k, i) => {
    const a = Math.max(0, k - 1), b = Math.min(times.length - 1, k + 1);
    return (values[3 * b + i] - values[3 * a + i]) / (times[b] - times[a]);
  };
  const curve = (values, a, b, part, out) => {
    const h = times[b] - times[a], p = part * part * (3 - 2 * part);
    for (let i = 0; i < 3; ++i) {
      const from = values[3 * a + i], to = values[3 * b + i];
      out[i] = from + p * (to - from) + h * part * (1 - part) * ((1 - part) * tangent(values, a, i) - part * tangent(values, b, i));
    }
    return out;
  };
  const locate = (list, count, t) => {
    let low = 0, high = count - 1;
    while (high - low > 1) { const mid = (low + high) >> 1; if (list(mid) <= t) low = mid; else high = mid; }
    const width = list(high) - list(low);
    return [low, high, width > 0 ? Math.min(1, Math.max(0, (t - list(low)) / width)) : 0];
  };
  const pose = (t) => {
    const [a, b, part] = locate((k) => times[k], times.length, t);
    for (const { node, path, values } of tracks) {
      if (path === "rotation") {
        node.quaternion.copy(qa.fromArray(values, 4 * a).normalize()).slerp(qb.fromArray(values, 4 * b).normalize(), part);
      } else {
        const target = node[path === "scale" ? "scale" : "position"];
        if (curved && a < b) target.fromArray(curve(values, a, b, part, []));
        else target.copy(va.fromArray(values, 3 * a)).lerp(vb.fromArray(values, 3 * b), part);
      }
    }
  };

  // Results beside the motion.
  const n = results.names.length, rows = n > 0 ? results.values.length / n : 0;
  const at = (row, column) => results.values[row * n + column];
  const value = (column, t) => {
    const [a, b, part] = locate((k) => at(k, 0), rows, t);
    return at(a, column) + part * (at(b, column) - at(a, column));
  };

  const scene = new THREE.Scene();
  const old = parseInt(THREE.REVISION, 10) < 155, unit = old ? 1 / Math.PI : 1; // Debian's: other units of light, no gamma
  scene.add(root, new THREE.HemisphereLight(0xffffff, 0x777788, 1.6 * unit));
  const sun = new THREE.DirectionalLight(0xffffff, 2.2 * unit);
  sun.position.set(3, -5, 8);
  scene.add(sun);
  const camera = new THREE.PerspectiveCamera(40, 1, 0.001, 1000);
  camera.up.set(0, 0, 1);
  const renderer = new THREE.WebGLRenderer({ canvas: $("view"), antialias: true, preserveDrawingBuffer: true });
  if (old) renderer.gammaOutput = true;
  renderer.setPixelRatio(Math.min(2, devicePixelRatio || 1));

  // Grains: one quad each, drawn as a sphere that faces the camera.
  let grains = null;
  if (packed) {
    const { count, low, high } = packed;
    const place = new Float32Array(4 * count), shade = new Float32Array(count), radii = new Float32Array(decode(packed.radii));
    const frames = packed.frames.map((text) => new Uint16Array(decode(text)));
    const shape = new THREE.InstancedBufferGeometry();
    shape.setAttribute("position", new THREE.BufferAttribute(new Float32Array([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]), 3));
    shape.setIndex([0, 1, 2, 0, 2, 3]);
    for (let k = 0; k < count; ++k) shade[k] = 0.8 + 0.2 * ((k * 0.618034) % 1);
    const places = new THREE.InstancedBufferAttribute(place, 4);
    shape.setAttribute("place", places);
    shape.setAttribute("shade", new THREE.InstancedBufferAttribute(shade, 1));
    shape.instanceCount = shape.maxInstancedCount = count;
    const cloud = new THREE.Mesh(shape, new THREE.ShaderMaterial({
      vertexShader: `attribute vec4 place; attribute float shade; varying vec2 corner; varying float tone;
        void main() {
          corner = position.xy; tone = shade;
          vec4 at = modelViewMatrix * vec4(place.xyz, 1.0);
          at.xy += place.w * corner;
          gl_Position = projectionMatrix * at;
        }`,
      fragmentShader: `varying vec2 corner; varying float tone;
        void main() {
          float d = dot(corner, corner);
          if (d > 1.0) discard;
          float light = 0.4 + 0.6 * max(0.0, dot(vec3(corner, sqrt(1.0 - d)), vec3(0.42, 0.52, 0.74)));
          gl_FragColor = vec4(light * tone * vec3(0.93, 0.72, 0.42), 1.0);
        }`,
    }));
    cloud.frustumCulled = false;
    scene.add(cloud);
    const scale = [0, 1, 2].map((i) => (high[i] - low[i]) / 65534);
    // A grain that is missing has the radius 0; one that goes stays where it was until then.
    const move = (t) => {
      const [a, b, part] = locate((k) => grainTimes[k], grainTimes.length, t);
      const from = frames[part < 1 ? a : b], to = frames[part > 0 ? b : a];
      for (let k = 0; k < count; ++k) {
        place[4 * k + 3] = from[3 * k] === 65535 ? 0 : radii[k];
        const way = to[3 * k] === 65535 ? 0 : part;
        for (let i = 0; i < 3; ++i) place[4 * k + i] = low[i] + scale[i] * (from[3 * k + i] + way * (to[3 * k + i] - from[3 * k + i]));
      }
      places.needsUpdate = true;
    };
    grains = { move, place, count };
  }

  // What the camera looks at: the box around the bodies at a few times.
  const low = new THREE.Vector3(1, 1, 1).multiplyScalar(1e9), high = low.clone().negate();
  for (let k = 0; k < 24; ++k) {
    pose(start + (end - start) * k / 23);
    root.updateMatrixWorld(true);
    root.traverse((o) => {
      if (!o.isMesh || o.material.opacity < 1) return;
      if (!o.geometry.boundingBox) o.geometry.computeBoundingBox();
      const { min, max } = o.geometry.boundingBox;
      for (let k = 0; k < 8; ++k) {
        va.set(k & 1 ? min.x : max.x, k & 2 ? min.y : max.y, k & 4 ? min.z : max.z).applyMatrix4(o.matrixWorld);
        low.min(va); high.max(va);
      }
    });
  }
  if (packed) { low.min(va.fromArray(packed.low)); high.max(va.fromArray(packed.high)); }
  if (!(high.x >= low.x)) { low.set(-1, -1, -1); high.set(1, 1, 1); }
  const center = low.clone().add(high).multiplyScalar(0.5);
  const size = Math.max(1e-6, high.distanceTo(low));
  const orbit = { azimuth: -0.9, height: 0.35, distance: 1.35 * size, target: center.clone() };
  camera.near = size / 500; camera.far = size * 50;

  const state = { time: start, playing: true, speed: 1, follow: -1, frames: false, reactions: false, traces: false, dark: false };
  const axes = bodies.map((b) => { const a = new THREE.AxesHelper(0.15 * size); a.visible = false; b.add(a); return a; });
  // Reactions: arrows at the nodes named as joints.
  const arrows = [];
  results.names.forEach((name, k) => {
    const joint = name.endsWith(".force.x") && nodes.find((o) => o.name === name.slice(0, -8) && o.parent);
    if (!joint) return;
    let largest = 1e-12;
    for (let r = 0; r < rows; ++r) largest = Math.max(largest, Math.hypot(at(r, k), at(r, k + 1), at(r, k + 2)));
    const arrow = new THREE.ArrowHelper(new THREE.Vector3(0, 0, 1), center, 1, 0xd1495b);
    arrow.visible = false; scene.add(arrow);
    arrows.push({ arrow, joint, column: k, largest });
  });
  const largest = Math.max(1e-12, ...arrows.map((a) => a.largest));
  // Traces of bodies' origins and of markers.
  const traced = bodies.slice(1).flatMap((b) => [b, ...b.children.filter((o) => o.isGroup)]);
  const traces = [];
  const makeTraces = () => {
    const count = Math.min(600, times.length), points = traced.map(() => new Float32Array(3 * count));
    for (let k = 0; k < count; ++k) {
      pose(times[Math.round(k * (times.length - 1) / Math.max(1, count - 1))]);
      root.updateMatrixWorld(true);
      traced.forEach((o, i) => va.setFromMatrixPosition(o.matrixWorld).toArray(points[i], 3 * k));
    }
    points.forEach((p) => {
      const g = new THREE.BufferGeometry();
      g.setAttribute("position", new THREE.BufferAttribute(p, 3));
      const line = new THREE.Line(g, new THREE.LineBasicMaterial({ color: 0xe08e0b, depthTest: false, transparent: true }));
      line.renderOrder = 1; // seen through the bodies
      scene.add(line); traces.push(line);
    });
  };

  let film = null; // width and height of the pictures of a film
  const draw = () => {
    const [width, height] = film || [innerWidth, innerHeight];
    if (renderer.domElement.width !== Math.round(width * renderer.getPixelRatio()) || camera.aspect !== width / height) {
      renderer.setSize(width, height, false); camera.aspect = width / height; camera.updateProjectionMatrix();
    }
    pose(state.time);
    if (grains) grains.move(state.time);
    if (state.follow > 0) orbit.target.copy(bodies[state.follow].position);
    root.updateMatrixWorld(true);
    const c = Math.cos(orbit.height);
    camera.position.set(Math.cos(orbit.azimuth) * c, Math.sin(orbit.azimuth) * c, Math.sin(orbit.height))
      .multiplyScalar(orbit.distance).add(orbit.target);
    camera.lookAt(orbit.target);
    for (const { arrow, joint, column } of arrows) {
      va.set(value(column, state.time), value(column + 1, state.time), value(column + 2, state.time));
      const length = va.length();
      arrow.visible = state.reactions && length > 1e-6 * largest;
      if (arrow.visible) {
        arrow.position.setFromMatrixPosition(joint.matrixWorld);
        arrow.setDirection(va.normalize());
        arrow.setLength(Math.max(0.02, 0.4 * length / largest) * size, 0.05 * size, 0.025 * size);
      }
    }
    renderer.render(scene, camera);
    $("time").value = state.time;
    $("clock").textContent = state.time.toFixed(3) + " s";
    plot();
  };

  const canvas = $("plot"), pen = canvas.getContext("2d");
  const plot = () => {
    if (n < 2) return;
    const scale = devicePixelRatio || 1, w = 380, h = 190, left = 62, right = 10, top = 24, bottom = 24;
    if (canvas.width !== w * scale) { canvas.width = w * scale; canvas.height = h * scale; }
    pen.setTransform(scale, 0, 0, scale, 0, 0);
    pen.clearRect(0, 0, w, h);
    const style = getComputedStyle(document.body), k = Number($("channel").value) || Math.min(1, n - 1);
    let bottomValue = Infinity, topValue = -Infinity;
    for (let r = 0; r < rows; ++r) { bottomValue = Math.min(bottomValue, at(r, k)); topValue = Math.max(topValue, at(r, k)); }
    if (!(topValue - bottomValue > 1e-9 * Math.abs(topValue)) || topValue - bottomValue < 1e-12) { bottomValue -= 1; topValue += 1; }
    const x = (t) => left + (w - left - right) * (t - at(0, 0)) / Math.max(1e-12, at(rows - 1, 0) - at(0, 0));
    const y = (v) => h - bottom - (h - top - bottom) * (v - bottomValue) / (topValue - bottomValue);
    pen.fillStyle = style.color; pen.font = "11px sans-serif"; pen.textAlign = "left";
    pen.fillText(results.names[k] + (results.units[k] ? " [" + results.units[k] + "]" : ""), left, 15);
    pen.textAlign = "right";
    pen.fillText(topValue.toPrecision(4), left - 5, top + 4);
    pen.fillText(bottomValue.toPrecision(4), left - 5, h - bottom + 4);
    pen.fillText("time [s]  " + at(rows - 1, 0).toPrecision(4), w - right, h - 7);
    pen.strokeStyle = "#8894a0"; pen.lineWidth = 1; pen.strokeRect(left, top, w - left - right, h - top - bottom);
    pen.strokeStyle = "#1f6fb4"; pen.lineWidth = 1.5; pen.beginPath();
    for (let r = 0; r < rows; ++r) pen.lineTo(x(at(r, 0)), y(at(r, k)));
    pen.stroke();
    pen.strokeStyle = "#d1495b"; pen.beginPath(); pen.moveTo(x(state.time), top); pen.lineTo(x(state.time), h - bottom); pen.stroke();
  };

  const set = (change) => {
    Object.assign(state, change);
    state.time = Math.min(end, Math.max(start, state.time));
    $("play").textContent = state.playing ? "Pause" : "Play";
    axes.forEach((a) => { a.visible = state.frames; });
    if (state.traces && !traces.length) makeTraces();
    traces.forEach((t) => { t.visible = state.traces; });
    document.body.classList.toggle("dark", state.dark);
    scene.background = new THREE.Color(state.dark ? 0x161b20 : 0xf4f6f8);
    $("speed").value = String(state.speed); $("follow").value = String(state.follow);
  };
  bodies.forEach((b, k) => { if (k > 0) $("follow").add(new Option(b.name, String(k))); });
  results.names.forEach((name, k) => { if (k > 0) $("channel").add(new Option(name, String(k))); });
  // The plot begins with the first channel that is more than rounding.
  for (let k = 1; k < n; ++k) {
    let least = Infinity, most = -Infinity;
    for (let r = 0; r < rows; ++r) { least = Math.min(least, at(r, k)); most = Math.max(most, at(r, k)); }
    if (most - least > 1e-9 && !results.names[k].includes(".orientation.")) { $("channel").value = String(k); break; }
  }
  if (n < 2) canvas.style.display = $("channel").parentElement.style.display = "none";
  $("reactions").disabled = !arrows.length;
  $("time").min = start; $("time").max = end; $("time").step = "any";
  $("time").oninput = () => { set({ time: Number($("time").value), playing: false }); draw(); };
  $("play").onclick = () => set({ playing: !state.playing, time: state.time >= end ? start : state.time });
  $("speed").onchange = () => set({ speed: Number($("speed").value) });
  $("follow").onchange = () => { set({ follow: Number($("follow").value) }); if (state.follow < 0) orbit.target.copy(center); };
  for (const key of ["frames", "reactions", "traces", "dark"]) $(key).onclick = () => set({ [key]: !state[key] });
  $("channel").onchange = draw;
  addEventListener("keydown", (e) => {
    const step = (end - start) / 100;
    const keys = {
      " ": () => $("play").onclick(), ArrowRight: () => set({ time: state.time + step, playing: false }),
      ArrowLeft: () => set({ time: state.time - step, playing: false }), Home: () => set({ time: start }), End: () => set({ time: end, playing: false }),
      "+": () => set({ speed: Math.min(8, state.speed * 2) }), "-": () => set({ speed: Math.max(0.125, state.speed / 2) }),
      f: () => set({ frames: !state.frames }), r: () => set({ reactions: !state.reactions }), t: () => set({ traces: !state.traces }),
      d: () => set({ dark: !state.dark }), b: () => { set({ follow: state.follow < 0 ? Math.min(1, bodies.length - 1) : state.follow + 1 < bodies.length ? state.follow + 1 : -1 }); },
    };
    if (keys[e.key] && e.target.tagName !== "SELECT") { keys[e.key](); e.preventDefault(); }
  });
  let grabbed = null;
  const view = $("view");
  view.onpointerdown = (e) => { grabbed = { x: e.clientX, y: e.clientY, pan: e.button === 2 || e.shiftKey }; view.setPointerCapture(e.pointerId); };
  view.onpointerup = () => { grabbed = null; };
  view.oncontextmenu = (e) => e.preventDefault();
  view.onpointermove = (e) => {
    if (!grabbed) return;
    const dx = e.clientX - grabbed.x, dy = e.clientY - grabbed.y;
    Object.assign(grabbed, { x: e.clientX, y: e.clientY });
    if (grabbed.pan) {
      const k = orbit.distance / innerHeight;
      va.set(1, 0, 0).applyQuaternion(camera.quaternion); orbit.target.addScaledVector(va, -dx * k);
      va.set(0, 1, 0).applyQuaternion(camera.quaternion); orbit.target.addScaledVector(va, dy * k);
    } else {
      orbit.azimuth -= dx * 0.008; orbit.height = Math.min(1.55, Math.max(-1.55, orbit.height + dy * 0.008));
    }
  };
  view.onwheel = (e) => { orbit.distance *= Math.exp(0.001 * e.deltaY); e.preventDefault(); };

  set({ dark: matchMedia("(prefers-color-scheme: dark)").matches });
  let before = performance.now();
  const frame = (now) => {
    const passed = Math.min(0.25, (now - before) / 1000);
    before = now;
    if (state.playing && end > start) {
      state.time += state.speed * passed;
      if (state.time > end) state.time = start + (state.time - end) % (end - start);
    }
    if (!film) draw();
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
  // For tests and films.
  window.se3d = {
    state, start, end, orbit, set,
    show: (t) => { set({ time: t, playing: false }); draw(); },
    // The time of the row of results that was kept next to t (all of them where there are few).
    sampled: (t) => { const [a, b, part] = locate((k) => at(k, 0), rows, t); return at(part < 0.5 ? a : b, 0); },
    // Pictures of this size from now on, seen from there [degrees]; begin and end of the motion.
    film: (width, height, azimuth, elevation) => {
      film = [width, height]; renderer.setPixelRatio(1);
      Object.assign(orbit, { azimuth: azimuth * Math.PI / 180, height: elevation * Math.PI / 180 });
      set({ playing: false, dark: false });
      return `${start} ${end}`;
    },
    // What is seen at a time: the scene, title, clock and plot.
    picture: (t) => {
      set({ time: t, playing: false }); draw();
      const sheet = document.createElement("canvas"), w = sheet.width = renderer.domElement.width, h = sheet.height = renderer.domElement.height;
      const brush = sheet.getContext("2d"), style = getComputedStyle(document.body);
      brush.drawImage(renderer.domElement, 0, 0);
      brush.fillStyle = style.color; brush.font = "bold 18px sans-serif"; brush.fillText($("title").textContent, 16, 30);
      brush.font = "18px sans-serif"; brush.fillText($("clock").textContent, 16, h - 18);
      if (n > 1) { brush.fillStyle = style.getPropertyValue("--panel"); brush.fillRect(w - 388, 8, 380, 190); brush.drawImage(canvas, w - 388, 8, 380, 190); }
      return sheet.toDataURL("image/jpeg", 0.93);
    },
    // Where grain k (from 0 in the order of ids) is, and its radius.
    grain: (k) => Array.from(grains.place.subarray(4 * k, 4 * k + 4)),
    // Milliseconds a picture takes, all of it drawn, over some times of the motion.
    measure: (count) => {
      const gl = renderer.getContext(), pixel = new Uint8Array(4), begin = performance.now();
      for (let k = 0; k < count; ++k) {
        set({ time: start + (end - start) * k / count, playing: false }); draw();
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
      }
      return (performance.now() - begin) / count;
    },
    // Where a point of the ground frame is in the picture.
    project: (r) => {
      va.fromArray(r).project(camera);
      return [(va.x + 1) / 2 * (film ? film[0] : innerWidth), (1 - va.y) / 2 * (film ? film[1] : innerHeight)];
    },
    arrows: () => arrows.filter((a) => a.arrow.visible).map((a) => ({ joint: a.joint.name, at: a.arrow.position.toArray(),
      along: new THREE.Vector3(0, 1, 0).applyQuaternion(a.arrow.quaternion).toArray() })),
    scale: (name) => nodes.find((o) => o.name === name).scale.toArray(),
    position: (name) => bodies.find((b) => b.name === name).position.toArray(),
  };
})();

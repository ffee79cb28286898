// SPDX-License-Identifier: BSD-3-Clause
// The viewer: reads the embedded glTF (as libse3d-io writes it) and results; z is upwards inside.
"use strict";
addEventListener("error", (e) => { window.se3dProblem = String(e.message).replace(/["\\]/g, "'"); });
const se3dDecode = (text) => {
  const code = atob(text), bytes = new Uint8Array(code.length);
  for (let k = 0; k < bytes.length; ++k) bytes[k] = code.charCodeAt(k);
  return bytes.buffer;
};
let se3dRenderer = null, se3dSlow = 0; // one for all that is shown in this page; how slow pictures are
let se3dSun = null, se3dClear = null; // live, until the next file: light with its shadows; what was seen through
// Shows a scene: `glb` with its motion, `other` (null: none) that of another run, `results` {names, units, values} beside
// it, `packed` grains or null, `modes` of a file {names, rows} or null. With `live` ({post}, see live.js) there is no
// motion: what `feed` gets is shown. `close` takes all away again.
const se3dView = async ({ glb, other, results, packed, modes, live }) => {
  const $ = (id) => document.getElementById(id);
  const decode = se3dDecode;
  const closing = new AbortController();
  for (const id of ["follow", "colour", "channel", "mode", "labels"]) $(id).replaceChildren();
  $("follow").add(new Option("nothing", "-1"));
  const gltf = await new THREE.GLTFLoader().parseAsync(glb, ""), { json } = gltf.parser;
  performance.mark("se3d-parsed");
  // Dark lines where a surface bends: given shapes stand out, also those that are seen through.
  const edges = new Map(), ink = new THREE.LineBasicMaterial({ color: 0x10161c, transparent: true, opacity: 0.35 });
  const outline = (o) => {
    if (!edges.has(o.geometry)) edges.set(o.geometry, new THREE.EdgesGeometry(o.geometry, 30));
    if (!edges.get(o.geometry).attributes.position.count && !o.userData.wire) return;
    const lines = new THREE.LineSegments(edges.get(o.geometry), ink);
    if (o.userData.wire) {
      o.material.colorWrite = o.material.depthWrite = false;
      lines.material = new THREE.LineBasicMaterial({ color: o.material.color, transparent: true, opacity: 0.9 });
    }
    o.add(lines);
  };
  // Parts that look alike share a material; what changes on its own gets one of its own first.
  const owners = new Set(), shared = new Set();
  const alone = (o) => {
    if (owners.has(o)) return o.material;
    shared.add(o.material); // the last one to leave it makes it unreachable from the scene
    owners.add(o);
    return (o.material = o.material.clone());
  };
  // The loader makes names of its own.
  const nodes = await gltf.parser.getDependencies("node"), isDrawn = (o) => o.isMesh || o.isLine;
  nodes.forEach((o, k) => {
    o.name = json.nodes[k].name;
    if (!isDrawn(o)) return;
    o.userData.wire = o.material.userData.style === "wire";
    if (!o.isMesh) return;
    if (o.material.opacity < 1 || o.userData.wire) alone(o);
    o.userData.unit = json.meshes[json.nodes[k].mesh].name;
    o.material.side = o.material.shadowSide = THREE.DoubleSide;
    if ((o.name === "shape" || o.name === "road") && o.geometry.attributes.position.count < 60000) outline(o);
    if (o.material.opacity === 1 && !o.userData.wire) { o.receiveShadow = true; o.castShadow = o.name !== "road"; }
  });
  document.title = $("title").textContent = json.scenes[0].name || "se3d";
  const extras = json.scenes[0].extras || {};
  const root = nodes[json.scenes[0].nodes[0]];
  root.quaternion.set(0, 0, 0, 1); // our z is this camera's up
  const bodies = nodes.filter((o) => o.userData.body !== undefined);
  const grid = root.children.find((o) => o.name === "grid");

  // Coils keep a round wire.
  const coils = [], coil = (all, { nodes: list, meshes }) => all.forEach((o, k) => {
    if (o.isMesh && meshes[list[k].mesh].name === "coil") coils.push(se3dCoil(o, o.scale.z / o.scale.x));
  });
  coil(nodes, json);
  // What is round has half as many corners around in pictures that have to be quick.
  const rounds = se3dRounds(nodes);
  // What is closed and solid is seen from outside alone, unless it is cut.
  const closed = nodes.filter((o) => o.isMesh && !o.userData.wire && ["box", "sphere", "cylinder", "cone"].includes(o.userData.unit));
  const face = (isCut) => closed.forEach(({ material }) => {
    const side = material.opacity === 1 && !isCut ? 0 : THREE.DoubleSide; // 0: from outside
    if (material.side !== side) Object.assign(material, { side, needsUpdate: true });
  });
  face(false);
  // Motion: a clip of three.js. A long one was thinned out to more than half of the most samples: then a curve
  // through its points.
  const animate = (top, all, { animations: [clip], parser }) => {
    if (!clip || !clip.tracks.length) return { times: new Float32Array([0]), show: () => {} };
    const mixer = new THREE.AnimationMixer(top), { times } = clip.tracks[0];
    clip.tracks.forEach((track, k) => {
      const { node, path } = parser.json.animations[0].channels[k].target;
      track.name = all[node].uuid + track.name.slice(track.name.lastIndexOf(".")); // names may be there twice
      if (path === "translation" && times.length > 625) track.setInterpolation(THREE.InterpolateSmooth);
    });
    const action = mixer.clipAction(clip).play();
    return { times, show: (t) => { action.time = Math.min(times[times.length - 1], Math.max(times[0], t)); mixer.update(0); } };
  };
  const motion = animate(root, nodes, gltf), { times } = motion;
  // Another run: at the same place as a ghost, or beside with colours of its own.
  const second = other ? await new THREE.GLTFLoader().parseAsync(other, "") : null;
  let secondMotion = null, secondRoot = null, secondBodies = new Map();
  if (second) {
    const all = await second.parser.getDependencies("node"), names = second.parser.json.nodes;
    secondRoot = all[second.parser.json.scenes[0].nodes[0]];
    secondRoot.quaternion.set(0, 0, 0, 1);
    const pale = new THREE.MeshStandardMaterial({ color: 0x8896a4, transparent: true, opacity: 0.35, depthWrite: false, side: THREE.DoubleSide });
    all.forEach((o, k) => {
      if (o.userData.body !== undefined) secondBodies.set(names[k].name, o);
      if (names[k].name === "grid" || names[k].name === "road") o.visible = false;
      if (o.isMesh) { o.material.side = THREE.DoubleSide; Object.assign(o.userData, { own: o.material, pale }); }
    });
    secondMotion = animate(secondRoot, all, second);
    coil(all, second.parser.json);
  }
  const grainTimes = packed && packed.times || [];
  let start = Math.min(times[0], ...grainTimes.slice(0, 1)), end = Math.max(times[times.length - 1], ...grainTimes.slice(-1), ...(secondMotion ? secondMotion.times.slice(-1) : []));
  const qa = new THREE.Quaternion(), va = new THREE.Vector3(), vb = new THREE.Vector3();
  // Live: bodies (position, Euler parameters), then what is between them, with scales, as they came last.
  let places = null;
  const between = root.children.filter((o) => o.userData.element !== undefined);
  const risen = nodes.filter((o) => o.userData.rise !== undefined).map((o) => ({ o, at: o.position.clone(),
    along: new THREE.Vector3(0, 0, 1).applyQuaternion(o.quaternion), rise: o.userData.rise }));
  const put = () => {
    const turn = (o, k) => o.quaternion.set(places[k + 1], places[k + 2], places[k + 3], places[k]);
    let k = 0;
    bodies.forEach((o) => { o.position.fromArray(places, k); turn(o, k + 3); k += 7; });
    between.forEach((o) => { o.position.fromArray(places, k); turn(o, k + 3); o.scale.fromArray(places, k + 7); k += 10; });
    risen.forEach(({ o, at, along, rise }) => o.position.copy(at).addScaledVector(along, places[k + rise]));
  };
  // Modes: beside the last pose, bodies move by the real part of their shape times exp(i phase); what has no frequency
  // decays. What lies between two bodies goes along with the points of them where its ends were.
  const shapes = ((modes || {}).rows || []).map((row) => {
    const get = (name, kind) => ["x", "y", "z", "rx", "ry", "rz"].map((c) => row[modes.names.indexOf(`${name}.${c}${kind}`)] || 0);
    const moves = bodies.map((b) => ({ re: get(b.name, ""), im: get(b.name, "_imag") }));
    const far = (u) => Math.hypot(...u.slice(0, 3));
    return { real: row[1], imag: row[2], frequency: row[3], damping: row[4], moves, most: Math.max(1e-300, ...moves.flatMap(({ re, im }) => [far(re), far(im)])),
      turn: Math.max(1e-300, ...moves.flatMap(({ re, im }) => [far(re.slice(3)), far(im.slice(3))])) };
  });
  let shape = null, phase = 0, reach = 1; // the mode that is shown; how far bodies go [m]
  const rest = { bodies: null, lines: [] };
  const settle = () => {
    rest.bodies = bodies.map((o) => ({ r: o.position.clone(), q: o.quaternion.clone() }));
    const local = (k, v) => v.clone().sub(rest.bodies[k].r).applyQuaternion(rest.bodies[k].q.clone().conjugate());
    const ends = (o) => [-0.5, 0.5].map((s) => new THREE.Vector3(0, 0, s * o.scale.z).applyQuaternion(o.quaternion).add(o.position));
    rest.lines = [];
    (extras.elements || []).forEach((e, k) => {
      const parts = between.filter((o) => o.userData.element === k);
      if (!parts.length || !e.bodies) return;
      const from = ends(parts[0])[0], to = ends(parts[parts.length - 1])[1], length = Math.max(1e-12, to.distanceTo(from));
      rest.lines.push({ i: e.bodies[0], j: e.bodies[1], a: local(e.bodies[0], from), b: local(e.bodies[1], to), parts: parts.map((o) => ({ o, at: ends(o).map((v) => v.distanceTo(from) / length) })) });
    });
  };
  // Move all beside the pose of rest by c times the real and -s times the imaginary part of a shape.
  const displace = ({ moves }, c, s) => {
    bodies.forEach((o, k) => {
      const u = moves[k].re.map((v, i) => c * v - s * moves[k].im[i]), turn = Math.hypot(u[3], u[4], u[5]);
      o.position.set(u[0], u[1], u[2]).add(rest.bodies[k].r);
      o.quaternion.copy(rest.bodies[k].q);
      if (turn > 0) o.quaternion.premultiply(qa.setFromAxisAngle(va.set(u[3] / turn, u[4] / turn, u[5] / turn), turn));
    });
    rest.lines.forEach(({ i, j, a, b, parts }) => {
      const from = a.clone().applyQuaternion(bodies[i].quaternion).add(bodies[i].position), way = b.clone().applyQuaternion(bodies[j].quaternion).add(bodies[j].position).sub(from);
      parts.forEach(({ o, at }) => {
        o.position.copy(from).addScaledVector(way, (at[0] + at[1]) / 2);
        o.scale.z = way.length() * (at[1] - at[0]);
        o.quaternion.setFromUnitVectors(va.set(0, 0, 1), vb.copy(way).normalize());
      });
    });
  };
  const shake = () => {
    const angle = 2 * Math.PI * phase, much = Math.min(reach / shape.most, 0.5 / shape.turn);
    if (!rest.bodies) { follow(end); settle(); }
    if (shape.imag > 0) displace(shape, much * Math.cos(angle), much * Math.sin(angle));
    else displace(shape, much * Math.exp(-4 * phase), 0);
  };
  const pose = (t) => {
    if (places) put();
    else if (shape) shake();
    else follow(t);
  };
  const follow = (t) => { motion.show(t); if (secondMotion) secondMotion.show(t); };

  // Results beside the motion.
  const n = results.names.length;
  let rows = n > 0 ? results.values.length / n : 0;
  const at = (row, column) => results.values[row * n + column];
  const value = (column, t) => {
    const [a, b, part] = se3dLocate((k) => at(k, 0), rows, t);
    return at(a, column) + part * (at(b, column) - at(a, column));
  };

  // Joints, springs and rods: their names and types, and what they are drawn with. `place`: the part at their point of body j.
  const elements = (extras.elements || []).map((e) => ({ ...e, parts: [], place: null }));
  nodes.forEach((o) => {
    const e = elements[o.userData.element];
    if (e && o.isMesh) { e.parts.push(o); if (!e.place && o.name === e.name) e.place = o; }
  });
  const shown = elements.filter((e) => e.place);
  const scene = new THREE.Scene();
  const sky = new THREE.HemisphereLight(0xffffff, 0x777788, 1.6);
  scene.add(root, sky);
  const sun = (live && se3dSun) || new THREE.DirectionalLight(0xffffff, 2.2);
  if (live) se3dSun = sun;
  scene.add(sun, sun.target);
  if (secondRoot) scene.add(secondRoot);
  const camera = new THREE.PerspectiveCamera(40, 1, 0.001, 1000);
  camera.up.set(0, 0, 1);
  const renderer = se3dRenderer || (se3dRenderer = new THREE.WebGLRenderer({ canvas: $("view"), antialias: true, preserveDrawingBuffer: true }));
  renderer.clippingPlanes = [];
  renderer.shadowMap.enabled = sun.castShadow = true;
  renderer.shadowMap.type = THREE.PCFShadowMap;
  if (!live || !se3dSlow) renderer.setPixelRatio(Math.min(2, devicePixelRatio || 1)); // else `paint` says it

  const grains = packed ? se3dGrains(packed, { isLive: !!live, scene, root, renderer, camera, around: () => ({ floor, solids }) }) : null;

  // What the camera looks at: the box around the bodies at a few times.
  const low = new THREE.Vector3(1, 1, 1).multiplyScalar(1e9), high = low.clone().negate();
  const heaviest = bodies.reduce((best, o, k) => (k > 0 && (best < 0 || o.userData.mass > bodies[best].userData.mass) ? k : best), -1);
  let largest0 = 0, own = null; // of what is not the ground, at one time
  const planes = [], boxes = [];
  for (let k = 0; k < (end > start ? 24 : 1); ++k) {
    pose(start + (end - start) * k / 23);
    root.updateMatrixWorld(true);
    low.setScalar(1e9); high.setScalar(-1e9);
    const points = [];
    const least = new THREE.Vector3(1e9, 1e9, 1e9), most = least.clone().negate();
    const isOfGround = (o) => { while (o && o.userData.body === undefined) o = o.parent; return !o || o.userData.body === 0; };
    const reckon = (o) => {
      if (!o.isMesh || !o.visible || o.name === "road") return; // a road goes on beyond the picture
      if (o.material.opacity < 1 && Math.max(o.scale.x, o.scale.y) > 200 * o.scale.z) { // a plane has no ends; one that stands is hardly seen
        if (!o.userData.isPlane) planes.push(o);
        o.userData.isPlane = true;
        if (va.set(0, 0, 1).applyQuaternion(o.getWorldQuaternion(qa)).z < 0.5) alone(o).opacity = 0.08;
        return;
      }
      if (!o.geometry.boundingBox) o.geometry.computeBoundingBox();
      const { min, max } = o.geometry.boundingBox;
      for (let k = 0; k < 8; ++k) {
        va.set(k & 1 ? min.x : max.x, k & 2 ? min.y : max.y, k & 4 ? min.z : max.z).applyMatrix4(o.matrixWorld);
        low.min(va); high.max(va);
        points.push(va.x, va.y, va.z);
        if (!isOfGround(o)) { least.min(va); most.max(va); }
      }
    };
    root.traverse(reckon);
    if (secondRoot) { secondRoot.updateMatrixWorld(true); secondRoot.traverse(reckon); }
    boxes.push({ low: low.clone(), high: high.clone(), size: high.distanceTo(low), points });
    if (heaviest > 0 && most.x >= least.x && most.distanceTo(least) > largest0) {
      largest0 = most.distanceTo(least);
      own = [least.sub(bodies[heaviest].position), most.sub(bodies[heaviest].position)];
    }
  }
  // What parts and falls far away at last does not make all else small.
  const usual = [...boxes].sort((a, b) => a.size - b.size)[boxes.length >> 1].size, most = boxes.filter((b) => b.size <= 1.6 * usual);
  const kept = most.length >= 0.75 * boxes.length ? most : boxes;
  low.setScalar(1e9); high.setScalar(-1e9);
  kept.forEach((b) => { low.min(b.low); high.max(b.high); });
  // What goes far for its size is followed, and as large as it is itself, unless it hangs on the ground.
  const isHeld = shown.some((e) => e.bodies && e.bodies.includes(0));
  const isFar = !live && !packed && !second && !isHeld && own !== null && high.distanceTo(low) > 3 * largest0;
  if (isFar) { pose(start); low.copy(own[0]).add(bodies[heaviest].position); high.copy(own[1]).add(bodies[heaviest].position); }
  let hasRoad = false;
  if (grid) { // a floor under a road lies just below it
    let least = Infinity;
    pose(start); root.updateMatrixWorld(true);
    root.traverse((o) => { if (o.name === "road" && o.isMesh) { o.geometry.computeBoundingBox(); least = Math.min(least, o.geometry.boundingBox.clone().applyMatrix4(o.matrixWorld).min.z); } });
    hasRoad = least < Infinity;
    if (hasRoad) grid.position.z = least - 0.004 * high.distanceTo(low);
  }
  if (packed && packed.box) { if (packed.box[0] !== null) { low.min(va.fromArray(packed.box)); high.max(va.fromArray(packed.box, 3)); } }
  else if (packed) { const wide = grains.sizes()[1]; low.min(va.fromArray(packed.low).subScalar(wide)); high.max(va.fromArray(packed.high).addScalar(wide)); }
  if (!(high.x >= low.x)) { low.set(-1, -1, -1); high.set(1, 1, 1); }
  // What nothing holds stands or lies on the floor; grains never hang through it.
  if (grid && !live && low.z > -1e8 && (packed ? low.z < grid.position.z : !isHeld && !hasRoad)) grid.position.z = low.z - 0.001 * high.distanceTo(low);
  const center = low.clone().add(high).multiplyScalar(0.5), edge = high.clone();
  const size = Math.max(1e-6, high.distanceTo(low));
  // What has to be in the picture: the corners of all that is seen at some times, or of the box around it.
  const eachCorner = (f) => {
    const corners = () => { for (let k = 0; k < 8; ++k) f(va.set(k & 1 ? low.x : high.x, k & 2 ? low.y : high.y, k & 4 ? low.z : high.z)); };
    if (isFar || packed || high.distanceTo(edge) > 0 || !kept[0].points.length) corners();
    else for (const { points } of kept) for (let k = 0; k < points.length; k += 3) f(va.set(points[k], points[k + 1], points[k + 2]));
  };
  // three.js's own controls move the camera; here in angles about what it looks at.
  const controls = new THREE.OrbitControls(camera, renderer.domElement);
  Object.assign(controls, { enableDamping: true, dampingFactor: 0.15, zoomToCursor: true, minDistance: size / 400, maxDistance: 20 * size });
  controls.target.copy(center);
  const look = () => { const [x, y, z] = [...camera.position.clone().sub(controls.target)], flat = Math.hypot(x, y); return [Math.atan2(y, x), Math.atan2(z, flat), Math.hypot(flat, z)]; };
  const place = (azimuth, height, distance) => {
    const c = Math.cos(height);
    camera.position.set(Math.cos(azimuth) * c, Math.sin(azimuth) * c, Math.sin(height)).multiplyScalar(distance).add(controls.target);
    camera.lookAt(controls.target);
  };
  const orbit = {
    get azimuth() { return look()[0]; }, set azimuth(v) { place(v, look()[1], look()[2]); },
    get height() { return look()[1]; }, set height(v) { place(look()[0], Math.min(1.55, Math.max(-1.55, v)), look()[2]); },
    get distance() { return look()[2]; }, set distance(v) { place(look()[0], look()[1], v); },
    target: controls.target,
    // Look at another point from the same side.
    aim: (at) => { camera.position.sub(controls.target).add(at); controls.target.copy(at); },
  };
  place(-0.9, 0.35, 1.35 * size);
  camera.near = size / 500; camera.far = size * 50;
  // The sun's shadow falls on bodies and on the floor, which is where the grid is.
  sun.position.set(0.3, -0.5, 0.8).multiplyScalar(2 * size).add(center);
  sun.target.position.copy(center);
  sun.shadow.mapSize.set(1024, 1024);
  Object.assign(sun.shadow.camera, { left: -0.7 * size, right: 0.7 * size, bottom: -0.7 * size, top: 0.7 * size, near: 0.1 * size, far: 6 * size });
  sun.shadow.bias = -0.0005; sun.shadow.normalBias = 0.002 * size;
  const floor = new THREE.Mesh(new THREE.PlaneGeometry(20 * size, 20 * size), new THREE.ShadowMaterial({ opacity: 0.16 }));
  floor.position.set(center.x, center.y, grid ? grid.position.z : low.z);
  floor.receiveShadow = true;
  scene.add(floor);
  const light = se3dLight(renderer, scene, camera, { size, floor });

  let film = null; // width and height of the pictures of a film
  // Where the camera is, and so far away that the box around all is in the picture.
  const direction = (azimuth, height) => new THREE.Vector3(Math.cos(azimuth) * Math.cos(height), Math.sin(azimuth) * Math.cos(height), Math.sin(height));
  const fit = () => {
    const [width, height] = film || [innerWidth, innerHeight], bar = film ? 0 : Math.min(0.4 * height, $("bar").offsetHeight + 8);
    // The middle is above the bar, and beside the plots, or below them where they are above.
    const box = film ? { width: 0, height: 0 } : $("plots").getBoundingClientRect(), isAbove = width < 600;
    const side = isAbove ? 0 : Math.min(0.3 * width, box.width), above = isAbove && box.height ? Math.min(0.25 * height, box.bottom) : 0;
    camera.aspect = width / height;
    if (bar || side || above) camera.setViewOffset(width, height, 0.5 * side, 0.5 * (bar - above), width, height);
    else camera.clearViewOffset();
    camera.updateProjectionMatrix();
    const aspect = (width - side) / (height - bar - above);
    const back = direction(orbit.azimuth, orbit.height), right = new THREE.Vector3(-Math.sin(orbit.azimuth), Math.cos(orbit.azimuth), 0);
    const up = back.clone().cross(right), tan = Math.tan(camera.fov * Math.PI / 360) * (1 - (bar + above) / height);
    let most = 1e-6 * size;
    eachCorner((v) => {
      v.sub(center);
      most = Math.max(most, v.dot(back) + Math.max(Math.abs(v.dot(right)) / (tan * aspect), Math.abs(v.dot(up)) / tan));
    });
    orbit.distance = 1.08 * most;
  };

  const state = { time: start, playing: true, speed: 1, follow: -1, frames: false, reactions: false, traces: false, dark: false, solid: false, labels: false, cut: 0, picked: null, mode: 0, phase: 0, second: "ghost" };
  // What hides a joint or a grain from the camera is seen through ("x"): rays tell.
  const ray = new THREE.Raycaster(), solids = [];
  root.traverse((o) => { if (o.isMesh && !o.userData.wire && o.geometry.attributes.normal) solids.push(o); });
  const pin = shown.reduce((least, e) => Math.min(least, e.place.scale.x), 0.02 * size);
  const blockers = (eye, point, own, near = 1.05) => {
    vb.copy(point).sub(eye);
    const way = vb.length();
    ray.set(eye, vb.normalize());
    ray.near = 0; ray.far = Math.max(0, way - near * pin);
    return ray.intersectObjects(solids, false).map((hit) => hit.object).filter((o) => o.material.opacity === 1 && !own.includes(o));
  };
  const tight = new Set(); // what leaves nothing of a joint
  // For each joint and some grains the fewest things before one of its points; none: it is seen.
  const hidden = (azimuth, height, count) => {
    const found = [], eye = new THREE.Vector3(), at = new THREE.Vector3();
    tight.clear();
    const stride = Math.ceil(shown.length / 60);
    for (let k = 0; k < count; ++k) {
      const t = start + (end - start) * (count > 1 ? k / (count - 1) : 0);
      pose(t);
      root.updateMatrixWorld(true);
      eye.copy(direction(azimuth, height)).multiplyScalar(orbit.distance).add(state.follow > 0 ? bodies[state.follow].position : orbit.target);
      shown.forEach((e, i) => {
        if (i % stride) return;
        const lookAround = (near) => [[0, 0, 0], [0, 0, 0.9], [0, 0, -0.9], [0.9, 0, 0], [-0.9, 0, 0], [0, 0.9, 0], [0, -0.9, 0]]
          .map((p) => blockers(eye, at.fromArray(p).multiply(e.place.geometry.boundingBox.max).applyMatrix4(e.place.matrixWorld), e.parts, near));
        const around = lookAround(), free = around.filter((list) => !list.length).length;
        if (free < 2) found.push(around[0].length ? around[0] : around.find((list) => list.length));
        if (count < 4) return;
        const close = lookAround(0.05); // what fits around it closely
        if (!close.every((list) => list.some((o) => o.name === "shape"))) return;
        found.push(close[0]);
        close.flat().forEach((o) => tight.add(o));
      });
      if (grains) {
        grains.move(t);
        const { place: spots, count: all } = grains.list();
        for (let g = 0; g < all; g += Math.ceil(all / 150)) {
          if (spots[4 * g + 3] > 0) { const list = blockers(eye, at.fromArray(spots, 4 * g), []); if (list.length) found.push(list); }
        }
      }
    }
    return found;
  };
  const clear = new Set();
  const glaze = () => {
    solids.filter((o) => clear.has(o)).forEach((o) => {
      Object.assign(alone(o), state.solid ? { opacity: 1, transparent: false, depthWrite: true } : { opacity: 0.3, transparent: true, depthWrite: false });
      o.castShadow = state.solid || !packed; // else grains within it would be dark
      o.material.needsUpdate = true;
    });
    face(state.cut);
  };
  // Only given shapes are seen through, never a bar or another joint; nor tubes, of which little would be left.
  const isSlim = (o) => {
    const box = o.geometry.boundingBox, wide = va.copy(box.max).sub(box.min).multiply(o.scale).toArray().map(Math.abs).sort((a, b) => a - b);
    return wide[1] < 2.6 * pin && wide[2] > 3 * wide[1];
  };
  const see = () => {
    if (state.solid) return;
    for (let round = 0; round < 4; ++round) {
      const some = hidden(orbit.azimuth, orbit.height, live ? 1 : 4).flat().filter((o) => o.name === "shape" && !clear.has(o) && (tight.has(o) || !isSlim(o)));
      if (!some.length) return;
      some.forEach((o) => clear.add(o));
      glaze();
    }
  };

  reach = 0.08 * size;
  const axes = bodies.map((b) => { const a = new THREE.AxesHelper(0.15 * size); a.visible = false; b.add(a); return a; });
  // Reactions: arrows at the nodes named as joints.
  const arrows = [];
  results.names.forEach((name, k) => {
    const joint = name.endsWith(".force.x") && nodes.find((o) => o.name === name.slice(0, -8) && o.parent);
    if (!joint) return;
    let largest = 1e-12;
    for (let r = 0; r < rows; ++r) largest = Math.max(largest, Math.hypot(at(r, k), at(r, k + 1), at(r, k + 2)));
    const arrow = new THREE.ArrowHelper(new THREE.Vector3(0, 0, 1), center, 1, 0xcc1166);
    [arrow.line, arrow.cone].forEach((o) => { Object.assign(o.material, { depthTest: false, transparent: true }); o.renderOrder = 2; });
    arrow.visible = false; scene.add(arrow);
    arrows.push({ arrow, joint, column: k, largest });
  });
  let largest = Math.max(1e-12, ...arrows.map((a) => a.largest));
  // Traces of bodies' origins and of markers.
  const traced = bodies.slice(1).flatMap((b) => [b, ...b.children.filter((o) => !isDrawn(o))]);
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

  // Live: a body is pulled at a point of it, in the plane of that point across the view.
  let pull = null;
  const rubber = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: 0xd1495b, depthTest: false, transparent: true }));
  rubber.visible = rubber.frustumCulled = false; rubber.renderOrder = 3;
  rubber.geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(6), 3));
  scene.add(rubber);
  const stretch = () => {
    rubber.visible = !!pull;
    if (!pull) return;
    const line = rubber.geometry.attributes.position;
    va.copy(pull.point).applyMatrix4(bodies[pull.body].matrixWorld).toArray(line.array, 0);
    pull.place.toArray(line.array, 3);
    line.needsUpdate = true;
  };
  const grab = (x, y) => {
    ray.near = 0; ray.far = Infinity;
    ray.setFromCamera(new THREE.Vector2(2 * x / innerWidth - 1, 1 - 2 * y / innerHeight), camera);
    for (const hit of ray.intersectObjects(solids, false)) {
      let o = hit.object;
      while (o && o.userData.body === undefined) o = o.parent;
      if (o && o.userData.body > 0) return { body: o.userData.body, point: o.worldToLocal(hit.point.clone()), place: hit.point.clone() };
    }
    return null;
  };
  const haul = (x, y) => {
    const normal = camera.getWorldDirection(new THREE.Vector3());
    ray.setFromCamera(new THREE.Vector2(2 * x / innerWidth - 1, 1 - 2 * y / innerHeight), camera);
    ray.ray.intersectPlane(new THREE.Plane().setFromNormalAndCoplanarPoint(normal, pull.place), va);
    pull.place.copy(va);
    live.post("pull", `${pull.body} ${[...pull.point.toArray(), ...pull.place.toArray()].join(" ")}`);
  };

  const draw = (isQuick) => {
    const [width, height] = film || [innerWidth, innerHeight];
    const ratio = renderer.getPixelRatio(), { domElement } = renderer, isSized = domElement.width === Math.floor(width * ratio) && domElement.height === Math.floor(height * ratio);
    if (!isSized || camera.aspect !== width / height) {
      const { distance } = orbit;
      if (!isSized) renderer.setSize(width, height, false);
      fit();
      if (state.zoomed) orbit.distance = distance;
    }
    pose(state.time);
    if (grains) grains.move(state.time);
    shade();
    if (state.follow > 0) {
      const { target } = orbit, way = va.copy(bodies[state.follow].position).sub(target);
      if (isFar) for (const o of [sun.position, sun.target.position, floor.position]) { o.x += way.x; o.y += way.y; }
      orbit.aim(bodies[state.follow].position);
    }
    root.updateMatrixWorld(true);
    camera.lookAt(orbit.target);
    planes.forEach((o) => { o.visible = va.setFromMatrixPosition(o.matrixWorld).sub(camera.position).dot(vb.set(0, 0, 1).transformDirection(o.matrixWorld)) < 0; }); // not from behind
    coils.forEach((bend) => bend());
    for (const { arrow, joint, column } of arrows) {
      va.set(value(column, state.time), value(column + 1, state.time), value(column + 2, state.time));
      const length = va.length();
      arrow.visible = state.reactions && length > 1e-6 * largest;
      if (arrow.visible) {
        arrow.setDirection(va.normalize());
        arrow.position.setFromMatrixPosition(joint.matrixWorld).addScaledVector(va, 1.6 * pin); // from its surface on
        arrow.setLength(Math.max(0.02, 0.4 * length / largest) * size, 0.05 * size, 0.025 * size);
      }
    }
    stretch();
    rounds.show(isQuick === true);
    light.render(isQuick === true);
    write();
    $("time").value = state.time;
    $("clock").textContent = shape ? "mode " + state.mode : state.time.toFixed(3) + " s";
    plot();
  };

  // Colours by speed, force, size or set.
  const painted = bodies.map((b, k) => {
    const list = [];
    if (k > 0) b.children.forEach((o) => { if (o.isMesh && o.material.opacity === 1 && (o.name === "shape" || o.name === "link" || o.name === "center")) list.push({ o, usual: o.material.color.clone() }); });
    return list;
  });
  // Speeds of bodies from the positions just before and after.
  const speeds = (t) => {
    if (shape) return bodies.map(() => 0);
    const step = (end - start) / Math.max(2000, times.length), a = Math.max(start, t - step), b = Math.min(end, t + step);
    pose(a);
    const from = bodies.map((o) => o.position.clone());
    pose(b);
    return bodies.map((o, k) => (b > a ? o.position.distanceTo(from[k]) / (b - a) : 0));
  };
  // Joints, springs and dampers with a force among the results.
  const loads = elements.filter((e) => e.parts.length).map((e) => {
    const columns = [".force", ".force.x", ".force.y", ".force.z"].map((end) => results.names.indexOf(e.name + end)).filter((k) => k > 0);
    let most = 0;
    for (let r = 0; r < rows; ++r) most = Math.max(most, Math.hypot(...columns.map((k) => at(r, k))) || 0);
    return { e, columns, most, usual: e.parts.map((o) => o.material.color.clone()) };
  }).filter((l) => l.columns.length);
  let range = null;
  const tint = (o, much) => { const [r, g, b] = se3dRamp(much / (range[1] || 1)).map((v) => v / 255), { color } = alone(o); color.setRGB(r, g, b); color.convertSRGBToLinear(); };
  const measureRange = () => {
    if (state.colour === "size") return grains.sizes();
    if (state.colour === "set") return [0, 0];
    if (state.colour === "force") return [0, Math.max(packed && packed.most || 0, ...loads.map((l) => l.most))];
    let most = 0;
    for (let k = 0; k <= 40; ++k) {
      const t = start + (end - start) * k / 40;
      most = Math.max(most, ...speeds(t));
      if (grains) { grains.move(t); most = Math.max(most, grains.fastest()); }
    }
    return [0, most];
  };
  const shade = () => {
    if (!state.colour && range === null) return;
    range = state.colour ? range || measureRange() : null;
    const now = state.colour === "speed" ? speeds(state.time) : null;
    pose(state.time);
    if (grains) { grains.move(state.time); grains.paint(state.colour, range); }
    painted.forEach((list, k) => list.forEach(({ o, usual }) => {
      alone(o).color.copy(usual);
      if (now) tint(o, now[k]);
      else if (state.colour === "force") o.material.color.setHex(0x9aa5b0);
    }));
    loads.forEach(({ e, columns, usual }) => e.parts.forEach((o, k) => {
      alone(o).color.copy(usual[k]);
      if (state.colour === "force") tint(o, Math.hypot(...columns.map((c) => value(c, state.time))));
    }));
    $("legend").style.display = state.colour ? "block" : "none";
    if (state.colour) {
      $("legend-what").textContent = { size: "radius [m]", force: "force [N]", speed: "speed [m/s]", set: "set" }[state.colour];
      $("legend").classList.toggle("listed", state.colour === "set");
      $("legend-low").textContent = range[0].toPrecision(3); $("legend-high").textContent = range[1].toPrecision(3);
    }
  };

  // Names beside joints and bodies, and what was clicked, in words.
  const named = [...bodies.slice(1).map((o) => ({ o, name: o.name })), ...shown.map((e) => ({ o: e.place, name: e.name }))].slice(0, 120);
  named.forEach((l) => { l.tag = document.createElement("span"); l.tag.textContent = l.name; $("labels").append(l.tag); });
  const digits = (v) => (Math.abs(v) < 1e-9 ? "0" : v.toPrecision(4));
  const describe = () => {
    const { body, element } = state.picked, e = element !== undefined ? elements[element] : null, o = e ? null : bodies[body];
    const name = e ? e.name : o.name, lines = [];
    if (e) lines.push(e.type + (e.bodies ? " between " + e.bodies.map((k) => bodies[k].name).join(" and ") : ""));
    else lines.push(body === 0 ? "the ground" : "body" + (o.userData.mass ? ", " + digits(o.userData.mass) + " kg" : ""), "at " + o.position.toArray().map(digits).join(", ") + " m");
    results.names.forEach((channel, k) => {
      if (channel.startsWith(name + ".") && !channel.includes(".orientation.")) lines.push(channel.slice(name.length + 1) + " " + digits(value(k, state.time)) + " " + (results.units[k] || ""));
    });
    return [name, ...lines.slice(0, 14)];
  };
  const write = () => {
    const [width, height] = film || [innerWidth, innerHeight];
    $("labels").style.display = state.labels ? "block" : "none";
    const taken = [];
    if (state.labels) named.forEach((l) => {
      va.setFromMatrixPosition(l.o.matrixWorld).project(camera);
      const x = (va.x + 1) / 2 * width, y = (1 - va.y) / 2 * height;
      l.tag.style.display = "block";
      if (!l.size) l.size = [l.tag.offsetWidth, l.tag.offsetHeight];
      // To the right, to the left, above, below: where no name is yet; else it is left out.
      const [wide, high] = l.size, isFree = ([a, b]) => !taken.some(([c, d, w, h]) => a < c + w && c < a + wide && b < d + h && d < b + high);
      const spot = va.z < 1 && [[6, -8], [-6 - wide, -8], [-wide / 2, -8 - high], [-wide / 2, 8]].map(([dx, dy]) => [x + dx, y + dy]).find(isFree);
      if (!spot) { l.tag.style.display = "none"; return; }
      taken.push([...spot, wide, high]);
      l.tag.style.transform = `translate(${spot[0]}px,${spot[1]}px)`;
    });
    $("info").style.display = state.picked ? "block" : "none";
    if (state.picked) $("info").textContent = describe().join("\n");
  };
  const pick = (x, y) => {
    ray.near = 0; ray.far = Infinity;
    ray.setFromCamera(new THREE.Vector2(2 * x / innerWidth - 1, 1 - 2 * y / innerHeight), camera);
    const hits = ray.intersectObjects(solids, false).filter((h) => h.object.visible), hit = hits.find((h) => h.object.userData.element !== undefined) || hits.find((h) => h.object.material.opacity === 1) || hits[0];
    let o = hit && hit.object;
    // A joint is picked through what is seen through, not through what is solid.
    if (hit && o.userData.element !== undefined) { const first = hits.find((h) => h.object.material.opacity === 1); if (first && first.distance < hit.distance - 3 * pin) o = first.object; }
    if (!o) return null;
    if (o.userData.element !== undefined) return { element: o.userData.element };
    while (o && o.userData.body === undefined) o = o.parent;
    return o ? { body: o.userData.body } : null;
  };

  const plots = se3dPlots($("plots"), { names: results.names, units: results.units, rows: () => rows, at, seek: (t) => { if (!live) { set({ time: t, playing: false }); draw(); } } });
  addEventListener("resize", () => plots.resize(), { signal: closing.signal });
  const plot = () => { if (live) plots.refresh(); plots.time(state.time); };

  const set = (change) => {
    Object.assign(state, change);
    state.time = Math.min(end, Math.max(start, state.time));
    $("play").textContent = state.playing ? "Pause" : "Play";
    axes.forEach((a) => { a.visible = state.frames; });
    if (state.traces && !traces.length) makeTraces();
    traces.forEach((t) => { t.visible = state.traces; });
    document.body.classList.toggle("dark", state.dark);
    if ("dark" in change) plots.theme();
    if (grid) { grid.material.color.set(state.dark ? 0x4a5560 : 0xb4bcc6); }
    ink.color.set(state.dark ? 0xaab4be : 0x10161c);
    scene.background = new THREE.Color(state.dark ? 0x1d242b : 0xf4f6f8);
    if ("dark" in change) { // dark steel stands out from what is dark, too
      sky.intensity = state.dark ? 2.2 : 1.6;
      nodes.forEach((o) => { if (o.isMesh && o.material.emissive) o.material.emissive.set(state.dark && Math.max(...o.material.color) < 0.15 ? 0x39424b : 0); });
    }
    $("speed").value = String(state.speed); $("follow").value = String(state.follow); $("colour").value = state.colour || "";
    if ("colour" in change) range = state.colour ? null : range;
    if ("solid" in change) { glaze(); see(); }
    if ("cut" in change) {
      const axis = state.cut ? [0, 0, 0].map((v, i) => (i === state.cut - 1 ? 1 : 0)) : null;
      // The half nearer to the camera is cut away.
      const away = axis ? -Math.sign(va.fromArray(axis).dot(direction(orbit.azimuth, orbit.height)) || 1) : 1;
      const plane = axis ? new THREE.Plane(new THREE.Vector3().fromArray(axis).multiplyScalar(away), 0) : null;
      if (plane) plane.constant = -plane.normal.dot(center);
      renderer.clippingPlanes = plane ? [plane] : [];
      if (grains) grains.cut = plane;
      face(state.cut);
    }
    if ("second" in change && secondRoot) {
      // Beside: in the direction in which it is shorter.
      const beside = state.second === "beside", way = edge.x - low.x < edge.y - low.y ? "x" : "y";
      secondRoot.visible = state.second !== "off";
      secondRoot.position.set(0, 0, 0);
      high.copy(edge);
      if (beside) { secondRoot.position[way] = 1.15 * (edge[way] - low[way]) + 4 * pin; high[way] += secondRoot.position[way]; }
      secondRoot.traverse((o) => { if (o.isMesh) o.material = beside ? o.userData.own : o.userData.pale; });
      center.copy(low).add(high).multiplyScalar(0.5);
      if (!state.zoomed) { orbit.aim(center); fit(); }
      $("second").textContent = state.second;
    }
    if ("mode" in change) {
      if (shape) displace(shape, 0, 0);
      shape = shapes[state.mode - 1] || null;
      $("mode").value = String(state.mode);
    }
    phase = state.phase;
    $("help").style.display = state.help ? "block" : "none";
  };
  const hues = ["speed", ...(packed && !live ? ["size"] : []), ...(loads.length || (packed && packed.forces) ? ["force"] : []), ...(packed && packed.sets ? ["set"] : [])];
  for (const [key, text] of [["", "material"], ...hues.map((hue) => [hue, hue])]) $("colour").add(new Option(text, key));
  $("legend-sets").replaceChildren(...((packed && packed.sets) || []).map((name, k) => {
    const line = document.createElement("div"), mark = document.createElement("b");
    mark.style.background = `rgb(${se3dPalette(k).map((v) => Math.round(255 * v))})`;
    line.append(mark, name || "without a name");
    return line;
  }));
  $("colour").onchange = () => { set({ colour: $("colour").value }); draw(); };
  $("mode").add(new Option("none", "0"));
  shapes.forEach((s, k) => $("mode").add(new Option(`${k + 1}: ` + (s.imag > 0 ? `${s.frequency.toPrecision(4)} Hz, damping ${s.damping.toPrecision(3)}` : `s = ${s.real.toPrecision(3)} 1/s`), String(k + 1))));
  $("mode").parentElement.style.display = shapes.length ? "" : "none";
  $("second").style.display = secondRoot ? "" : "none";
  const turnSecond = () => { set({ second: { ghost: "beside", beside: "off", off: "ghost" }[state.second] }); draw(); };
  $("second").onclick = turnSecond;
  $("mode").onchange = () => { set({ mode: Number($("mode").value), phase: 0, playing: true }); draw(); };
  bodies.forEach((b, k) => { if (k > 0) $("follow").add(new Option(b.name, String(k))); });
  plots.quantities.forEach((q) => $("channel").add(new Option(q.name, q.name)));
  // The plots begin with what is more than rounding.
  const choose = () => plots.choose(plots.suggest(innerWidth > 1000 && innerHeight > 600 ? 2 : 1));
  choose();
  if (n < 2) $("plots").style.display = $("channel").parentElement.style.display = $("another").style.display = "none";
  $("reactions").disabled = !arrows.length;
  $("time").min = start; $("time").max = end; $("time").step = "any";
  $("time").oninput = () => { set({ time: Number($("time").value), playing: false }); draw(); };
  $("play").onclick = () => (live ? live.post(state.playing ? "pause" : "run") : set({ playing: !state.playing, time: state.time >= end ? start : state.time }));
  $("speed").onchange = () => (live ? live.post("speed", $("speed").value) : set({ speed: Number($("speed").value) }));
  $("follow").onchange = () => { set({ follow: Number($("follow").value) }); if (state.follow < 0) orbit.aim(center); };
  // A link that keeps camera, time and what is chosen.
  const round = (v) => Number(v.toPrecision(6));
  const share = () => {
    const part = new URLSearchParams({ t: round(state.time), view: [orbit.azimuth, orbit.height, orbit.distance, ...orbit.target.toArray()].map(round).join(","),
      plot: plots.names().join(","), show: ["frames", "reactions", "traces", "dark", "solid", "labels"].filter((key) => state[key]).join(",") });
    if (state.follow > 0 || isFar) part.set("follow", state.follow > 0 ? bodies[state.follow].name : "");
    if (state.colour) part.set("colour", state.colour);
    if (state.mode) part.set("mode", String(state.mode));
    if (secondRoot) part.set("second", state.second);
    if (state.picked) part.set("picked", state.picked.element !== undefined ? elements[state.picked.element].name : bodies[state.picked.body].name);
    location.hash = part.toString();
    return location.href;
  };
  const recall = () => {
    const part = new URLSearchParams(location.hash.slice(1)), change = {};
    const view = (part.get("view") || "").split(",").map(Number);
    if (view.length === 6 && view.every(Number.isFinite) && view[2] > 0) {
      orbit.target.fromArray(view, 3); place(view[0], Math.min(1.55, Math.max(-1.55, view[1])), view[2]); change.zoomed = true;
    }
    if (view.length === 2 && view.every(Number.isFinite)) { Object.assign(orbit, { azimuth: view[0], height: Math.min(1.55, Math.max(-1.55, view[1])) }); fit(); }
    if (part.has("part")) Object.assign(change, { time: start + Number(part.get("part")) * (end - start) || start, playing: false });
    if (part.has("bare")) { document.body.classList.add("bare"); fit(); }
    if (part.has("t") && !live && Number.isFinite(Number(part.get("t")))) Object.assign(change, { time: Number(part.get("t")), playing: false });
    (part.get("show") || "").split(",").forEach((key) => { if (["frames", "reactions", "traces", "dark", "solid", "labels"].includes(key)) change[key] = true; });
    const follow = bodies.findIndex((b) => b.name === part.get("follow"));
    if (part.has("follow")) change.follow = follow > 0 ? follow : -1;
    if (Number(part.get("mode")) > 0 && Number(part.get("mode")) <= shapes.length) change.mode = Math.floor(Number(part.get("mode")));
    if (["ghost", "beside", "off"].includes(part.get("second"))) change.second = part.get("second");
    if (hues.includes(part.get("colour"))) change.colour = part.get("colour");
    const element = elements.findIndex((e) => e.name === part.get("picked")), body = bodies.findIndex((b) => b.name === part.get("picked"));
    if (element >= 0) change.picked = { element }; else if (body >= 0) change.picked = { body };
    if (part.get("plot")) plots.choose(part.get("plot").split(","));
    return change;
  };
  $("share").onclick = () => {
    const link = share();
    if (navigator.clipboard) navigator.clipboard.writeText(link).catch(() => {}); // else it is in the address
  };
  $("questions").onclick = () => set({ help: !state.help });
  $("labelled").onclick = () => { set({ labels: !state.labels }); draw(); };
  for (const key of ["frames", "reactions", "traces", "dark"]) $(key).onclick = () => set({ [key]: !state[key] });
  const linked = (new URLSearchParams(location.hash.slice(1)).get("plot") || "").split(",");
  let chosen = plots.quantities.some((q) => linked.includes(q.name)); // by the user; of another model they say nothing
  $("channel").onchange = () => { chosen = true; plots.replace($("channel").value); draw(); };
  $("another").onclick = () => { chosen = true; plots.add($("channel").value); draw(); };
  addEventListener("keydown", (e) => {
    const step = (end - start) / 100;
    const keys = {
      " ": () => $("play").onclick(), ArrowRight: () => set({ time: state.time + step, playing: false }),
      ArrowLeft: () => set({ time: state.time - step, playing: false }), Home: () => set({ time: start }), End: () => set({ time: end, playing: false }),
      "+": () => set({ speed: Math.min(8, state.speed * 2) }), "-": () => set({ speed: Math.max(0.125, state.speed / 2) }),
      f: () => set({ frames: !state.frames }), r: () => set({ reactions: !state.reactions }), t: () => set({ traces: !state.traces }),
      d: () => set({ dark: !state.dark }), x: () => set({ solid: !state.solid }), l: () => set({ labels: !state.labels }),
      g: () => secondRoot && turnSecond(),
      c: () => set({ cut: (state.cut + 1) % 4 }), "?": () => set({ help: !state.help }), h: () => set({ help: !state.help }),
      Escape: () => set({ help: false, picked: null }), 0: () => { orbit.aim(center); state.zoomed = false; fit(); },
      b: () => { set({ follow: state.follow < 0 ? Math.min(1, bodies.length - 1) : state.follow + 1 < bodies.length ? state.follow + 1 : -1 }); },
    };
    if (live) Object.assign(keys, { ArrowRight: () => live.post("step"), Home: () => live.post("reset"), "+": null, "-": null, ArrowLeft: null, End: null });
    if (keys[e.key] && !(e.target.closest && e.target.closest("select, #sliders")) && !e.ctrlKey && !e.metaKey) { keys[e.key](); e.preventDefault(); }
  }, { signal: closing.signal });
  // A click picks; the rest of the mouse and of fingers is the controls', unless a body is pulled.
  const view = renderer.domElement;
  let down = null;
  view.addEventListener("pointerdown", (e) => {
    down = { x: e.clientX, y: e.clientY, id: e.pointerId };
    if (!live || !(e.ctrlKey || live.pulls()) || !(pull = grab(e.clientX, e.clientY))) return;
    controls.enabled = false;
    view.setPointerCapture(e.pointerId);
    haul(e.clientX, e.clientY);
  }, { signal: closing.signal, capture: true });
  view.addEventListener("pointermove", (e) => { if (pull) haul(e.clientX, e.clientY); }, { signal: closing.signal });
  const leave = (e) => {
    if (pull) { pull = null; controls.enabled = true; live.post("release"); return; }
    if (down && down.id === e.pointerId && e.type === "pointerup" && Math.hypot(e.clientX - down.x, e.clientY - down.y) < 4) set({ picked: pick(e.clientX, e.clientY) });
    down = null;
  };
  for (const type of ["pointerup", "pointercancel"]) view.addEventListener(type, leave, { signal: closing.signal });
  controls.addEventListener("start", () => { state.zoomed = true; });
  controls.addEventListener("end", () => { see(); fresh = true; });

  // From the side from which most joints are seen; what still hides one is seen through.
  fit();
  if (shown.length && !new URLSearchParams(location.hash.slice(1)).has("view")) { // unless it is given
    const around = [-0.9, 0.9, 2.2, -2.2].map((azimuth) => [hidden(azimuth, 0.35, live ? 1 : 2).length, azimuth]);
    orbit.azimuth = around.reduce((a, b) => (b[0] < a[0] ? b : a))[1];
    fit();
  }
  set({ dark: matchMedia("(prefers-color-scheme: dark)").matches, second: "ghost", follow: isFar ? heaviest : -1 });
  set(recall());
  // Of a file that is saved again the same things are seen through at first: the first picture does not wait for rays.
  const alike = solids.map((o) => `${o.parent.name} ${o.name}`).join();
  const isAlike = !!live && se3dClear !== null && se3dClear.alike === alike;
  let isLate = isAlike && !state.solid;
  if (isAlike) { se3dClear.list.forEach((k) => clear.add(solids[k])); glaze(); }
  if (!isLate) see();
  // Whether there is another picture than the last one.
  const isBare = () => document.body.classList.contains("bare");
  let fresh = true, last = "";
  const isOther = () => {
    const what = [innerWidth, innerHeight, JSON.stringify(orbit), JSON.stringify(state), pull ? JSON.stringify(pull.place) : ""].join();
    const other = fresh || what !== last || isBare(); // who takes a picture waits for one
    last = what; fresh = false;
    return other;
  };
  // At most one picture waits to be painted, so that what comes meanwhile is shown by the next one. Live, pictures that
  // take long (no GPU) are made with fewer points while all moves.
  const gl = renderer.getContext(), fine = Math.min(2, devicePixelRatio || 1);
  let fence = null, began = 0, idle = 0, held = false, moved = 0, isRough = false;
  const isPainted = () => {
    if (!fence) return true;
    if (!gl.isContextLost() && gl.getSyncParameter(fence, gl.SYNC_STATUS) !== gl.SIGNALED) return false;
    gl.deleteSync(fence);
    fence = null;
    const took = performance.now() - began;
    idle = live && took > 70 ? performance.now() + 0.7 * took : 0; // for what else the page has to do
    se3dSlow = took > 70 ? Math.min(6, se3dSlow + 1) : Math.max(0, se3dSlow - 0.2);
    if (live && live.painted) live.painted();
    if (isLate) { isLate = false; see(); fresh = true; }
    return true;
  };
  const paint = () => {
    const isFirst = live && live.painted; // of a file that was saved
    const ratio = live && se3dSlow >= 3 && (state.playing || pull || isFirst) ? 0.5 * fine : fine;
    if (live && renderer.getPixelRatio() !== ratio) renderer.setPixelRatio(ratio);
    began = performance.now();
    const isMoving = state.playing || pull || isFirst || performance.now() - moved < 150;
    isRough = isMoving && se3dSlow > 0 && !isBare(); // the fine picture comes when all rests
    renderer.shadowMap.autoUpdate = !(isFirst && sun.shadow.map); // until then those of the file before
    draw(isRough);
    renderer.shadowMap.autoUpdate = true;
    fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
  };
  let before = performance.now();
  const frame = (now) => {
    if (closing.signal.aborted) return;
    if (!isPainted() || held || performance.now() < idle) { requestAnimationFrame(frame); return; }
    const passed = Math.min(0.25, Math.max(0, (now - before) / 1000));
    before = now;
    if (shape && state.playing && !live) {
      set({ phase: (state.phase + 0.7 * state.speed * passed) % 1 });
    } else if (state.playing && end > start && !live) {
      state.time = start + (state.time + state.speed * passed - start) % (end - start);
    }
    if (film) return; // its pictures are asked for
    controls.update();
    if (isOther()) { moved = now; paint(); } else if (isRough && now - moved > 200) paint();
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
  // Live: what came last; the plot keeps the last rows.
  let fed = false;
  const feed = ({ t, running, speed, places: now, values, grains: dots }) => {
    if (now.length < 7 * bodies.length + 10 * between.length) return;
    places = now;
    if (grains) grains.feed(new Float32Array(decode(dots || "")));
    if (grains && dots && !fed) { fed = true; pose(t); see(); } // what hides the first of them
    fresh = true;
    if (rows > 0 && t < at(rows - 1, 0)) { rows = 0; results.values = []; }
    if (rows === 0 || t > at(rows - 1, 0)) {
      results.values.push(t, ...values.map((v) => (v === null ? NaN : v)));
      if (++rows > 4000) { results.values.splice(0, 1000 * n); rows -= 1000; }
      for (const a of arrows) a.largest = Math.max(a.largest, Math.hypot(...[0, 1, 2].map((i) => at(rows - 1, a.column + i))) || 0);
      largest = Math.max(largest, ...arrows.map((a) => a.largest));
      if (rows === 40 && !chosen) choose();
    }
    start = at(0, 0); end = Math.max(t, start);
    set({ time: t, playing: running, speed });
  };
  // What is returned frees the rest: after the next picture, so that it finds its programs made.
  const close = () => {
    closing.abort();
    controls.dispose();
    plots.close();
    se3dClear = { alike, list: solids.flatMap((o, k) => (clear.has(o) ? [k] : [])) };
    return () => {
      light.close();
      rounds.close();
      scene.traverse((o) => { if (o.geometry) o.geometry.dispose(); if (o.material && o.material.dispose) o.material.dispose(); });
      shared.forEach((m) => m.dispose());
    };
  };
  // For tests and films.
  const written = { title: null, hide: [], captions: [] };
  window.se3d = {
    state, start, end, orbit, controls, set,
    show: (t) => { set({ time: t, playing: false }); draw(); },
    // The time of the row of results that was kept next to t (all of them where there are few).
    sampled: (t) => { const [a, b, part] = se3dLocate((k) => at(k, 0), rows, t); return at(part < 0.5 ? a : b, 0); },
    // Pictures of this size from now on, seen from there [degrees]; begin and end of the motion.
    film: (width, height, azimuth, elevation) => {
      film = [width, height]; renderer.setPixelRatio(1);
      Object.assign(orbit, { azimuth: azimuth * Math.PI / 180, height: elevation * Math.PI / 180 });
      state.zoomed = false; orbit.aim(center); fit(); see();
      set({ playing: false, dark: false });
      return `${start} ${end}`;
    },
    // What is written on the pictures of a film.
    words: ({ title, hide, caption }) => {
      if (title !== undefined) written.title = title;
      if (hide !== undefined) written.hide = hide.split(",");
      if (caption) written.captions.push(caption);
      return "good";
    },
    // What is seen at a time: the scene, title, clock and plot.
    picture: (t) => {
      set({ time: t, playing: false }); draw();
      const sheet = document.createElement("canvas"), w = sheet.width = renderer.domElement.width, h = sheet.height = renderer.domElement.height;
      const brush = sheet.getContext("2d"), style = getComputedStyle(document.body);
      brush.drawImage(renderer.domElement, 0, 0);
      brush.fillStyle = style.color; brush.font = "bold 18px sans-serif";
      if (!written.hide.includes("title")) brush.fillText(written.title === null ? $("title").textContent : written.title, 16, 30);
      brush.font = "18px sans-serif";
      if (!written.hide.includes("time")) brush.fillText($("clock").textContent, 16, h - 18);
      written.captions.filter(([from, to]) => t >= from && t < to).forEach(([, , text], k) => {
        brush.font = "24px sans-serif";
        const wide = Math.min(w - 40, brush.measureText(text).width), y = h - 34 - 44 * k;
        brush.fillStyle = style.getPropertyValue("--panel"); brush.fillRect((w - wide) / 2 - 14, y - 29, wide + 28, 40);
        brush.fillStyle = style.color; brush.fillText(text, (w - wide) / 2, y, wide);
      });
      let top = 8;
      for (const { title, canvas, frame, line } of (written.hide.includes("plots") ? [] : plots.pictures().slice(0, 3))) {
        const wide = canvas.width, high = canvas.height + 22, left = w - wide - 8;
        brush.fillStyle = style.getPropertyValue("--panel"); brush.fillRect(left, top, wide, high);
        brush.fillStyle = style.color; brush.font = "13px sans-serif"; brush.fillText(title, left + 8, top + 16);
        brush.drawImage(canvas, left, top + 22);
        if (line >= 0 && line <= 1) { brush.fillStyle = "#d1495b"; brush.fillRect(left + frame.left + line * frame.width - 0.5, top + 22 + frame.top, 1.5, frame.height); }
        top += high + 6;
      }
      return sheet.toDataURL("image/jpeg", 0.93);
    },
    // Where grain k (from 0 in the order of ids) is, and its radius.
    grain: (k) => Array.from(grains.list().place.subarray(4 * k, 4 * k + 4)),
    plots, share, pick: (x, y) => { set({ picked: pick(x, y) }); draw(); return $("info").textContent; },
    elements: () => shown.map((e) => e.name),
    // How many points of the picture show each joint or spring: those that change when it has another colour.
    seen: (t) => {
      set({ time: t, playing: false }); draw();
      const w = renderer.domElement.width, h = renderer.domElement.height, gl = renderer.getContext();
      const look = () => { renderer.render(scene, camera); const all = new Uint8Array(4 * w * h); gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, all); return all; };
      const plain = look();
      return shown.map((e) => {
        const own = e.parts.map((o) => o.material);
        e.parts.forEach((o) => { o.material = new THREE.MeshBasicMaterial({ color: 0xff00ff }); });
        const other = look();
        e.parts.forEach((o, k) => { o.material = own[k]; });
        let points = 0;
        for (let k = 0; k < plain.length; k += 4) points += Math.abs(plain[k] - other[k]) + Math.abs(plain[k + 1] - other[k + 1]) + Math.abs(plain[k + 2] - other[k + 2]) > 60;
        return [e.name, points];
      });
    },
    // What a quick picture has of a fine one: its triangles, and points that are the same.
    quick: (t) => {
      set({ time: t, playing: false });
      const w = renderer.domElement.width, h = renderer.domElement.height, gl = renderer.getContext();
      const look = (few) => {
        const all = new Uint8Array(4 * w * h);
        rounds.show(few); renderer.render(scene, camera); gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, all);
        return { all, triangles: renderer.info.render.triangles };
      };
      draw();
      const many = look(false), few = look(true);
      let same = 0;
      for (let k = 0; k < many.all.length; k += 4) same += Math.abs(many.all[k] - few.all[k]) + Math.abs(many.all[k + 1] - few.all[k + 1]) + Math.abs(many.all[k + 2] - few.all[k + 2]) < 60;
      return [few.triangles / many.triangles, same / (w * h)];
    },
    // How many grains are there, and of how many at least a point is seen.
    seenGrains: (t) => { set({ time: t, playing: false }); draw(); return grains.seen(); },
    // Whether some of it is out of the picture.
    clipped: () => {
      draw();
      let most = 0;
      eachCorner((v) => { v.project(camera); most = Math.max(most, Math.abs(v.x), Math.abs(v.y)); });
      return most > 1;
    },
    // Milliseconds a picture takes, all of it drawn, over some times of the motion.
    light,
    measure: (count, isQuick) => {
      const gl = renderer.getContext(), pixel = new Uint8Array(4), begin = performance.now();
      for (let k = 0; k < count; ++k) {
        set({ time: start + (end - start) * k / count, playing: false }); draw(isQuick);
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
    // Mode k from 1 at a phase, in turns.
    mode: (k, turns) => { set({ mode: k, phase: turns, playing: false }); draw(); },
    // Least and largest radius of a spring's wire, in its middle.
    wire: (name) => {
      const o = nodes.find((o) => o.name === name), all = o.geometry.attributes.position, first = 8 * Math.floor(all.count / 16);
      const ring = Array.from({ length: 8 }, (_, k) => new THREE.Vector3().fromBufferAttribute(all, first + k).applyMatrix4(o.matrixWorld));
      const middle = ring.reduce((a, b) => a.add(b), new THREE.Vector3()).divideScalar(8), far = ring.map((p) => p.distanceTo(middle));
      return [Math.min(...far), Math.max(...far)];
    },
    floor: () => floor.position.z,
    scale: (name) => nodes.find((o) => o.name === name).scale.toArray(),
    second: (name) => secondBodies.get(name).getWorldPosition(new THREE.Vector3()).toArray(),
    position: (name) => bodies.find((b) => b.name === name).position.toArray(),
  };
  return { feed, close, share, hold: (what) => { held = what; } };
};
if (document.getElementById("glb")) {
  Promise.resolve(window.se3dReady).then(() => {
    const text = (id) => document.getElementById(id).textContent, results = JSON.parse(text("results"));
    return se3dView({ glb: se3dDecode(text("glb").trim()), other: text("other") ? se3dDecode(text("other")) : null, results: { ...results, values: new Float32Array(se3dDecode(results.data)) }, packed: JSON.parse(text("grains")), modes: JSON.parse(text("modes")), live: null });
  }).catch((e) => { window.se3dProblem = String(e.message); throw e; });
}

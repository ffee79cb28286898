// SPDX-License-Identifier: BSD-3-Clause
// What light does not reach: ambient occlusion, found from the depths of the picture, and the shadow right below what
// is close to the floor. Both are left out of pictures that have to be quick.
"use strict";
// From blue over green to yellow (viridis, which all tell apart and which prints well), 0 to 255; colours of sets
// (Okabe and Ito), again from the first one after the last, 0 to 1.
const se3dRamp = (part) => {
  const steps = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
  const x = 4 * Math.min(1, Math.max(0, part || 0)), k = Math.min(3, Math.floor(x));
  return steps[k].map((c, i) => c + (x - k) * (steps[k + 1][i] - c));
};
const se3dPalette = (k) => [[0.9, 0.62, 0], [0.34, 0.71, 0.91], [0, 0.62, 0.45], [0.94, 0.89, 0.26], [0, 0.45, 0.7], [0.84, 0.37, 0], [0.8, 0.47, 0.65]][k % 7];
const se3dLight = (renderer, scene, camera, { size, floor }) => {
  const { ShaderMaterial, WebGLRenderTarget, NearestFilter, LinearFilter } = THREE;
  const stage = new THREE.Scene(), flat = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 1);
  const quad = new THREE.Mesh(new THREE.PlaneGeometry(2, 2));
  quad.frustumCulled = false;
  stage.add(quad);
  const vertexShader = "varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }";
  const pass = (uniforms, fragmentShader, more = {}) => new ShaderMaterial({ uniforms, vertexShader, fragmentShader, depthTest: false, depthWrite: false, ...more });
  const target = (filter, depth) => new WebGLRenderTarget(1, 1, { minFilter: filter, magFilter: filter, depthBuffer: !!depth, depthTexture: depth || null });
  // Half as many points across as the picture has are enough for what changes slowly.
  const depth = new THREE.DepthTexture(1, 1, THREE.UnsignedIntType), shapes = target(NearestFilter, depth), rough = target(NearestFilter), smooth = target(LinearFilter);
  const shared = { depth: { value: depth }, inverse: { value: camera.projectionMatrixInverse }, step: { value: new THREE.Vector2() } };
  const places = `varying vec2 at; uniform sampler2D depth; uniform mat4 inverse; uniform vec2 step;
    vec3 place(vec2 p) { vec4 v = inverse * vec4(2.0 * p - 1.0, 2.0 * texture2D(depth, p).r - 1.0, 1.0); return v.xyz / v.w; }
    vec3 less(vec3 a, vec3 b) { return dot(a, a) < dot(b, b) ? a : b; }`;
  // Scalable ambient obscurance (McGuire, Mara and Luebke, 2012): how much of the half ball over a point is taken.
  const find = pass({ ...shared, radius: { value: 0.05 * size }, high: { value: 1 } }, `${places} uniform float radius, high;
    void main() {
      if (texture2D(depth, at).r >= 1.0) { gl_FragColor = vec4(1.0); return; }
      vec3 p = place(at);
      vec3 dx = less(place(at + vec2(step.x, 0.0)) - p, p - place(at - vec2(step.x, 0.0)));
      vec3 dy = less(place(at + vec2(0.0, step.y)) - p, p - place(at - vec2(0.0, step.y)));
      vec3 n = normalize(cross(dx, dy));
      float wide = min(60.0, radius * high / -p.z), sum = 0.0, turn = 6.2831853 * fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
      for (int k = 0; k < 12; ++k) {
        float part = (float(k) + 0.5) / 12.0, angle = turn + 2.399963 * 3.0 * float(k);
        vec3 v = place(at + wide * part * vec2(cos(angle), sin(angle)) * step) - p;
        float vv = dot(v, v), f = max(0.0, 1.0 - vv / (radius * radius));
        sum += f * f * f * max(0.0, (dot(v, n) - 0.0015 * -p.z) / (sqrt(vv) + 0.02 * radius));
      }
      gl_FragColor = vec4(clamp(1.0 - 4.0 * sum / 12.0, 0.3, 1.0), 0.0, 0.0, 1.0);
    }`);
  // The mean of 4 x 4 points that are as far away.
  const blur = pass({ ...shared, found: { value: rough.texture }, radius: find.uniforms.radius }, `${places} uniform sampler2D found; uniform float radius;
    void main() {
      float far = place(at).z, sum = 0.0, weight = 1e-4;
      for (int i = -2; i < 2; ++i) for (int j = -2; j < 2; ++j) {
        vec2 q = at + (vec2(float(i), float(j)) + 0.5) * step;
        float w = max(0.0, 1.0 - abs(place(q).z - far) / (0.5 * radius));
        sum += w * texture2D(found, q).r; weight += w;
      }
      gl_FragColor = vec4(weight > 0.01 ? sum / weight : 1.0, 0.0, 0.0, 1.0);
    }`);
  const darken = pass({ found: { value: smooth.texture } }, "varying vec2 at; uniform sampler2D found; void main() { gl_FragColor = vec4(vec3(texture2D(found, at).r), 1.0); }",
    { transparent: true, blending: THREE.CustomBlending, blendSrc: THREE.ZeroFactor, blendDst: THREE.SrcColorFactor, blendSrcAlpha: THREE.ZeroFactor, blendDstAlpha: THREE.OneFactor });
  // The floor seen from below: what is near is dark, blurred along both directions.
  const high = 0.25 * size, half = 0.75 * size, below = new THREE.OrthographicCamera(half, -half, half, -half, 0, high);
  const near = new ShaderMaterial({ side: THREE.DoubleSide, vertexShader: "void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }",
    fragmentShader: "void main() { float p = 1.0 - gl_FragCoord.z; gl_FragColor = vec4(0.0, 0.0, 0.0, p * p); }" });
  const marks = [target(LinearFilter, new THREE.DepthTexture(1, 1, THREE.UnsignedIntType)), target(LinearFilter)];
  marks.forEach((m) => m.setSize(256, 256));
  const smear = pass({ found: { value: null }, way: { value: new THREE.Vector2() } }, `varying vec2 at; uniform sampler2D found; uniform vec2 way;
    void main() { float sum = 0.0; for (int k = -4; k <= 4; ++k) sum += (5.0 - abs(float(k))) * texture2D(found, at + float(k) * way).a; gl_FragColor = vec4(0.0, 0.0, 0.0, sum / 25.0); }`);
  const touch = new THREE.Mesh(new THREE.PlaneGeometry(2 * half, 2 * half), new THREE.MeshBasicMaterial({ map: marks[0].texture, transparent: true, opacity: 0.55, depthWrite: false }));
  touch.position.z = 0.0008 * size;
  floor.add(touch);

  const show = (material, into) => { quad.material = material; renderer.setRenderTarget(into); renderer.render(stage, flat); };
  // Without what is no surface and what `isLeft` says. Runs `work`, and puts all back.
  const isThrough = (o) => o.material && o.material.transparent;
  const bare = (isLeft, work) => {
    const away = [], { background } = scene, { autoUpdate } = renderer.shadowMap;
    scene.traverseVisible((o) => { if (o !== scene && o !== floor && (o.isLine || o.userData.wire || isLeft(o))) away.push(o); });
    const hide = (is) => away.forEach((o) => { if (o.material) o.material.visible = is; else o.visible = is; });
    hide(false);
    scene.background = null;
    renderer.shadowMap.autoUpdate = false;
    work();
    hide(true);
    scene.background = background;
    renderer.shadowMap.autoUpdate = autoUpdate;
  };
  const opaque = new THREE.MeshBasicMaterial();
  const occlude = () => {
    const { width, height } = renderer.domElement, w = Math.ceil(width / 2), h = Math.ceil(height / 2);
    if (shapes.width !== w || shapes.height !== h) [shapes, rough, smooth].forEach((t) => t.setSize(w, h));
    shared.step.value.set(1 / w, 1 / h);
    find.uniforms.high.value = 0.5 * h * camera.projectionMatrix.elements[5];
    bare(isThrough, () => {
      const shadowed = floor.material;
      floor.material = opaque;
      renderer.setRenderTarget(shapes);
      renderer.render(scene, camera);
      floor.material = shadowed;
    });
    show(find, rough);
    show(blur, smooth);
    renderer.autoClear = false;
    show(darken, null);
    renderer.autoClear = true;
  };
  const ground = () => {
    below.position.copy(floor.position);
    below.up.set(0, 1, 0);
    below.lookAt(floor.position.x, floor.position.y, floor.position.z + 1);
    const color = renderer.getClearColor(new THREE.Color()), alpha = renderer.getClearAlpha(), { visible } = floor;
    // Only meshes of three.js's own materials: grains place themselves.
    bare((o) => o.name === "road" || o.userData.isPlane || (isThrough(o) && o.name !== "shape") || (o.material && o.material.isShaderMaterial), () => {
      floor.visible = false;
      scene.overrideMaterial = near;
      renderer.setClearColor(0, 0);
      renderer.setRenderTarget(marks[0]);
      renderer.render(scene, below);
      scene.overrideMaterial = null;
    });
    [[0, 1, 1 / 128, 0], [1, 0, 0, 1 / 128]].forEach(([from, to, x, y]) => { smear.uniforms.found.value = marks[from].texture; smear.uniforms.way.value.set(x, y); show(smear, marks[to]); });
    renderer.setClearColor(color, alpha);
    floor.visible = visible;
    renderer.setRenderTarget(null);
  };
  return {
    render: (isQuick) => {
      touch.visible = !isQuick;
      if (!isQuick) ground();
      renderer.setRenderTarget(null);
      renderer.render(scene, camera);
      if (!isQuick) occlude();
    },
    // For tests: how light the darkest and the lightest point are that is found, 0 to 255.
    found: () => {
      const all = new Uint8Array(4 * smooth.width * smooth.height);
      renderer.readRenderTargetPixels(smooth, 0, 0, smooth.width, smooth.height, all);
      let least = 255, most = 0;
      for (let k = 0; k < all.length; k += 4) { least = Math.min(least, all[k]); most = Math.max(most, all[k]); }
      return [least, most];
    },
    mark: () => {
      const all = new Uint8Array(4 * 256 * 256);
      renderer.readRenderTargetPixels(marks[0], 0, 0, 256, 256, all);
      return all.reduce((most, v, k) => (k % 4 === 3 ? Math.max(most, v) : most), 0);
    },
    close: () => { [shapes, rough, smooth, ...marks].forEach((t) => { if (t.depthTexture) t.depthTexture.dispose(); t.dispose(); }); [find, blur, darken, near, smear].forEach((m) => m.dispose()); },
  };
};

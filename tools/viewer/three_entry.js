// SPDX-License-Identifier: BSD-3-Clause
// What the viewer uses of three.js: only this is bundled.
export {
  AmbientLight, AnimationClip, AxesHelper, ArrowHelper, BufferAttribute, BufferGeometry, Color, DirectionalLight, Group,
  HemisphereLight, Line, LineBasicMaterial, LineSegments, Matrix4, Mesh, MeshStandardMaterial, PerspectiveCamera,
  Quaternion, Scene, Vector3, WebGLRenderer,
} from "three";

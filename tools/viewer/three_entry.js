// SPDX-License-Identifier: BSD-3-Clause
// What the viewer uses of three.js: only this is bundled.
export {
  AxesHelper, ArrowHelper, BufferAttribute, BufferGeometry, Color, DirectionalLight, Group,
  HemisphereLight, InstancedBufferAttribute, InstancedBufferGeometry, Line, LineBasicMaterial, LineSegments, Mesh,
  MeshStandardMaterial, PerspectiveCamera, Quaternion, REVISION, Scene, ShaderMaterial, Vector3, WebGLRenderer,
} from "three";

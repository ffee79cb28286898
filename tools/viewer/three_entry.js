// SPDX-License-Identifier: BSD-3-Clause
// What the viewer uses of three.js: only this is bundled.
export {
  AxesHelper, ArrowHelper, BufferAttribute, BufferGeometry, Color, DirectionalLight, EdgesGeometry, Group,
  HemisphereLight, InstancedBufferAttribute, InstancedBufferGeometry, Line, LineBasicMaterial, LineSegments, Mesh,
  MeshBasicMaterial, MeshStandardMaterial, PCFShadowMap, PerspectiveCamera, Plane, PlaneGeometry, Quaternion, Raycaster,
  REVISION, Scene, ShaderMaterial, ShadowMaterial, Vector2, Vector3, WebGLRenderer,
} from "three";

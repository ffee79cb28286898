// SPDX-License-Identifier: BSD-3-Clause
// What the viewer uses of three.js and uPlot: only this is bundled.
import uPlot from "uplot";
import style from "uplot/dist/uPlot.min.css";

const sheet = document.createElement("style");
sheet.textContent = style;
document.head.prepend(sheet); // what the page says of its own comes after it

export { uPlot };
export { OrbitControls } from "three/addons/controls/OrbitControls.js";
export { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
export {
  AnimationMixer, AxesHelper, ArrowHelper, BufferAttribute, BufferGeometry, Color, CustomBlending, DepthTexture, DirectionalLight,
  DoubleSide, EdgesGeometry, HemisphereLight, InstancedBufferAttribute, InstancedBufferGeometry, InterpolateSmooth, Line,
  LinearFilter, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, MeshStandardMaterial, MOUSE, NearestFilter, OneFactor,
  OrthographicCamera, PCFShadowMap, PerspectiveCamera, Plane, PlaneGeometry, Quaternion, Raycaster, Scene, ShaderMaterial,
  ShadowMaterial, SrcColorFactor, UnsignedIntType, Vector2, Vector3, WebGLRenderer, WebGLRenderTarget, ZeroFactor,
} from "three";

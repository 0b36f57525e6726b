// `lit`: a row of pixels, one a normal: lit by a light probe through three.js's material, and by zonal's kernel through a material
// whose shader is the kernel. Both see the world's normals through the same camera.
// `probed`: what three.js makes of a cubemap.

import * as three from "three";
import { LightProbeGenerator } from "three/addons/lights/LightProbeGenerator.js";

/** Quads side by side that face the camera, each with one normal at all of its corners. */
function quads(normals) {
  const corners = [[0, -1], [1, -1], [1, 1], [0, -1], [1, 1], [0, 1]];
  const place = (i, [x, y]) => [(2 * (i + x)) / normals.length - 1, y, 0];
  const geometry = new three.BufferGeometry();
  const attribute = (rows) => new three.Float32BufferAttribute(rows.flat(), 3);
  geometry.setAttribute("position", attribute(normals.flatMap((_, i) => corners.map((corner) => place(i, corner)))));
  geometry.setAttribute("normal", attribute(normals.flatMap((normal) => corners.map(() => normal))));
  return geometry;
}

/** The coefficients of a light probe of six faces, which are the bytes of images, as three.js's own generator makes it. */
window.probed = async ({ faces }) => {
  const urls = faces.map((bytes) => URL.createObjectURL(new Blob([new Uint8Array(bytes)])));
  const texture = await new three.CubeTextureLoader().loadAsync(urls);
  return LightProbeGenerator.fromCubeTexture(texture).sh.toArray();
};

window.lit = ({ normals, probe, coefficients, kernel, name }) => {
  const renderer = new three.WebGLRenderer();
  const target = new three.WebGLRenderTarget(normals.length, 1, { type: three.FloatType });
  const camera = new three.OrthographicCamera(-1, 1, 1, -1, 0, 2);
  camera.position.z = 1;
  const geometry = quads(normals);
  const draw = (material, ...lights) => {
    const scene = new three.Scene().add(new three.Mesh(geometry, material), ...lights);
    renderer.setRenderTarget(target);
    renderer.render(scene, camera);
    const pixels = new Float32Array(4 * normals.length);
    renderer.readRenderTargetPixels(target, 0, 0, normals.length, 1, pixels);
    return Array.from({ length: normals.length }, (_, i) => [...pixels.slice(4 * i, 4 * i + 3)]);
  };

  const light = new three.LightProbe();
  light.sh.fromArray(probe.flat());
  const own = new three.ShaderMaterial({
    glslVersion: three.GLSL3,
    uniforms: { coefficients: { value: coefficients.map((rgb) => new three.Vector3(...rgb)) } },
    vertexShader: `out vec3 direction;
void main() {
  direction = normal;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`,
    fragmentShader: `in vec3 direction;
out vec4 colour;
uniform vec3 coefficients[${coefficients.length}];
${kernel}
void main() {
  colour = vec4(${name}(normalize(direction), coefficients), 1.0);
}`,
  });
  return { version: three.REVISION, probe: draw(new three.MeshLambertMaterial(), light), kernel: draw(own) };
};

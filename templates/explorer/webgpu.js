// Draws in WebGPU: the same interface as webgl.js. It knows nothing of the page.

import { cut, stripOf } from "./webgl.js";

const ATTRIBUTES = [["float32x3", 0], ["float32x3", 12], ["float32x4", 24], ["float32x2", 40]];
const FLOAT = "rgba32float";
const DEPTH = "depth24plus";
/** What is seen goes through memory, not over a WebGPU canvas: software drivers lose the device there. */
const SEEN = "rgba8unorm";

/** Opens WebGPU, or throws with a reason that a person can read. `files` gives a shader's text by its name. */
export async function open(files) {
  if (!navigator.gpu) throw new Error("This browser has no WebGPU.");
  const adapter = await navigator.gpu.requestAdapter({ powerPreference: "high-performance" });
  if (!adapter) throw new Error("WebGPU has no adapter here.");
  const device = await adapter.requestDevice();
  const { TEXTURE_BINDING, COPY_DST, COPY_SRC, RENDER_ATTACHMENT } = GPUTextureUsage;
  const { FRAGMENT, VERTEX } = GPUShaderStage;

  async function module(name) {
    const made = device.createShaderModule({ code: await files(`${name}.wgsl`) });
    const { messages } = await made.getCompilationInfo();
    const errors = messages.filter(({ type }) => type === "error");
    if (errors.length) throw new Error(`A shader does not compile: ${errors[0].message}`);
    return made;
  }

  const unfilterable = (binding, visibility = FRAGMENT) => ({ binding, visibility, texture: { sampleType: "unfilterable-float" } });
  const filterable = (binding) => ({ binding, visibility: FRAGMENT, texture: { sampleType: "float" } });
  const sampled = (binding) => ({ binding, visibility: FRAGMENT, sampler: {} });
  const uniform = (binding, visibility) => ({ binding, visibility, buffer: { type: "uniform" } });
  const layouts = {
    shade: [uniform(0, VERTEX | FRAGMENT), filterable(1), sampled(2), uniform(3, FRAGMENT), unfilterable(4)],
    display: [uniform(0, FRAGMENT), unfilterable(1), unfilterable(2), filterable(3), sampled(4), unfilterable(5)],
    check: [unfilterable(0)],
  };
  for (const [name, entries] of Object.entries(layouts)) {
    const group = device.createBindGroupLayout({ entries });
    layouts[name] = { group, pipeline: device.createPipelineLayout({ bindGroupLayouts: [group] }) };
  }

  async function pipeline(name, layout, target, buffers, depthStencil) {
    const code = await module(name);
    return device.createRenderPipelineAsync({
      layout: layouts[layout].pipeline,
      vertex: { module: code, entryPoint: "vertex", buffers },
      fragment: { module: code, entryPoint: "fragment", targets: [{ format: target }] },
      primitive: { topology: "triangle-list" },
      depthStencil,
    });
  }

  const vertexBuffers = [{
    arrayStride: 48,
    attributes: ATTRIBUTES.map(([kind, offset], shaderLocation) => ({ format: kind, offset, shaderLocation })),
  }];
  const display = await pipeline("display", "display", SEEN, []);
  const repeated = device.createSampler({
    addressModeU: "repeat", addressModeV: "repeat", magFilter: "linear", minFilter: "linear", mipmapFilter: "linear",
  });
  const around = device.createSampler({ addressModeU: "repeat", magFilter: "linear", minFilter: "linear" });
  const buffer = (size, usage) => device.createBuffer({ size, usage: usage | GPUBufferUsage.COPY_DST });
  const cameraBuffer = buffer(80, GPUBufferUsage.UNIFORM);
  const displayBuffer = buffer(224, GPUBufferUsage.UNIFORM);
  const sumBuffer = buffer(32, GPUBufferUsage.UNIFORM);
  const programs = new Map();
  let mesh, normals, environment, views, light, lights, groups;
  /** What the picture of all bands in its target shows. */
  let summed = null;
  let targets = { width: 0, height: 0, all: [], depth: null };
  let seen = null;

  function upload(texture, levels, width, height, bytes) {
    levels.forEach((data, mipLevel) => {
      const size = [Math.max(width >> mipLevel, 1), Math.max(height >> mipLevel, 1)];
      device.queue.writeTexture({ texture, mipLevel }, data, { bytesPerRow: bytes * size[0] }, size);
    });
    return texture;
  }

  function textureOf(old, form, width, height, levels, bytes) {
    old?.destroy();
    groups = null;
    const usage = TEXTURE_BINDING | COPY_DST;
    const texture = device.createTexture({ size: [width, height], format: form, usage, mipLevelCount: levels.length });
    return upload(texture, levels, width, height, bytes);
  }

  function bufferOf(old, data, usage) {
    old?.destroy();
    const made = buffer(data.byteLength, usage);
    device.queue.writeBuffer(made, 0, data);
    return made;
  }

  function resize(width, height) {
    if (targets.width === width && targets.height === height) return;
    [...targets.all, targets.depth].forEach((texture) => texture?.destroy());
    const made = (kind, usage) => device.createTexture({ size: [width, height], format: kind, usage: usage | RENDER_ATTACHMENT });
    const colour = () => made(FLOAT, TEXTURE_BINDING | COPY_SRC);
    targets = { width, height, all: [colour(), colour(), colour()], depth: made(DEPTH, 0) };
    groups = null;
    summed = null;
  }

  const bind = (layout, resources) => device.createBindGroup({
    layout: layouts[layout].group,
    entries: resources.map((resource, binding) => ({ binding, resource })),
  });

  /** What the passes bind; made again when a texture is replaced. */
  function bound() {
    groups ??= {
      shade: bind("shade", [{ buffer: cameraBuffer }, normals.createView(), repeated, { buffer: light }, views.createView()]),
      display: bind("display", [
        { buffer: displayBuffer }, targets.all[0].createView(), targets.all[1].createView(), environment.createView(), around,
        targets.all[2].createView(),
      ]),
      sum: bind("shade", [{ buffer: cameraBuffer }, normals.createView(), repeated, { buffer: sumBuffer }, lights.createView()]),
    };
    return groups;
  }

  /** One picture's radiance into a target; only some rows of it, if they are given. */
  function shade(encoder, place, program, group = bound().shade, rows = null) {
    const pass = encoder.beginRenderPass({
      colorAttachments: [{
        view: targets.all[place].createView(), loadOp: rows?.[0] ? "load" : "clear", storeOp: "store", clearValue: [0, 0, 0, 0],
      }],
      depthStencilAttachment: { view: targets.depth.createView(), depthClearValue: 1, depthLoadOp: "clear", depthStoreOp: "discard" },
    });
    if (rows) pass.setScissorRect(0, rows[0], targets.width, rows[1]);
    pass.setPipeline(program);
    pass.setBindGroup(0, group);
    pass.setVertexBuffer(0, mesh.vertices);
    pass.setIndexBuffer(mesh.indices, "uint32");
    pass.drawIndexed(mesh.count);
    pass.end();
  }

  /** The radiance of all bands into target 2, if it is not there yet: in strips, so that none takes a driver too long. */
  function sum(frame) {
    const { key, brdf, range } = frame.all;
    if (summed === key) return;
    device.queue.writeBuffer(sumBuffer, 0, new Float32Array([...brdf, 0, ...range, 0, 0]));
    const rows = stripOf(targets.width, range[1]);
    for (let y = 0; y < targets.height; y += rows) {
      const encoder = device.createCommandEncoder();
      shade(encoder, 2, frame.programs.all, bound().sum, [y, Math.min(rows, targets.height - y)]);
      device.queue.submit([encoder.finish()]);
    }
    summed = key;
  }

  function writeCamera({ camera, strength }) {
    device.queue.writeBuffer(cameraBuffer, 0, new Float32Array([...camera.clip, ...camera.eye, strength]));
  }

  /** The bytes of a texture, row by row. */
  async function readBack(texture, bytesPerTexel) {
    const { width, height } = texture;
    const bytesPerRow = Math.ceil((bytesPerTexel * width) / 256) * 256;
    const copy = buffer(bytesPerRow * height, GPUBufferUsage.MAP_READ);
    const encoder = device.createCommandEncoder();
    encoder.copyTextureToBuffer({ texture }, { buffer: copy, bytesPerRow }, [width, height]);
    device.queue.submit([encoder.finish()]);
    await copy.mapAsync(GPUMapMode.READ);
    const bytes = cut(new Uint8ClampedArray(copy.getMappedRange()), bytesPerRow, bytesPerTexel * width, height);
    copy.destroy();
    return bytes;
  }

  const readFloats = async (texture) => new Float32Array((await readBack(texture, 16)).buffer);

  const { vendor, architecture, description } = adapter.info ?? {};
  return {
    api: "webgpu",
    adapter: description || [vendor, architecture].filter(Boolean).join(" ") || "WebGPU",

    setMesh({ vertices, indices }) {
      mesh = {
        vertices: bufferOf(mesh?.vertices, vertices, GPUBufferUsage.VERTEX),
        indices: bufferOf(mesh?.indices, indices, GPUBufferUsage.INDEX),
        count: indices.length,
      };
    },

    setNormals({ width, height, levels }) {
      normals = textureOf(normals, "rgba8unorm", width, height, levels, 4);
    },

    setEnvironment({ width, height, texels }) {
      environment = textureOf(environment, "rgb9e5ufloat", width, height, [texels], 4);
    },

    setViews({ width, height, texels }) {
      views = textureOf(views, FLOAT, width, height, [texels], 16);
    },

    setLight(values) {
      light = bufferOf(light, values, GPUBufferUsage.UNIFORM);
      groups = null;
    },

    setLights({ width, height, texels }) {
      lights = textureOf(lights, FLOAT, width, height, [texels], 16);
    },

    /** A program by the name of its shader, compiled once. */
    program(name) {
      const depthStencil = { format: DEPTH, depthWriteEnabled: true, depthCompare: "less" };
      if (!programs.has(name)) {
        programs.set(name, pipeline(name, "shade", FLOAT, vertexBuffers, depthStencil));
        programs.get(name).catch(() => programs.delete(name));
      }
      return programs.get(name);
    },

    /** Draws the four pictures, each on a canvas of its own, by their 2D contexts. */
    async draw(frame, contexts) {
      const { width, height, samples, camera } = frame;
      resize(width * samples, height * samples);
      if (seen?.width !== 4 * width || seen.height !== height) {
        seen?.destroy();
        seen = device.createTexture({ size: [4 * width, height], format: SEEN, usage: RENDER_ATTACHMENT | COPY_SRC });
      }
      writeCamera(frame);
      const numbers = new Float32Array(56);
      [camera.right, camera.up, camera.back, ...frame.ramp].forEach((vector, i) => numbers.set(vector, 4 * i));
      numbers.set([width, height, frame.exposure, frame.unit], 48);
      new Int32Array(numbers.buffer).set([samples, frame.against], 52);
      numbers[54] = frame.limit;
      device.queue.writeBuffer(displayBuffer, 0, numbers);
      sum(frame);
      const encoder = device.createCommandEncoder();
      shade(encoder, 0, frame.programs.chosen);
      shade(encoder, 1, frame.programs.exact);
      const pass = encoder.beginRenderPass({ colorAttachments: [{ view: seen.createView(), loadOp: "clear", storeOp: "store" }] });
      pass.setPipeline(display);
      pass.setBindGroup(0, bound().display);
      pass.draw(3);
      pass.end();
      device.queue.submit([encoder.finish()]);
      const image = new ImageData(await readBack(seen, 4), 4 * width, height);
      contexts.forEach((context, i) => context.putImageData(image, -i * width, 0, i * width, 0, width, height));
    },

    /** The radiance of the chosen picture, of the exact one and of all bands, as last drawn. */
    read() {
      return Promise.all(targets.all.map(readFloats));
    },

    /** Shades a picture again, `times` times, and waits until that is done. */
    async repeat(which, frame, times) {
      writeCamera(frame);
      const encoder = device.createCommandEncoder();
      for (let i = 0; i < times; i++) shade(encoder, which === "exact" ? 1 : 0, frame.programs[which]);
      device.queue.submit([encoder.finish()]);
      await device.queue.onSubmittedWorkDone();
    },

    /** Runs a kernel's check on `count` rows of inputs; gives `outputs` numbers a row. */
    async check(name, count, inputs, outputs) {
      const made = await pipeline(`check-${name}`, "check", FLOAT, []);
      const [rows, columns] = [inputs.length / 4 / count, Math.ceil(outputs / 4)];
      const source = device.createTexture({ size: [rows, count], format: FLOAT, usage: TEXTURE_BINDING | COPY_DST });
      upload(source, [inputs], rows, count, 16);
      const result = device.createTexture({ size: [columns, count], format: FLOAT, usage: RENDER_ATTACHMENT | COPY_SRC });
      const encoder = device.createCommandEncoder();
      const pass = encoder.beginRenderPass({ colorAttachments: [{ view: result.createView(), loadOp: "clear", storeOp: "store" }] });
      pass.setPipeline(made);
      pass.setBindGroup(0, bind("check", [source.createView()]));
      pass.draw(3);
      pass.end();
      device.queue.submit([encoder.finish()]);
      const numbers = await readFloats(result);
      [source, result].forEach((texture) => texture.destroy());
      return cut(numbers, 4 * columns, outputs, count);
    },

    /** Calls back with a reason if the device is lost. */
    onLost(call) {
      device.lost.then(({ reason }) => reason !== "destroyed" && call("the graphics driver gave WebGPU up"));
    },

    close() {
      device.destroy();
    },
  };
}

// Runs one shader text over many inputs, as WebGPU or as WebGL2. A job names the text, how many cases there are, how
// many vectors of four numbers a case takes and gives, and how many of them a pixel gives in WebGL2. It is fetched from
// the server with its numbers, and what comes out is sent back there, so that no number is ever written as text. What a
// compiler refuses is thrown with its message.

const FLOATS = 4;
const BYTES = 4 * FLOATS;
/** What the compute shader's `@workgroup_size` says. */
const GROUP = 64;

const adapter = await navigator.gpu?.requestAdapter();
const device = await adapter?.requestDevice();
const gl = document.createElement("canvas").getContext("webgl2");
const hasFloatTargets = gl?.getExtension("EXT_color_buffer_float");

/** What computes: a name for each language. */
export function names() {
  if (!device) throw new Error("The browser has no WebGPU adapter");
  if (!hasFloatTargets) throw new Error("The browser has no WebGL2 with float targets");
  const debug = gl.getExtension("WEBGL_debug_renderer_info");
  return {
    wgsl: `${adapter.info.vendor} ${adapter.info.architecture}`,
    glsl: gl.getParameter(debug ? debug.UNMASKED_RENDERER_WEBGL : gl.RENDERER),
  };
}

async function webgpu(job, numbers) {
  device.pushErrorScope("validation");
  const module = device.createShaderModule({ code: job.text });
  const errors = (await module.getCompilationInfo()).messages.filter((message) => message.type === "error");
  if (errors.length > 0) throw new Error(errors.map((error) => `${error.lineNum}: ${error.message}`).join("\n"));
  const pipeline = await device.createComputePipelineAsync({ layout: "auto", compute: { module, entryPoint: "main" } });
  const { STORAGE, COPY_SRC, COPY_DST, MAP_READ } = GPUBufferUsage;
  const size = job.count * job.outputs * BYTES;
  const inputs = device.createBuffer({ size: numbers.byteLength, usage: STORAGE | COPY_DST });
  const outputs = device.createBuffer({ size, usage: STORAGE | COPY_SRC });
  const read = device.createBuffer({ size, usage: MAP_READ | COPY_DST });
  device.queue.writeBuffer(inputs, 0, numbers);
  const entries = [inputs, outputs].map((buffer, binding) => ({ binding, resource: { buffer } }));
  const encoder = device.createCommandEncoder();
  const pass = encoder.beginComputePass();
  pass.setPipeline(pipeline);
  pass.setBindGroup(0, device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries }));
  pass.dispatchWorkgroups(job.count / GROUP);
  pass.end();
  encoder.copyBufferToBuffer(outputs, 0, read, 0, size);
  device.queue.submit([encoder.finish()]);
  await read.mapAsync(GPUMapMode.READ);
  const result = read.getMappedRange().slice(0);
  [inputs, outputs, read].forEach((buffer) => buffer.destroy());
  const error = await device.popErrorScope();
  if (error) throw new Error(error.message);
  return result;
}

function compiled(kind, text) {
  const shader = gl.createShader(kind);
  gl.shaderSource(shader, text);
  gl.compileShader(shader);
  if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
  return shader;
}

/** One triangle over the whole target. */
const VERTEX = `#version 300 es
void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }`;

function texture(width, height, numbers) {
  const made = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, made);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, width, height, 0, gl.RGBA, gl.FLOAT, numbers);
  return made;
}

/** A row of pixels is a case; a column is as many vectors of its result as there are targets. */
function webgl2(job, numbers) {
  const program = gl.createProgram();
  const shaders = [compiled(gl.VERTEX_SHADER, VERTEX), compiled(gl.FRAGMENT_SHADER, job.text)];
  shaders.forEach((shader) => gl.attachShader(program, shader));
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  const count = job.targets;
  const width = Math.ceil(job.outputs / count);
  const targets = Array.from({ length: count }, () => texture(width, job.count, null));
  const places = targets.map((_, i) => gl.COLOR_ATTACHMENT0 + i);
  const framebuffer = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
  targets.forEach((target, i) => gl.framebufferTexture2D(gl.FRAMEBUFFER, places[i], gl.TEXTURE_2D, target, 0));
  gl.drawBuffers(places);
  const inputs = texture(job.inputs, job.count, new Float32Array(numbers));
  gl.viewport(0, 0, width, job.count);
  gl.useProgram(program);
  gl.drawArrays(gl.TRIANGLES, 0, 3);
  const result = new Float32Array(job.outputs * job.count * FLOATS);
  const part = new Float32Array(width * job.count * FLOATS);
  places.forEach((place, i) => {
    gl.readBuffer(place);
    gl.readPixels(0, 0, width, job.count, gl.RGBA, gl.FLOAT, part);
    for (let y = 0; y < job.count; y++) {
      for (let vector = i, x = 0; vector < job.outputs; vector += count, x++) {
        const from = (y * width + x) * FLOATS;
        result.set(part.subarray(from, from + FLOATS), (y * job.outputs + vector) * FLOATS);
      }
    }
  });
  const error = gl.getError();
  gl.deleteFramebuffer(framebuffer);
  [...targets, inputs].forEach((made) => gl.deleteTexture(made));
  shaders.forEach((shader) => gl.deleteShader(shader));
  gl.deleteProgram(program);
  if (error !== gl.NO_ERROR) throw new Error(`WebGL2 reports error ${error}`);
  return result.buffer;
}

/** Runs the job that the server has. */
export async function run() {
  const [job, numbers] = await Promise.all([
    fetch("/job").then((answer) => answer.json()),
    fetch("/inputs").then((answer) => answer.arrayBuffer()),
  ]);
  const result = await { wgsl: webgpu, glsl: webgl2 }[job.language](job, numbers);
  // Bytes that are not a blob would be told to the browser's driver as text, which takes longer than computing them.
  await fetch("/outputs", { method: "POST", body: new Blob([result]) });
}

// Draws in WebGL2: the same interface as webgpu.js. It knows nothing of the page.

/** The attributes of a vertex: how many numbers, from which on; twelve in all. */
const ATTRIBUTES = [[3, 0], [3, 3], [4, 6], [2, 10]];

/** How many rows of a picture are drawn at once where each pixel adds up so many lights. */
export const stripOf = (width, lights) => Math.max(1, Math.floor(2 ** 27 / (width * Math.max(lights, 1))));

/** Opens WebGL2, or throws with a reason that a person can read. `files` gives a shader's text by its name. */
export async function open(files) {
  const canvas = document.createElement("canvas");
  const gl = canvas.getContext("webgl2", { alpha: false, antialias: false, depth: false, powerPreference: "high-performance" });
  if (!gl) throw new Error("WebGL2 is not to be had in this browser.");
  if (!gl.getExtension("EXT_color_buffer_float")) throw new Error("WebGL2 cannot draw into floating-point textures here.");
  const parallel = gl.getExtension("KHR_parallel_shader_compile");
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const vertex = await files("vertex.vert");

  async function link(vertexText, fragmentText) {
    const program = gl.createProgram();
    const shaders = [[gl.VERTEX_SHADER, vertexText], [gl.FRAGMENT_SHADER, fragmentText]].map(([kind, text]) => {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
      return shader;
    });
    gl.linkProgram(program);
    while (parallel && !gl.isContextLost() && !gl.getProgramParameter(program, parallel.COMPLETION_STATUS_KHR)) {
      await new Promise((done) => setTimeout(done, 8));
    }
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
      const logs = [...shaders.map((shader) => gl.getShaderInfoLog(shader)), gl.getProgramInfoLog(program)];
      throw new Error(`A shader does not compile: ${logs.filter(Boolean).join(" ")}`);
    }
    shaders.forEach((shader) => gl.deleteShader(shader));
    const uniforms = {};
    for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); i++) {
      const { name } = gl.getActiveUniform(program, i);
      uniforms[name.replace("[0]", "")] = gl.getUniformLocation(program, name);
    }
    return { program, uniforms };
  }

  const FULL = "#version 300 es\nvoid main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }\n";
  const display = await link(FULL, await files("display.frag"));
  const programs = new Map();
  const texture = (filter, wrap) => {
    const made = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, made);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, filter);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, filter === gl.LINEAR_MIPMAP_LINEAR ? gl.LINEAR : filter);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, wrap);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, wrap === gl.REPEAT && filter === gl.LINEAR ? gl.CLAMP_TO_EDGE : wrap);
    return made;
  };
  const normals = texture(gl.LINEAR_MIPMAP_LINEAR, gl.REPEAT);
  const views = texture(gl.NEAREST, gl.CLAMP_TO_EDGE);
  const environment = texture(gl.LINEAR, gl.REPEAT);
  const lights = texture(gl.NEAREST, gl.CLAMP_TO_EDGE);
  const empty = gl.createVertexArray();
  let mesh = null;
  let light = new Float32Array(0);
  let targets = { width: 0, height: 0, all: [] };
  /** What the picture of all bands in its target shows. */
  let summed = null;

  function target(width, height) {
    const framebuffer = gl.createFramebuffer();
    const colour = texture(gl.NEAREST, gl.CLAMP_TO_EDGE);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, width, height);
    const depth = gl.createRenderbuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, depth);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, width, height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, colour, 0);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, depth);
    return { framebuffer, colour, depth };
  }

  function free({ framebuffer, colour, depth }) {
    gl.deleteFramebuffer(framebuffer);
    gl.deleteTexture(colour);
    gl.deleteRenderbuffer(depth);
  }

  function resize(width, height) {
    if (targets.width === width && targets.height === height) return;
    targets.all.forEach(free);
    targets = { width, height, all: [0, 1, 2].map(() => target(width, height)) };
    summed = null;
  }

  function bind(unit, bound, location) {
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, bound);
    gl.uniform1i(location, unit);
  }

  /** The object into a target, by a program whose own uniforms `own` sets. */
  function render(place, { program, uniforms }, frame, own) {
    gl.bindFramebuffer(gl.FRAMEBUFFER, targets.all[place].framebuffer);
    gl.viewport(0, 0, targets.width, targets.height);
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.useProgram(program);
    gl.uniformMatrix4fv(uniforms.clip, false, frame.camera.clip);
    gl.uniform3fv(uniforms.eye, frame.camera.eye);
    gl.uniform1f(uniforms.strength, frame.strength);
    bind(0, normals, uniforms.normals);
    own(uniforms);
    gl.bindVertexArray(mesh.array);
    gl.drawElements(gl.TRIANGLES, mesh.count, gl.UNSIGNED_INT, 0);
  }

  /** One picture's radiance into target 0 or 1. */
  function shade(place, program, frame) {
    render(place, program, frame, (uniforms) => {
      gl.uniform4fv(uniforms.light, light);
      bind(1, views, uniforms.views);
    });
  }

  /** The radiance of all bands into target 2, if it is not there yet: in strips, so that none takes a driver too long. */
  function sum(frame) {
    const { key, brdf, range } = frame.all;
    if (summed === key) return;
    const rows = stripOf(targets.width, range[1]);
    gl.enable(gl.SCISSOR_TEST);
    for (let y = 0; y < targets.height; y += rows) {
      gl.scissor(0, y, targets.width, rows);
      render(2, frame.programs.all, frame, (uniforms) => {
        gl.uniform3fv(uniforms.brdf, brdf);
        gl.uniform2iv(uniforms.range, range);
        bind(1, lights, uniforms.lights);
      });
      gl.flush();
    }
    gl.disable(gl.SCISSOR_TEST);
    summed = key;
  }

  return {
    api: "webgl2",
    adapter: info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : gl.getParameter(gl.RENDERER),

    setMesh({ vertices, indices }) {
      if (mesh) {
        gl.deleteVertexArray(mesh.array);
        mesh.buffers.forEach((buffer) => gl.deleteBuffer(buffer));
      }
      const array = gl.createVertexArray();
      gl.bindVertexArray(array);
      const buffers = [[gl.ARRAY_BUFFER, vertices], [gl.ELEMENT_ARRAY_BUFFER, indices]].map(([kind, data]) => {
        const buffer = gl.createBuffer();
        gl.bindBuffer(kind, buffer);
        gl.bufferData(kind, data, gl.STATIC_DRAW);
        return buffer;
      });
      ATTRIBUTES.forEach(([count, offset], i) => {
        gl.enableVertexAttribArray(i);
        gl.vertexAttribPointer(i, count, gl.FLOAT, false, 48, 4 * offset);
      });
      gl.bindVertexArray(null);
      mesh = { array, buffers, count: indices.length };
    },

    setNormals({ width, height, levels }) {
      gl.bindTexture(gl.TEXTURE_2D, normals);
      levels.forEach((level, i) => {
        gl.texImage2D(gl.TEXTURE_2D, i, gl.RGBA8, Math.max(width >> i, 1), Math.max(height >> i, 1), 0, gl.RGBA, gl.UNSIGNED_BYTE, level);
      });
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAX_LEVEL, levels.length - 1);
    },

    setEnvironment({ width, height, texels }) {
      gl.bindTexture(gl.TEXTURE_2D, environment);
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB9_E5, width, height, 0, gl.RGB, gl.UNSIGNED_INT_5_9_9_9_REV, texels);
    },

    setViews({ width, height, texels }) {
      gl.bindTexture(gl.TEXTURE_2D, views);
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, width, height, 0, gl.RGBA, gl.FLOAT, texels);
    },

    setLight(values) {
      light = values;
    },

    setLights({ width, height, texels }) {
      gl.bindTexture(gl.TEXTURE_2D, lights);
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, width, height, 0, gl.RGBA, gl.FLOAT, texels);
    },

    /** A program by the name of its shader, compiled once. */
    program(name) {
      if (!programs.has(name)) {
        programs.set(name, files(`${name}.frag`).then((text) => link(vertex, text)));
        programs.get(name).catch(() => programs.delete(name));
      }
      return programs.get(name);
    },

    /** Draws the four pictures, each on a canvas of its own, by their 2D contexts. */
    async draw(frame, contexts) {
      const { width, height, samples } = frame;
      resize(width * samples, height * samples);
      if (canvas.width !== 4 * width || canvas.height !== height) [canvas.width, canvas.height] = [4 * width, height];
      shade(0, frame.programs.chosen, frame);
      shade(1, frame.programs.exact, frame);
      sum(frame);
      gl.bindFramebuffer(gl.FRAMEBUFFER, null);
      gl.viewport(0, 0, canvas.width, canvas.height);
      gl.disable(gl.DEPTH_TEST);
      const { program, uniforms } = display;
      gl.useProgram(program);
      ["right", "up", "back"].forEach((name) => gl.uniform3fv(uniforms[name], frame.camera[name]));
      gl.uniform3fv(uniforms.ramp, frame.ramp.flat());
      gl.uniform2f(uniforms.size, width, height);
      gl.uniform1f(uniforms.exposure, frame.exposure);
      gl.uniform1f(uniforms.unit, frame.unit);
      gl.uniform1i(uniforms.samples, samples);
      gl.uniform1i(uniforms.against, frame.against);
      gl.uniform1f(uniforms.limit, frame.limit);
      bind(0, targets.all[0].colour, uniforms.chosen);
      bind(1, targets.all[1].colour, uniforms.exact);
      bind(2, environment, uniforms.environment);
      bind(3, targets.all[2].colour, uniforms.every);
      gl.bindVertexArray(empty);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
      contexts.forEach((context, i) => context.drawImage(canvas, i * width, 0, width, height, 0, 0, width, height));
      // Frames must not pile up before a slow driver.
      const drawn = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
      gl.flush();
      while (gl.clientWaitSync(drawn, 0, 0) === gl.TIMEOUT_EXPIRED) await new Promise((done) => setTimeout(done, 4));
      gl.deleteSync(drawn);
    },

    /** The radiance of the chosen picture, of the exact one and of all bands, as last drawn. */
    async read() {
      return targets.all.map(({ framebuffer }) => {
        gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
        const pixels = new Float32Array(4 * targets.width * targets.height);
        gl.readPixels(0, 0, targets.width, targets.height, gl.RGBA, gl.FLOAT, pixels);
        return pixels;
      });
    },

    /** Shades a picture again, `times` times, and waits until that is done. */
    async repeat(which, frame, times) {
      for (let i = 0; i < times; i++) shade(which === "exact" ? 1 : 0, frame.programs[which], frame);
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.FLOAT, new Float32Array(4));
    },

    /** Runs a kernel's check on `count` rows of inputs; gives `outputs` numbers a row. */
    async check(name, count, inputs, outputs) {
      const { program, uniforms } = await link(FULL, await files(`check-${name}.frag`));
      const source = texture(gl.NEAREST, gl.CLAMP_TO_EDGE);
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, inputs.length / 4 / count, count, 0, gl.RGBA, gl.FLOAT, inputs);
      const columns = Math.ceil(outputs / 4);
      const made = target(columns, count);
      gl.viewport(0, 0, columns, count);
      gl.disable(gl.DEPTH_TEST);
      gl.useProgram(program);
      bind(0, source, uniforms.inputs);
      gl.bindVertexArray(empty);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
      const pixels = new Float32Array(4 * columns * count);
      gl.readPixels(0, 0, columns, count, gl.RGBA, gl.FLOAT, pixels);
      free(made);
      gl.deleteTexture(source);
      gl.deleteProgram(program);
      return cut(pixels, 4 * columns, outputs, count);
    },

    /** Calls back with a reason if the context is lost. */
    onLost(call) {
      canvas.addEventListener("webglcontextlost", () => call("the graphics driver gave WebGL2 up"), { once: true });
    },

    close() {
      gl.getExtension("WEBGL_lose_context")?.loseContext();
    },
  };
}

/** The first `wanted` numbers of every row of `stride`. */
export function cut(numbers, stride, wanted, rows) {
  const result = new numbers.constructor(wanted * rows);
  for (let row = 0; row < rows; row++) result.set(numbers.subarray(row * stride, row * stride + wanted), row * wanted);
  return result;
}

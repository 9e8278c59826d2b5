// Renders a shader into a float target, once per frame. `toyproof(job)` returns the pixels of all frames,
// bottom row first, or an error message and whether the context is lost. A job has a text and its language,
// the inputs and the sampling of channels, textures (their shapes, and levels of stacked layers), and frames:
// each has a size, the uniform block of converted shaders, and the numbers of its channels' textures. Where passes
// are played, or a module for three.js, a frame may start from the beginning.

const decodeBase64 = (base64) => Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));

function encodeBase64(floats) {
  const bytes = new Uint8Array(floats.buffer);
  let text = "";
  for (let at = 0; at < bytes.length; at += 8192) text += String.fromCharCode(...bytes.subarray(at, at + 8192));
  return btoa(text);
}

const gl = document.createElement("canvas").getContext("webgl2", { failIfMajorPerformanceCaveat: false });
const canRender = gl?.getExtension("EXT_color_buffer_float");
gl?.getExtension("OES_texture_float_linear");

const VERTICES = `#version 300 es
  void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }`;

function stage(kind, text) {
  const made = gl.createShader(kind);
  gl.shaderSource(made, text);
  gl.compileShader(made);
  if (!gl.getShaderParameter(made, gl.COMPILE_STATUS)) throw gl.getShaderInfoLog(made) ?? "context lost";
  return made;
}

function program(text) {
  const made = gl.createProgram();
  gl.attachShader(made, stage(gl.VERTEX_SHADER, VERTICES));
  gl.attachShader(made, stage(gl.FRAGMENT_SHADER, text));
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw gl.getProgramInfoLog(made) ?? "context lost";
  return made;
}

// Sets the inputs as separate uniforms, as ShaderToy has them, or as the block of converted shaders,
// whichever the program declares.
function feed(made, inputs, block, channels) {
  const at = (name) => gl.getUniformLocation(made, name);
  const floats = new Float32Array(block.buffer);
  for (const { name, isInteger, components, length, word } of inputs) {
    if (isInteger) {
      gl.uniform1i(at(name), new Int32Array(block.buffer)[word]);
      continue;
    }
    // Elements of arrays are 4 words apart.
    const values = Array.from({ length }, (_, at) => [...floats.subarray(word + 4 * at, word + 4 * at + components)]);
    gl[`uniform${components}fv`](at(name), values.flat());
  }
  if (gl.getProgramParameter(made, gl.ACTIVE_UNIFORM_BLOCKS)) {
    gl.uniformBlockBinding(made, 0, 0);
    gl.bindBuffer(gl.UNIFORM_BUFFER, gl.createBuffer());
    gl.bufferData(gl.UNIFORM_BUFFER, block, gl.STATIC_DRAW);
    gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, gl.getParameter(gl.UNIFORM_BUFFER_BINDING));
  }
  const resolutions = inputs.find(({ name }) => name === "iChannelResolution").word;
  channels.forEach(({ target, made }, number) => {
    gl.activeTexture(gl.TEXTURE0 + number);
    gl.bindTexture(target, made);
    gl.uniform1i(at(`iChannel${number}`), number);
    const size = floats.subarray(resolutions + 4 * number, resolutions + 4 * number + 3);
    gl.uniform1i(at(`iCh${number}.sampler`), number);
    gl.uniform3fv(at(`iCh${number}.size`), size);
    gl.uniform1i(at(`iCh${number}.loaded`), size[0] > 0 ? 1 : 0);
    gl.uniform1i(at(`_group_0_binding_${1 + 2 * number}_fs`), number);
  });
}

// Makes a texture for a channel that samples it so.
function makeTexture({ shape, levels }, { filter, repeats }) {
  const target = { flat: gl.TEXTURE_2D, cube: gl.TEXTURE_CUBE_MAP, volume: gl.TEXTURE_3D }[shape];
  const minification = { nearest: gl.NEAREST, linear: gl.LINEAR, mipmap: gl.LINEAR_MIPMAP_LINEAR }[filter];
  const wrap = repeats ? gl.REPEAT : gl.CLAMP_TO_EDGE;
  const made = gl.createTexture();
  gl.activeTexture(gl.TEXTURE0);
  gl.bindTexture(target, made);
  levels.forEach((level, at) => upload(target, level, at));
  gl.texParameteri(target, gl.TEXTURE_MAX_LEVEL, levels.length - 1);
  gl.texParameteri(target, gl.TEXTURE_MIN_FILTER, minification);
  gl.texParameteri(target, gl.TEXTURE_MAG_FILTER, filter === "nearest" ? gl.NEAREST : gl.LINEAR);
  for (const axis of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R]) gl.texParameteri(target, axis, wrap);
  gl.bindTexture(target, null);
  return { target, made };
}

// Sets a level of the bound texture.
function upload(target, { width, height, layers, floats }, level) {
  const set = (face, texels) =>
    gl.texImage2D(face, level, gl.RGBA32F, width, height, 0, gl.RGBA, gl.FLOAT, texels);
  if (target === gl.TEXTURE_3D) {
    gl.texImage3D(target, level, gl.RGBA32F, width, height, layers, 0, gl.RGBA, gl.FLOAT, floats);
  } else if (target === gl.TEXTURE_CUBE_MAP) {
    const length = 4 * width * height;
    for (let face = 0; face < layers; face++) {
      set(gl.TEXTURE_CUBE_MAP_POSITIVE_X + face, floats.subarray(length * face, length * (face + 1)));
    }
  } else {
    set(target, floats);
  }
}

function renderGlsl(text, inputs, sampling, textures, frames) {
  if (!canRender) throw "WebGL 2 with EXT_color_buffer_float is not available";
  const made = program(text);
  gl.useProgram(made);
  const uploaded = sampling.map(() => []);
  const images = frames.map(({ width, height, block, channels }) => {
    const target = gl.createTexture();
    gl.activeTexture(gl.TEXTURE7);
    gl.bindTexture(gl.TEXTURE_2D, target);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, width, height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target, 0);
    gl.bindTexture(gl.TEXTURE_2D, null);
    gl.viewport(0, 0, width, height);
    const bound = channels.map((texture, number) =>
      (uploaded[number][texture] ??= makeTexture(textures[texture], sampling[number])));
    feed(made, inputs, block, bound);
    gl.clearColor(0, 0, 0, 0.5);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    const pixels = new Float32Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, pixels);
    gl.deleteTexture(target);
    return pixels;
  });
  gl.deleteProgram(made);
  for (const { made } of uploaded.flat()) gl.deleteTexture(made);
  if (gl.isContextLost()) throw "the WebGL context was lost";
  return images;
}

let device;

async function openDevice() {
  const adapter = await navigator.gpu?.requestAdapter();
  if (!adapter) throw "WebGPU is not available";
  const wanted = ["float32-filterable"].filter((feature) => adapter.features.has(feature));
  const made = await adapter.requestDevice({ requiredFeatures: wanted });
  made.lost.then(() => (device = undefined));
  return made;
}

// Makes a texture.
function deviceTexture({ shape, levels }) {
  const [{ width, height, layers }] = levels;
  const texture = device.createTexture({
    size: [width, height, layers],
    dimension: shape === "volume" ? "3d" : "2d",
    mipLevelCount: levels.length,
    format: "rgba32float",
    usage: GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST,
  });
  levels.forEach(({ width, height, layers, floats }, mipLevel) => {
    const layout = { bytesPerRow: 16 * width, rowsPerImage: height };
    device.queue.writeTexture({ texture, mipLevel }, floats, layout, [width, height, layers]);
  });
  return texture;
}

async function renderWgsl(text, sampling, textures, frames) {
  device ??= await openDevice();
  device.pushErrorScope("validation");
  const fragment = device.createShaderModule({ code: text });
  const firstError = (await fragment.getCompilationInfo()).messages.find((message) => message.type === "error");
  if (firstError) throw `line ${firstError.lineNum}: ${firstError.message}`;
  const vertex = device.createShaderModule({ code: `@vertex fn main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
  }` });
  const visibility = GPUShaderStage.FRAGMENT;
  const viewDimension = { flat: "2d", cube: "cube", volume: "3d" };
  const dimensions = frames[0].channels.map((texture) => viewDimension[textures[texture].shape]);
  const group = device.createBindGroupLayout({ entries: [
    { binding: 0, visibility, buffer: {} },
    ...sampling.flatMap((_, number) => [
      { binding: 1 + 2 * number, visibility, texture: { viewDimension: dimensions[number] } },
      { binding: 2 + 2 * number, visibility, sampler: {} },
    ]),
  ] });
  const pipeline = await device.createRenderPipelineAsync({
    layout: device.createPipelineLayout({ bindGroupLayouts: [group] }),
    vertex: { module: vertex },
    fragment: { module: fragment, targets: [{ format: "rgba32float" }] },
  });
  // Only mipmaps read other levels than the largest.
  const samplers = sampling.map(({ filter, repeats }) => device.createSampler({
    addressModeU: repeats ? "repeat" : "clamp-to-edge",
    addressModeV: repeats ? "repeat" : "clamp-to-edge",
    addressModeW: repeats ? "repeat" : "clamp-to-edge",
    magFilter: filter === "nearest" ? "nearest" : "linear",
    minFilter: filter === "nearest" ? "nearest" : "linear",
    mipmapFilter: filter === "mipmap" ? "linear" : "nearest",
    lodMaxClamp: filter === "mipmap" ? 32 : 0,
  }));
  const uploaded = textures.map(deviceTexture);
  const images = [];
  for (const { width, height, block, channels } of frames) {
    const uniforms = device.createBuffer({ size: block.length, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST });
    device.queue.writeBuffer(uniforms, 0, block);
    const bound = device.createBindGroup({ layout: group, entries: [
      { binding: 0, resource: { buffer: uniforms } },
      ...channels.flatMap((texture, number) => [
        { binding: 1 + 2 * number, resource: uploaded[texture].createView({ dimension: dimensions[number] }) },
        { binding: 2 + 2 * number, resource: samplers[number] },
      ]),
    ] });
    const target = device.createTexture({
      size: [width, height],
      format: "rgba32float",
      usage: GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC,
    });
    const stride = Math.ceil((16 * width) / 256) * 256;
    const rows = device.createBuffer({ size: stride * height, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
    const commands = device.createCommandEncoder();
    const pass = commands.beginRenderPass({
      colorAttachments: [{ view: target.createView(), loadOp: "clear", clearValue: [0, 0, 0, 0.5], storeOp: "store" }],
    });
    pass.setPipeline(pipeline);
    pass.setBindGroup(0, bound);
    pass.draw(3);
    pass.end();
    commands.copyTextureToBuffer({ texture: target }, { buffer: rows, bytesPerRow: stride }, [width, height]);
    device.queue.submit([commands.finish()]);
    await rows.mapAsync(GPUMapMode.READ);
    const pixels = new Float32Array(4 * width * height);
    for (let y = 0; y < height; y++) pixels.set(new Float32Array(rows.getMappedRange(stride * y, 16 * width)), 4 * width * y);
    images.push(pixels);
    for (const made of [uniforms, target, rows]) made.destroy();
  }
  for (const made of uploaded) made.destroy();
  const error = await device.popErrorScope();
  if (error) throw error.message;
  return images;
}

// The kind of a uniform's values, by its type.
const uniformKind = (type) => {
  const kinds = {
    f: [gl.FLOAT, gl.FLOAT_VEC2, gl.FLOAT_VEC3, gl.FLOAT_VEC4],
    i: [gl.INT, gl.INT_VEC2, gl.INT_VEC3, gl.INT_VEC4],
    ui: [gl.UNSIGNED_INT, gl.UNSIGNED_INT_VEC2, gl.UNSIGNED_INT_VEC3, gl.UNSIGNED_INT_VEC4],
    // Booleans are set by integers.
    b: [gl.BOOL, gl.BOOL_VEC2, gl.BOOL_VEC3, gl.BOOL_VEC4],
  };
  for (const [kind, types] of Object.entries(kinds)) {
    const at = types.indexOf(type);
    if (at >= 0) return { components: at + 1, kind: kind === "b" ? "i" : kind };
  }
  return null;
};

// Sets the uniforms that the author declares, apart from matrices. One value is that of all components.
function setUniforms(made, values) {
  gl.useProgram(made);
  for (let at = 0; at < gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS); at++) {
    const { name, type } = gl.getActiveUniform(made, at);
    const given = values.find((value) => value.name === name)?.components;
    const kind = uniformKind(type);
    if (!given || !kind) continue;
    const own = Array.from({ length: kind.components }, (_, component) => given[component] ?? given[0]);
    gl[`uniform${kind.components}${kind.kind}v`](gl.getUniformLocation(made, name), own);
  }
}

// Opens a player of the passes of a shader with WebGL 2, which renders as ShaderToy does, frame after frame. A pass has
// a text, a target, the values of uniforms that its author declares, the sampling of its channels, and what they read:
// a buffer, a texture, or the keyboard.
function openPasses(passes, inputs, textures) {
  if (!canRender) throw "WebGL 2 with EXT_color_buffer_float is not available";
  const programs = passes.map(({ text }) => program(text));
  passes.forEach(({ uniforms }, at) => setUniforms(programs[at], uniforms));
  const resolutions = inputs.find(({ name }) => name === "iChannelResolution").word;
  const framebuffer = gl.createFramebuffer();
  let made = [];
  let buffers;
  const target = (width, height, levels) => {
    const texture = gl.createTexture();
    gl.activeTexture(gl.TEXTURE7);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, levels, gl.RGBA32F, width, height);
    gl.bindTexture(gl.TEXTURE_2D, null);
    made.push(texture);
    return texture;
  };
  const set = ({ filter, repeats }) => {
    const minification = { nearest: gl.NEAREST, linear: gl.LINEAR, mipmap: gl.LINEAR_MIPMAP_LINEAR }[filter];
    const sampler = gl.createSampler();
    gl.samplerParameteri(sampler, gl.TEXTURE_MIN_FILTER, minification);
    gl.samplerParameteri(sampler, gl.TEXTURE_MAG_FILTER, filter === "nearest" ? gl.NEAREST : gl.LINEAR);
    for (const axis of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) {
      gl.samplerParameteri(sampler, axis, repeats ? gl.REPEAT : gl.CLAMP_TO_EDGE);
    }
    return sampler;
  };
  const samplers = passes.map(({ sampling }) => sampling.map(set));
  const uploaded = textures.map((texture) => makeTexture(texture, { filter: "nearest", repeats: false }));
  const keyboard = { target: gl.TEXTURE_2D, made: gl.createTexture() };
  const [keyColumns, keyRows] = [256, 3];
  const resize = (width, height) => {
    for (const texture of made) gl.deleteTexture(texture);
    made = [];
    const levels = 32 - Math.clz32(Math.max(width, height));
    const pair = (mipmaps) => ({ last: 0, sides: [0, 1].map(() => target(width, height, mipmaps ? levels : 1)) });
    buffers = Object.fromEntries(passes.map(({ target: name, mipmaps }) => [name, pair(mipmaps)]));
    // A buffer that no pass renders stays zero.
    for (const { buffer } of passes.flatMap(({ reads }) => reads)) if (buffer) buffers[buffer] ??= pair(false);
    // The image has one texture: discarded pixels keep the color of the last frame.
    if (buffers.image) buffers.image.sides[1] = buffers.image.sides[0];
  };
  // Renders a frame; returns the pixels of a pass, else of the last one. `keys` are the texels of the keyboard, if
  // passes read it.
  const render = ({ width, height, block, restarts, keys, shown }) => {
    if (restarts) resize(width, height);
    if (keys) {
      gl.activeTexture(gl.TEXTURE7);
      gl.bindTexture(gl.TEXTURE_2D, keyboard.made);
      upload(gl.TEXTURE_2D, { width: keyColumns, height: keyRows, floats: keys }, 0);
      gl.bindTexture(gl.TEXTURE_2D, null);
    }
    passes.forEach(({ target: name, mipmaps, reads }, at) => {
      const bound = reads.map((read) => {
        if (read.texture !== undefined) return uploaded[read.texture];
        if (read.keyboard) return keyboard;
        const buffer = buffers[read.buffer];
        return { target: gl.TEXTURE_2D, made: buffer.sides[buffer.last] };
      });
      const floats = new Float32Array(block.buffer);
      reads.forEach((read, channel) => {
        const level = textures[read.texture]?.levels[0];
        const own = read.keyboard ? [keyColumns, keyRows, 1] : [level?.width ?? width, level?.height ?? height, 1];
        const size = read.isEmpty ? [0, 0, 0] : own;
        floats.set(size, resolutions + 4 * channel);
      });
      const buffer = buffers[name];
      buffer.last = 1 - buffer.last;
      gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
      const into = buffer.sides[buffer.last];
      gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, into, 0);
      gl.viewport(0, 0, width, height);
      gl.useProgram(programs[at]);
      feed(programs[at], inputs, block, bound);
      samplers[at].forEach((sampler, channel) => gl.bindSampler(channel, sampler));
      gl.drawArrays(gl.TRIANGLES, 0, 3);
      samplers[at].forEach((_, channel) => gl.bindSampler(channel, null));
      if (mipmaps) {
        gl.activeTexture(gl.TEXTURE7);
        gl.bindTexture(gl.TEXTURE_2D, into);
        gl.generateMipmap(gl.TEXTURE_2D);
        gl.bindTexture(gl.TEXTURE_2D, null);
      }
    });
    if (shown) {
      const { sides, last } = buffers[shown];
      gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, sides[last], 0);
    }
    const pixels = new Float32Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, pixels);
    if (gl.isContextLost()) throw "the WebGL context was lost";
    return pixels;
  };
  const close = () => {
    for (const made of programs) gl.deleteProgram(made);
    for (const sampler of samplers.flat()) gl.deleteSampler(sampler);
    for (const texture of [...made, keyboard.made]) gl.deleteTexture(texture);
    for (const { made } of uploaded) gl.deleteTexture(made);
    gl.deleteFramebuffer(framebuffer);
  };
  return { render, close };
}

// Plays the passes of a shader; returns the images of the last one.
function playGlsl(passes, inputs, textures, frames) {
  const player = openPasses(passes, inputs, textures);
  try {
    return frames.map((frame) => player.render(frame));
  } finally {
    player.close();
  }
}

const moduleUrl = (text) => URL.createObjectURL(new Blob([text], { type: "text/javascript" }));

// three.js, of which modules import `three`.
let three;

function loadThree({ main, core }) {
  const text = core ? main.replaceAll(/(["'])\.\/three\.core\.js\1/g, JSON.stringify(moduleUrl(core))) : main;
  const url = moduleUrl(text);
  const map = document.createElement("script");
  map.type = "importmap";
  map.textContent = JSON.stringify({ imports: { three: url } });
  document.head.append(map);
  return import(url);
}

// Renders the frames of a module that was written for three.js. `names` are those of the textures that it reads.
async function renderThree(library, module, inputs, names, textures, frames) {
  const THREE = await (three ??= loadThree(library));
  const { Shader } = await import(moduleUrl(module));
  const renderer = new THREE.WebGLRenderer({ canvas: document.createElement("canvas") });
  const read = {};
  let shader;
  let failure;
  renderer.debug.onShaderError = (gl, program, vertex, fragment) => {
    failure ??= gl.getShaderInfoLog(fragment) || gl.getProgramInfoLog(program) || "a shader does not compile";
  };
  const images = [];
  for (const { width, height, block, restarts } of frames) {
    if (restarts) {
      shader?.dispose();
      for (const [name, { number, sampling }] of Object.entries(names)) {
        const levels = textures[number].levels;
        const data = levels.map(({ floats, width, height }) => ({ data: floats, width, height }));
        const texture = new THREE.DataTexture(data[0].data, data[0].width, data[0].height, THREE.RGBAFormat, THREE.FloatType);
        texture.wrapS = texture.wrapT = sampling.repeats ? THREE.RepeatWrapping : THREE.ClampToEdgeWrapping;
        texture.magFilter = sampling.filter === "nearest" ? THREE.NearestFilter : THREE.LinearFilter;
        texture.minFilter = texture.magFilter;
        read[name] = texture;
        if (data.length > 1) texture.mipmaps = data;
      }
      shader = new Shader(renderer, read);
      for (const texture of Object.values(read)) {
        // The levels are given.
        texture.generateMipmaps = false;
        if (texture.mipmaps.length === 0) texture.minFilter = texture.magFilter;
        texture.needsUpdate = true;
      }
    }
    const floats = new Float32Array(block.buffer);
    const given = {};
    for (const { name, isInteger, components, length, word } of inputs) {
      // The module knows the sizes.
      if (name.endsWith("Resolution")) continue;
      const values = [...floats.subarray(word, word + components)];
      if (length > 1) given[name] = Array.from({ length }, (_, at) => floats[word + 4 * at]);
      else if (isInteger) given[name] = new Int32Array(block.buffer)[word];
      else given[name] = components === 1 ? values[0] : new THREE.Vector4(...values);
    }
    const target = new THREE.WebGLRenderTarget(width, height, {
      type: THREE.FloatType,
      minFilter: THREE.NearestFilter,
      magFilter: THREE.NearestFilter,
      depthBuffer: false,
    });
    const mouse = shader.inputs.iMouse.value.copy(given.iMouse);
    shader.update(given.iTime, { ...given, iMouse: mouse });
    shader.render(target);
    const pixels = new Float32Array(4 * width * height);
    renderer.readRenderTargetPixels(target, 0, 0, width, height, pixels);
    target.dispose();
    images.push(pixels);
  }
  const isLost = renderer.getContext().isContextLost();
  shader.dispose();
  renderer.dispose();
  renderer.forceContextLoss();
  if (failure) throw failure.replaceAll("\n", " ");
  if (isLost) throw "the WebGL context was lost";
  return images;
}

// Decodes the texels of the textures of a job.
function decodeTextures(textures) {
  for (const level of textures.flatMap(({ levels }) => levels)) {
    level.floats = new Float32Array(decodeBase64(level.pixels).buffer);
  }
}

async function toyproof({ language, text, inputs, sampling, textures, frames, passes, library, names }) {
  try {
    for (const frame of frames) frame.block = decodeBase64(frame.block);
    decodeTextures(textures);
    const images = {
      wgsl: () => renderWgsl(text, sampling, textures, frames),
      glsl: () => renderGlsl(text, inputs, sampling, textures, frames),
      passes: () => playGlsl(passes, inputs, textures, frames),
      three: () => renderThree(library, text, inputs, names, textures, frames),
    };
    return { images: (await images[language]()).map(encodeBase64) };
  } catch (error) {
    return { refused: String(error?.message ?? error), contextLost: gl?.isContextLost() ?? true };
  }
}

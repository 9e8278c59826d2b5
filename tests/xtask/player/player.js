// Renders projects of ShaderToy as the site's own page does, into float targets. `load(project, size, media)`
// compiles all tabs, `render(frame, films)` renders up to that frame, `pixels(pass)` returns what a pass has
// written, and `sound(blocks)` the samples of the Sound tab.
"use strict";

const FRAMES_PER_SECOND = 60;
const SAMPLE_RATE = 44100;
// The Sound tab is rendered in blocks of this size squared.
const SOUND_SIDE = 512;
const MAX_PASSES = 8;
const BUFFER_IDS = ["4dXGR8", "XsXGR8", "4sXGR8", "XdfGR8"];
// The number of Buffer A in files of the site's API.
const FIRST_BUFFER_NUMBER = 257;
const CUBE_A_ID = "4dX3Rr";
const CUBE_A_FILE = "cubemap00.png";
const CUBE_SIDE = 1024;

// The corners (0, 0), (1, 0), (1, 1) and (0, 1) of the faces +X -X +Y -Y +Z -Z of Cube A, and the origin.
const CORNERS = [
  [[1, 1, 1], [1, 1, -1], [1, -1, -1], [1, -1, 1]],
  [[-1, 1, -1], [-1, 1, 1], [-1, -1, 1], [-1, -1, -1]],
  [[-1, 1, -1], [1, 1, -1], [1, 1, 1], [-1, 1, 1]],
  [[-1, -1, 1], [1, -1, 1], [1, -1, -1], [-1, -1, -1]],
  [[-1, 1, 1], [1, 1, 1], [1, -1, 1], [-1, -1, 1]],
  [[1, 1, -1], [-1, 1, -1], [-1, -1, -1], [1, -1, -1]],
].map((face) => [...face.flat(), 0, 0, 0]);

const gl = document.createElement("canvas").getContext("webgl2", { antialias: false });
if (!gl?.getExtension("EXT_color_buffer_float") || !gl.getExtension("OES_texture_float_linear")) {
  throw new Error("WebGL 2 with float targets and their linear filter is not available");
}

// The project: all passes in the order of the file, and the buffers and Cube A if they name them.
let passes, size, buffers, cubeA, image, keyboard, media, nextFrame;

// ---- The project.

function bufferIndex({ id, src, filepath }) {
  const named = BUFFER_IDS.indexOf(id);
  if (named >= 0) return named;
  const numbered = Number(id) - FIRST_BUFFER_NUMBER;
  if (BUFFER_IDS[numbered]) return numbered;
  const previewed = /buffer0([0-3])\.png$/.exec(src ?? filepath ?? "");
  if (previewed) return Number(previewed[1]);
  throw `no buffer has the id ${id}`;
}

const wrapMode = (word) => (word === "clamp" ? gl.CLAMP_TO_EDGE : gl.REPEAT);

// The buffer with this index, which an input or an output names.
function buffer(index) {
  buffers[index] ??= { targets: [floatTarget(size), floatTarget(size)], last: 0 };
  return buffers[index];
}

const isCubeA = ({ id, src, filepath }) => id === CUBE_A_ID || (src ?? filepath ?? "").endsWith(CUBE_A_FILE);

function parseInput(input) {
  const kind = input.ctype ?? input.type;
  const sampler = input.sampler ?? {};
  if (kind === "buffer") return bufferInput(kind, bufferIndex(input), sampler);
  if (kind === "keyboard") return { kind };
  if (MUSIC_KINDS.includes(kind)) return { kind, texture: musicTexture() };
  if (kind === "cubemap" && isCubeA(input)) {
    cubeA ??= { targets: [cubeTarget(), cubeTarget()], last: 0 };
    return { kind, isCubeA: true, filter: sampler.filter };
  }
  return media[input.medium] ? mediumInput(kind, input.medium, sampler) : { kind };
}

function bufferInput(kind, index, { filter, wrap }) {
  // All inputs share the buffer's textures: the last one in the file decides how they wrap.
  for (const { texture } of buffer(index).targets) {
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, wrapMode(wrap));
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, wrapMode(wrap));
  }
  return { kind, index, filter };
}

function parsePass({ type: kind, code, inputs, outputs }) {
  const channels = [null, null, null, null];
  for (const input of inputs ?? []) channels[input.channel] = parseInput(input);
  const pass = { kind, code, channels, name: kind };
  if (kind === "buffer") {
    pass.output = bufferIndex(outputs?.[0] ?? {});
    pass.name = `buffer-${"abcd"[pass.output]}`;
    buffer(pass.output);
  }
  if (kind === "cubemap") {
    cubeA ??= { targets: [cubeTarget(), cubeTarget()], last: 0 };
    pass.name = "cube-a";
  }
  return pass;
}

// Whether some input that this holds for is filtered with mipmaps.
const wantsMipmaps = (isMeant) => passes.some(({ channels }) =>
  channels.some((channel) => channel?.filter === "mipmap" && isMeant(channel)));

function compileStage(program, kind, text) {
  const stage = gl.createShader(kind);
  gl.shaderSource(stage, text);
  gl.compileShader(stage);
  gl.attachShader(program, stage);
  return stage;
}

// Returns the program, or the messages of the compiler, whose lines are those of the tab.
function compile(pass, common) {
  const before = PRELUDE + header(pass) + (pass.kind === "common" ? "" : common);
  const program = gl.createProgram();
  compileStage(program, gl.VERTEX_SHADER, VERTICES);
  const fragment = compileStage(program, gl.FRAGMENT_SHADER, before + pass.code);
  gl.linkProgram(program);
  if (gl.getProgramParameter(program, gl.LINK_STATUS)) return { program };
  const linesBefore = before.split(/\r\n|\r|\n/).length - 1;
  const log = gl.getShaderInfoLog(fragment) || gl.getProgramInfoLog(program) || "context lost";
  return { log: log.replace(/^(ERROR|WARNING): 0:(\d+)/gm, (_, word, line) => `${word}: 0:${line - linesBefore}`) };
}

// Reads and compiles a project. Returns the names of its passes, and the error of each tab that does not
// compile: the site starts only if there is none. `newMedia` has what the names in `medium` of the inputs mean.
function load(project, newSize, newMedia) {
  [size, media, buffers, cubeA, nextFrame] = [newSize, newMedia, [], null, 0];
  if (Array.isArray(project)) [project] = project;
  const { ver, renderpass } = project?.Shader ?? project ?? {};
  try {
    if (ver !== "0.1") throw `the version is ${ver}`;
    if (!(renderpass?.length >= 1 && renderpass.length <= MAX_PASSES)) throw `the number of passes is ${renderpass?.length}`;
    passes = renderpass.map(parsePass);
    const common = passes.filter(({ kind }) => kind === "common").map(({ code }) => code + "\n").join("");
    for (const pass of passes) Object.assign(pass, compile(pass, common));
  } catch (error) {
    if (error instanceof Error) throw error;
    return { passes: [], errors: [{ pass: null, log: error }] };
  }
  if (gl.isContextLost()) throw new Error("the context was lost while compiling");
  image = floatTarget(size);
  clear(image, [0, 0, 0, 1]);
  for (const { targets } of buffers.filter(Boolean)) {
    for (const target of targets) {
      clear(target, [0, 0, 0, 0]);
      makeMipmaps(gl.TEXTURE_2D, target);
    }
  }
  for (const target of cubeA?.targets ?? []) {
    for (const framebuffer of target.framebuffers) clear({ framebuffer }, [0, 0, 0, 0]);
    makeMipmaps(gl.TEXTURE_CUBE_MAP, target);
  }
  keyboard = idleKeyboard();
  const errors = passes.filter(({ log }) => log).map(({ name, log }) => ({ pass: name, log }));
  const names = passes.filter(({ kind }) => kind !== "common" && kind !== "sound").map(({ name }) => name);
  return { passes: [...new Set(names)], errors };
}

// ---- Textures.

function floatTarget([width, height]) {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, width, height, 0, gl.RGBA, gl.FLOAT, null);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
  const framebuffer = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
  return { texture, framebuffer };
}

function cubeTarget() {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_CUBE_MAP, texture);
  const faces = CORNERS.map((_, face) => gl.TEXTURE_CUBE_MAP_POSITIVE_X + face);
  for (const face of faces) {
    gl.texImage2D(face, 0, gl.RGBA16F, CUBE_SIDE, CUBE_SIDE, 0, gl.RGBA, gl.FLOAT, null);
  }
  setFilter(gl.TEXTURE_CUBE_MAP, "linear");
  const framebuffers = faces.map((face) => {
    const framebuffer = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, face, texture, 0);
    return framebuffer;
  });
  return { texture, framebuffers };
}

function idleKeyboard() {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.R8, 256, 3, 0, gl.RED, gl.UNSIGNED_BYTE, new Uint8Array(256 * 3));
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
  setFilter(gl.TEXTURE_2D, "nearest");
  return texture;
}

// Sets the filter of the bound texture.
function setFilter(target, word) {
  const [magnified, minified] =
    { linear: [gl.LINEAR, gl.LINEAR], mipmap: [gl.LINEAR, gl.LINEAR_MIPMAP_LINEAR] }[word] ?? [gl.NEAREST, gl.NEAREST];
  gl.texParameteri(target, gl.TEXTURE_MAG_FILTER, magnified);
  gl.texParameteri(target, gl.TEXTURE_MIN_FILTER, minified);
}

function clear({ framebuffer }, color) {
  gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
  gl.clearColor(...color);
  gl.clear(gl.COLOR_BUFFER_BIT);
}

function makeMipmaps(target, { texture }) {
  gl.activeTexture(gl.TEXTURE0);
  gl.bindTexture(target, texture);
  gl.generateMipmap(target);
}

// ---- A frame.

// What a channel reads, in a pass of this kind: the texture, its target, `iChannelResolution` and, if it plays,
// its position, in seconds; `null` for nothing.
function binding(channel, kind, time) {
  const flat = (texture, resolution, position = 0) => ({ target: gl.TEXTURE_2D, texture, resolution, position });
  if (kind === "sound" && channel?.kind !== "texture") return null;
  if (channel?.kind === "buffer") {
    const { targets, last } = buffers[channel.index];
    return flat(targets[last].texture, [...size, 1]);
  }
  if (channel?.kind === "keyboard") return flat(keyboard, kind === "cubemap" ? [0, 0, 0] : [256, 3, 1]);
  if (MUSIC_KINDS.includes(channel?.kind)) return flat(channel.texture, [MUSIC_COLUMNS, 2, 1], 10 + time);
  if (channel?.isCubeA) {
    const { texture } = cubeA.targets[cubeA.last];
    return { target: gl.TEXTURE_CUBE_MAP, texture, resolution: [CUBE_SIDE, CUBE_SIDE, 1], position: 0 };
  }
  if (!channel?.texture) return null;
  return { ...channel, position: channel.kind === "video" ? time : 0 };
}

// Binds what a pass reads, and returns it. What is not there is left unbound: WebGL then reads (0, 0, 0, 1).
function bindChannels({ kind, channels }, time) {
  return channels.map((channel, at) => {
    gl.activeTexture(gl.TEXTURE0 + at);
    for (const target of [gl.TEXTURE_2D, gl.TEXTURE_3D, gl.TEXTURE_CUBE_MAP]) gl.bindTexture(target, null);
    const bound = binding(channel, kind, time);
    if (!bound) return { resolution: [0, 0, 0], position: 0, loaded: 0 };
    gl.bindTexture(bound.target, bound.texture);
    // The filter is the texture's: the last channel that reads it decides.
    if (channel.kind === "buffer" || channel.isCubeA) setFilter(bound.target, channel.filter);
    return { ...bound, loaded: 1 };
  });
}

function setChannelUniforms(program, bound) {
  const at = (name) => gl.getUniformLocation(program, name);
  gl.uniform1fv(at("iChannelTime"), bound.map(({ position }) => position));
  gl.uniform3fv(at("iChannelResolution"), bound.flatMap(({ resolution }) => resolution));
  gl.uniform4f(at("iDate"), 0, 0, 0, 0);
  gl.uniform1f(at("iSampleRate"), SAMPLE_RATE);
  // The samplers of the structs are left at unit 0, as on the site.
  bound.forEach(({ resolution, position, loaded }, index) => {
    gl.uniform1i(at(`iChannel${index}`), index);
    gl.uniform3f(at(`iCh${index}.size`), ...resolution);
    gl.uniform1f(at(`iCh${index}.time`), position);
    gl.uniform1i(at(`iCh${index}.loaded`), loaded);
  });
}

function setUniforms(program, frame, resolution) {
  const at = (name) => gl.getUniformLocation(program, name);
  gl.uniform3f(at("iResolution"), ...resolution, 1);
  gl.uniform1f(at("iTime"), frame / FRAMES_PER_SECOND);
  gl.uniform1f(at("iTimeDelta"), 1 / FRAMES_PER_SECOND);
  gl.uniform1f(at("iFrameRate"), FRAMES_PER_SECOND);
  gl.uniform1i(at("iFrame"), frame);
  gl.uniform4f(at("iMouse"), 0, 0, -0, -0);
}

// Uses the program of a pass with all that it reads in a frame.
function prepare(pass, frame, resolution) {
  const bound = bindChannels(pass, frame / FRAMES_PER_SECOND);
  gl.useProgram(pass.program);
  setUniforms(pass.program, frame, resolution);
  setChannelUniforms(pass.program, bound);
}

function renderPass(pass, frame) {
  if (pass.kind === "cubemap") {
    renderCube(pass, frame);
    return;
  }
  prepare(pass, frame, size);
  const written = buffers[pass.output];
  const target = written ? written.targets[1 - written.last] : image;
  draw(target, size);
  if (!written) return;
  if (wantsMipmaps(({ index }) => index === pass.output)) makeMipmaps(gl.TEXTURE_2D, target);
  written.last = 1 - written.last;
}

function renderCube(pass, frame) {
  const target = cubeA.targets[1 - cubeA.last];
  const side = [CUBE_SIDE, CUBE_SIDE];
  prepare(pass, frame, side);
  gl.uniform4f(gl.getUniformLocation(pass.program, "unViewport"), 0, 0, ...side);
  target.framebuffers.forEach((framebuffer, face) => {
    gl.uniform3fv(gl.getUniformLocation(pass.program, "unCorners"), CORNERS[face]);
    draw({ framebuffer }, side);
  });
  if (wantsMipmaps((channel) => channel.isCubeA)) makeMipmaps(gl.TEXTURE_CUBE_MAP, target);
  cubeA.last = 1 - cubeA.last;
}

// Nothing is cleared: discarded pixels keep what the target had.
function draw({ framebuffer }, viewport) {
  gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
  gl.viewport(0, 0, ...viewport);
  gl.drawArrays(gl.TRIANGLES, 0, 3);
}

// Renders up to this frame. `films` has the layers of each film in it: with films, no frame may be skipped.
function render(frame, films) {
  for (; nextFrame <= frame; nextFrame++) {
    move(nextFrame, films);
    for (const kind of ["buffer", "cubemap", "image"]) {
      for (const pass of passes) if (pass.kind === kind) renderPass(pass, nextFrame);
    }
  }
  checkErrors(`up to frame ${frame}`);
}

function checkErrors(when) {
  const error = gl.getError();
  if (error !== gl.NO_ERROR) throw new Error(`WebGL error 0x${error.toString(16)} ${when}`);
}

// ---- Results, in base64.

// What a pass has written: RGBA as floats, bottom row first, the faces of Cube A one above the other.
function pixels(name) {
  const { kind, output } = passes.find((pass) => pass.name === name);
  if (kind === "image") return base64(readPixels(image, size));
  if (kind === "buffer") return base64(readPixels(buffers[output].targets[buffers[output].last], size));
  const side = [CUBE_SIDE, CUBE_SIDE];
  const { framebuffers } = cubeA.targets[cubeA.last];
  const faces = framebuffers.map((framebuffer) => readPixels({ framebuffer }, side));
  const stack = new Float32Array(faces.length * faces[0].length);
  faces.forEach((face, at) => stack.set(face, at * face.length));
  return base64(stack);
}

// The samples of the first blocks of the Sound tab: 16 bits of the left, of the right channel, and so on.
function sound(blocks) {
  const pass = passes.find(({ kind }) => kind === "sound");
  const side = [SOUND_SIDE, SOUND_SIDE];
  const target = byteTarget(side);
  const bytes = new Uint8Array(4 * SOUND_SIDE * SOUND_SIDE);
  const samples = new Int16Array(2 * SOUND_SIDE * SOUND_SIDE * blocks);
  gl.useProgram(pass.program);
  setChannelUniforms(pass.program, bindChannels(pass, 0));
  for (let block = 0; block < blocks; block++) {
    const first = block * SOUND_SIDE * SOUND_SIDE;
    gl.uniform1f(gl.getUniformLocation(pass.program, "iTimeOffset"), first / SAMPLE_RATE);
    gl.uniform1i(gl.getUniformLocation(pass.program, "iSampleOffset"), first);
    draw(target, side);
    gl.readPixels(0, 0, ...side, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    for (let at = 0; at < bytes.length; at += 2) {
      // The largest level does not fit into a sample.
      samples[2 * first + at / 2] = Math.min(bytes[at] + 256 * bytes[at + 1] - 32767, 32767);
    }
  }
  checkErrors("in the sound");
  return base64(samples);
}

function byteTarget([width, height]) {
  const renderbuffer = gl.createRenderbuffer();
  gl.bindRenderbuffer(gl.RENDERBUFFER, renderbuffer);
  gl.renderbufferStorage(gl.RENDERBUFFER, gl.RGBA8, width, height);
  const framebuffer = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
  gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.RENDERBUFFER, renderbuffer);
  return { framebuffer };
}

function readPixels({ framebuffer }, [width, height]) {
  const floats = new Float32Array(4 * width * height);
  gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, floats);
  return floats;
}

function base64({ buffer }) {
  const bytes = new Uint8Array(buffer);
  let text = "";
  for (let at = 0; at < bytes.length; at += 8192) text += String.fromCharCode(...bytes.subarray(at, at + 8192));
  return btoa(text);
}

// Renders projects of ShaderToy as the site's own page does, into float targets. `load(project, size)` compiles
// all tabs, `render(frame)` renders up to that frame and returns the pixels of all passes, bottom row first.
"use strict";

const FRAMES_PER_SECOND = 60;
const SAMPLE_RATE = 44100;
const MAX_PASSES = 8;
const BUFFER_IDS = ["4dXGR8", "XsXGR8", "4sXGR8", "XdfGR8"];
// The number of Buffer A in files of the site's API.
const FIRST_BUFFER_NUMBER = 257;

const gl = document.createElement("canvas").getContext("webgl2", { antialias: false });
if (!gl?.getExtension("EXT_color_buffer_float") || !gl.getExtension("OES_texture_float_linear")) {
  throw new Error("WebGL 2 with float targets and their linear filter is not available");
}

// The project: all passes in the order of the file, and the buffers that they name.
let passes, size, buffers, image, keyboard, nextFrame;

// ---- The text of a tab: what the site writes before it, with as many lines, which `__LINE__` shows.

const VERTICES = `#version 300 es
void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }`;

const PRELUDE = `#version 300 es
#ifdef GL_ES
precision highp float;
precision highp int;
precision mediump sampler3D;
#endif
`;

const UNIFORMS = `#define HW_PERFORMANCE 1
uniform vec3 iResolution;
uniform float iTime;
uniform float iChannelTime[4];
uniform vec4 iMouse;
uniform vec4 iDate;
uniform float iSampleRate;
uniform vec3 iChannelResolution[4];
uniform int iFrame;
uniform float iTimeDelta;
uniform float iFrameRate;
`;

const IMAGE_MAIN = `void mainImage( out vec4 c, in vec2 f );
void st_assert( bool cond );
void st_assert( bool cond, int v );

out vec4 shadertoy_out_color;
${oneLine(`void st_assert( bool cond, int v ) {
  if (!cond) {
    if (v == 0) shadertoy_out_color.x = -1.0;
    else if (v == 1) shadertoy_out_color.y = -1.0;
    else if (v == 2) shadertoy_out_color.z = -1.0;
    else shadertoy_out_color.w = -1.0;
  }
}`)}
void st_assert( bool cond ) { if (!cond) shadertoy_out_color.x = -1.0; }
${oneLine(`void main() {
  shadertoy_out_color = vec4(1.0);
  vec4 color = vec4(0.0, 0.0, 0.0, 1.0);
  mainImage(color, gl_FragCoord.xy);
  if (shadertoy_out_color.x < 0.0) color = vec4(1.0, 0.0, 0.0, 1.0);
  if (shadertoy_out_color.y < 0.0) color = vec4(0.0, 1.0, 0.0, 1.0);
  if (shadertoy_out_color.z < 0.0) color = vec4(0.0, 0.0, 1.0, 1.0);
  if (shadertoy_out_color.w < 0.0) color = vec4(1.0, 1.0, 0.0, 1.0);
  shadertoy_out_color = vec4(color.xyz, 1.0);
}`)}
`;

const BUFFER_MAIN = `void mainImage( out vec4 c, in vec2 f );

out vec4 outColor;

void main()
{ vec4 color = vec4(0.0, 0.0, 0.0, 1.0); mainImage(color, gl_FragCoord.xy); outColor = color; }
`;

const SOUND_HEADER = `#define HW_PERFORMANCE 1
uniform float iChannelTime[4];
uniform float iTimeOffset;
uniform int iSampleOffset;
uniform vec4 iDate;
uniform float iSampleRate;
uniform vec3 iChannelResolution[4];
`;

const SOUND_MAIN = `
vec2 mainSound( in int samp, float time );
out vec4 outColor; void main() { outColor = mainSound(iSampleOffset, iTimeOffset).xyxy; }
`;

const COMMON_HEADER = `uniform vec4 iDate;
uniform float iSampleRate;
out vec4 outColor;
void main()
{ outColor = vec4(0.0); }
`;

function oneLine(text) {
  return text.replace(/\n */g, " ");
}

const samplerType = (channel) => ({ cubemap: "samplerCube", volume: "sampler3D" })[channel?.kind] ?? "sampler2D";

function header({ kind, channels }) {
  const samplers = channels.map((channel, at) => `uniform ${samplerType(channel)} iChannel${at};\n`);
  // The Image has another way to read channels.
  const structs = channels.map((channel, at) => `uniform struct {
${samplerType(channel)} sampler;
vec3 size;
float time;
int loaded;
} iCh${at};
`);
  switch (kind) {
    case "image": return UNIFORMS + samplers.join("") + structs.join("") + IMAGE_MAIN;
    case "buffer": return UNIFORMS + samplers.join("") + BUFFER_MAIN;
    case "sound": return SOUND_HEADER + samplers.join("") + SOUND_MAIN;
    case "common": return COMMON_HEADER;
    default: throw `cannot render a pass of type ${kind}`;
  }
}

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

function parseInput(input) {
  const kind = input.ctype ?? input.type;
  const { filter, wrap } = input.sampler ?? {};
  if (kind !== "buffer") return { kind };
  const index = bufferIndex(input);
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
  return pass;
}

const wantsMipmaps = (index) => passes.some(({ channels }) =>
  channels.some((channel) => channel?.index === index && channel.filter === "mipmap"));

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
// compile: the site starts only if there is none.
function load(project, newSize) {
  [size, buffers, nextFrame] = [newSize, [], 0];
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
      makeMipmaps(target);
    }
  }
  keyboard = idleKeyboard();
  const errors = passes.filter(({ log }) => log).map(({ name, log }) => ({ pass: name, log }));
  const names = passes.filter(({ kind }) => kind === "buffer" || kind === "image").map(({ name }) => name);
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

function idleKeyboard() {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.R8, 256, 3, 0, gl.RED, gl.UNSIGNED_BYTE, new Uint8Array(256 * 3));
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
  setFilter("nearest");
  return texture;
}

// Sets the filter of the bound texture.
function setFilter(word) {
  const [magnified, minified] =
    { linear: [gl.LINEAR, gl.LINEAR], mipmap: [gl.LINEAR, gl.LINEAR_MIPMAP_LINEAR] }[word] ?? [gl.NEAREST, gl.NEAREST];
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, magnified);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, minified);
}

function clear({ framebuffer }, color) {
  gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
  gl.clearColor(...color);
  gl.clear(gl.COLOR_BUFFER_BIT);
}

function makeMipmaps({ texture }) {
  gl.activeTexture(gl.TEXTURE0);
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.generateMipmap(gl.TEXTURE_2D);
}

// ---- A frame.

// Binds what a pass reads, and returns the resolutions of its channels. What is not there is left unbound:
// WebGL then reads (0, 0, 0, 1).
function bindChannels(channels) {
  return channels.map((channel, at) => {
    gl.activeTexture(gl.TEXTURE0 + at);
    gl.bindTexture(gl.TEXTURE_2D, null);
    if (channel?.kind === "keyboard") {
      gl.bindTexture(gl.TEXTURE_2D, keyboard);
      return [256, 3, 1];
    }
    if (channel?.kind !== "buffer") return [0, 0, 0];
    const { targets, last } = buffers[channel.index];
    gl.bindTexture(gl.TEXTURE_2D, targets[last].texture);
    // The filter is the texture's: the last channel that reads it decides.
    setFilter(channel.filter);
    return [...size, 1];
  });
}

function setUniforms({ program, channels }, frame, resolutions) {
  const at = (name) => gl.getUniformLocation(program, name);
  gl.uniform3f(at("iResolution"), ...size, 1);
  gl.uniform1f(at("iTime"), frame / FRAMES_PER_SECOND);
  gl.uniform1f(at("iTimeDelta"), 1 / FRAMES_PER_SECOND);
  gl.uniform1f(at("iFrameRate"), FRAMES_PER_SECOND);
  gl.uniform1i(at("iFrame"), frame);
  gl.uniform1fv(at("iChannelTime"), [0, 0, 0, 0]);
  gl.uniform3fv(at("iChannelResolution"), resolutions.flat());
  gl.uniform4f(at("iMouse"), 0, 0, -0, -0);
  gl.uniform4f(at("iDate"), 0, 0, 0, 0);
  gl.uniform1f(at("iSampleRate"), SAMPLE_RATE);
  // The samplers of the structs are left at unit 0, as on the site.
  channels.forEach((channel, index) => {
    gl.uniform1i(at(`iChannel${index}`), index);
    gl.uniform3f(at(`iCh${index}.size`), ...resolutions[index]);
    gl.uniform1i(at(`iCh${index}.loaded`), resolutions[index][0] > 0 ? 1 : 0);
  });
}

function renderPass(pass, frame) {
  const resolutions = bindChannels(pass.channels);
  gl.useProgram(pass.program);
  setUniforms(pass, frame, resolutions);
  const written = buffers[pass.output];
  const target = written ? written.targets[1 - written.last] : image;
  gl.bindFramebuffer(gl.FRAMEBUFFER, target.framebuffer);
  gl.viewport(0, 0, ...size);
  // Nothing is cleared: discarded pixels keep what the target had.
  gl.drawArrays(gl.TRIANGLES, 0, 3);
  if (!written) return;
  if (wantsMipmaps(pass.output)) makeMipmaps(target);
  written.last = 1 - written.last;
}

// Renders up to this frame. Returns what each pass has written, as base64 of floats.
function render(frame) {
  for (; nextFrame <= frame; nextFrame++) {
    for (const kind of ["buffer", "image"]) {
      for (const pass of passes) if (pass.kind === kind) renderPass(pass, nextFrame);
    }
  }
  const pixels = {};
  for (const { kind, name, output } of passes) {
    if (kind === "image") pixels[name] = readPixels(image);
    if (kind === "buffer") pixels[name] = readPixels(buffers[output].targets[buffers[output].last]);
  }
  const error = gl.getError();
  if (error !== gl.NO_ERROR) throw new Error(`WebGL error 0x${error.toString(16)} up to frame ${frame}`);
  return pixels;
}

function readPixels({ framebuffer }) {
  const floats = new Float32Array(4 * size[0] * size[1]);
  gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
  gl.readPixels(0, 0, ...size, gl.RGBA, gl.FLOAT, floats);
  const bytes = new Uint8Array(floats.buffer);
  let text = "";
  for (let at = 0; at < bytes.length; at += 8192) text += String.fromCharCode(...bytes.subarray(at, at + 8192));
  return btoa(text);
}

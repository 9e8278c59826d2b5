// The text before that of a tab, with as many lines as on the site, which `__LINE__` shows.
"use strict";

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

const CUBE_MAIN = `void mainCubemap( out vec4 c, in vec2 f, in vec3 ro, in vec3 rd );

uniform vec4 unViewport;
uniform vec3 unCorners[5];

out vec4 outColor;

void main()
${oneLine(`{
  vec2 at = (gl_FragCoord.xy - unViewport.xy) / unViewport.zw;
  vec3 low = mix(unCorners[0], unCorners[1], at.x);
  vec3 high = mix(unCorners[3], unCorners[2], at.x);
  vec3 ray = normalize(mix(low, high, at.y) - unCorners[4]);
  vec4 color = vec4(0.0, 0.0, 0.0, 1.0);
  mainCubemap(color, gl_FragCoord.xy - unViewport.xy, unCorners[4], ray);
  outColor = color;
}`)}
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
${oneLine(`out vec4 outColor;
void main() {
  float index = (gl_FragCoord.x - 0.5) + (gl_FragCoord.y - 0.5) * 512.0;
  int whole = int(gl_FragCoord.y - 0.2) * 512 + int(gl_FragCoord.x - 0.2);
  vec2 value = mainSound(iSampleOffset + whole, iTimeOffset + index / iSampleRate);
  vec2 level = floor((0.5 + 0.5 * value) * 65536.0);
  vec2 low = mod(level, 256.0) / 255.0;
  vec2 high = floor(level / 256.0) / 255.0;
  outColor = vec4(low.x, high.x, low.y, high.y);
}`)}
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

// The Sound tab knows no volumes: it declares one as it declares a picture.
const samplerType = (channel, pass) =>
  channel?.kind === "cubemap" ? "samplerCube" :
  channel?.kind === "volume" && pass !== "sound" ? "sampler3D" :
  "sampler2D";

function header({ kind, channels }) {
  const samplers = channels.map((channel, at) => `uniform ${samplerType(channel, kind)} iChannel${at};\n`);
  // The Image has another way to read channels.
  const structs = channels.map((channel, at) => `uniform struct {
${samplerType(channel, kind)} sampler;
vec3 size;
float time;
int loaded;
} iCh${at};
`);
  switch (kind) {
    case "image": return UNIFORMS + samplers.join("") + structs.join("") + IMAGE_MAIN;
    case "buffer": return UNIFORMS + samplers.join("") + BUFFER_MAIN;
    case "cubemap": return UNIFORMS + samplers.join("") + CUBE_MAIN;
    case "sound": return SOUND_HEADER + samplers.join("") + SOUND_MAIN;
    case "common": return COMMON_HEADER;
    default: throw `cannot render a pass of type ${kind}`;
  }
}

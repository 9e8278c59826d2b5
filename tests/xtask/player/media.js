// The textures of media. `media` has the `size` of each, in texels, the `components` of a volume, and `layers`:
// images, faces or slices as bytes of RGBA in base64. The first row of an image or a face is the upper one, as in
// files.
"use strict";

// The pictures that the site stores with one component.
const R8_IDS = ["Xdf3zn", "4sf3Rn", "4dXGzn", "4sf3Rr"];
// The columns of the texture of music: bins of the spectrum, and samples of the wave.
const MUSIC_COLUMNS = 512;
const MUSIC_KINDS = ["music", "musicstream", "mic"];
const FILM_KINDS = ["video", "webcam"];

const textureTarget = (kind) => ({ cubemap: gl.TEXTURE_CUBE_MAP, volume: gl.TEXTURE_3D })[kind] ?? gl.TEXTURE_2D;

// Each input has a texture of its own.
function mediumInput(kind, name, { filter, wrap, vflip }) {
  const { size: [width, height], components, layers } = media[name];
  const target = textureTarget(kind);
  const isR8 = kind === "volume" ? components === 1 : R8_IDS.includes(name);
  // A cube map has no resolution on the site.
  const resolution = { cubemap: [0, 0, 0], volume: [width, height, height] }[kind] ?? [width, height, 1];
  const input = { kind, name, filter, target, isR8, isFlipped: String(vflip) === "true", resolution };
  input.texture = gl.createTexture();
  gl.bindTexture(target, input.texture);
  setFilter(target, filter);
  for (const axis of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R]) {
    gl.texParameteri(target, axis, wrapMode(kind === "cubemap" ? "clamp" : wrap));
  }
  if (!FILM_KINDS.includes(kind)) upload(input, layers);
  return input;
}

// Sets the texels of an input's texture.
function upload({ kind, name, target, texture, filter, isR8, isFlipped }, layers) {
  const { size: [width, height] } = media[name];
  const [format, external] = isR8 ? [gl.R8, gl.RED] : [gl.RGBA8, gl.RGBA];
  const bytes = layers.map((text) => {
    const all = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    return isR8 ? all.filter((_, at) => at % 4 === 0) : all;
  });
  gl.activeTexture(gl.TEXTURE0);
  gl.bindTexture(target, texture);
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  const flat = (face, texels) =>
    gl.texImage2D(face, 0, format, width, height, 0, external, gl.UNSIGNED_BYTE, texels);
  if (kind === "volume") {
    const all = new Uint8Array(bytes.reduce((sum, { length }) => sum + length, 0));
    bytes.forEach((slice, at) => all.set(slice, at * slice.length));
    gl.texImage3D(target, 0, format, width, height, height, 0, external, gl.UNSIGNED_BYTE, all);
  } else {
    gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, isFlipped);
    if (kind === "cubemap") {
      const files = isFlipped ? [0, 1, 3, 2, 4, 5] : [0, 1, 2, 3, 4, 5];
      files.forEach((file, face) => flat(gl.TEXTURE_CUBE_MAP_POSITIVE_X + face, bytes[file]));
    } else {
      flat(target, bytes[0]);
    }
    gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, false);
  }
  if (filter === "mipmap") gl.generateMipmap(target);
}

function musicTexture() {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  setFilter(gl.TEXTURE_2D, "linear");
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
  return texture;
}

// The spectrum and the wave that the site shows while it is muted.
function mutedMusic(time) {
  const bytes = new Uint8Array(2 * MUSIC_COLUMNS);
  for (let at = 0; at < MUSIC_COLUMNS; at++) {
    const part = at / MUSIC_COLUMNS;
    const bin = at < 3
      ? Math.pow(0.5 + 0.5 * Math.sin(6.2831 * time), 4) * (1 - at / 3)
      : (0.75 + 0.25 * Math.sin(10 * at + 13 * time)) * Math.exp(-3 * part);
    const wave = 0.5 + 0.15 * Math.sin(17 * time + 62.831 * part) * Math.sin(23 * time + 1.9 * part);
    bytes[at] = Math.floor(255 * bin);
    bytes[MUSIC_COLUMNS + at] = Math.floor(255 * wave);
  }
  return bytes;
}

// Sets the texels of what moves to those of a frame. `films` has the layers of each film, by its name.
function move(frame, films) {
  const time = Math.fround(frame / FRAMES_PER_SECOND);
  for (const channel of passes.flatMap(({ channels }) => channels).filter((channel) => channel?.texture)) {
    if (FILM_KINDS.includes(channel.kind)) upload(channel, films[channel.name]);
    if (MUSIC_KINDS.includes(channel.kind)) {
      gl.activeTexture(gl.TEXTURE0);
      gl.bindTexture(gl.TEXTURE_2D, channel.texture);
      gl.texImage2D(
        gl.TEXTURE_2D, 0, gl.R8, MUSIC_COLUMNS, 2, 0, gl.RED, gl.UNSIGNED_BYTE, mutedMusic(time));
    }
  }
}

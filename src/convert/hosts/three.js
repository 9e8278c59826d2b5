import * as THREE from "three";

// $shaders

// #if textures
/** The textures that the shader reads, which the constructor takes by these names, and how they are sampled. */
const media = $media;

// #endif
/** The passes in the order in which they are rendered, the uniforms that they have, and what their channels read. */
const passes = $passes;

const vertexShader = /* glsl */ `in vec3 position;

void main() {
    gl_Position = vec4(position, 1.0);
}
`;

/** ShaderToy's inputs, which the passes share. */
function createInputs() {
  return {
    iResolution: { value: new THREE.Vector3() },
    iTime: { value: 0 },
    iTimeDelta: { value: 0 },
    iFrameRate: { value: 60 },
    iFrame: { value: 0 },
    iMouse: { value: new THREE.Vector4() },
    iDate: { value: new THREE.Vector4() },
    iSampleRate: { value: 44100 },
    iChannelTime: { value: [0, 0, 0, 0] },
    ...uniforms,
  };
}

/**
 * Creates the material of a pass, for a mesh whose vertices are in clip space.
 *
 * A RawShaderMaterial declares nothing, so that no name of the shader can clash, and three.js converts no color of it:
 * the values of the shader are displayed, as on ShaderToy.
 */
export function createMaterial(pass = passes[0], inputs = createInputs()) {
  const uniforms = {};
  for (const name of pass.uniforms) uniforms[name] = inputs[name];
  // #if channels
  for (const name in pass.channels) uniforms[name] = { value: null };
  if (pass.readsChannelResolution) {
    const value = [0, 1, 2, 3].map(() => new THREE.Vector3());
    uniforms.iChannelResolution = { value };
  }
  // #endif
  return new THREE.RawShaderMaterial({
    name: pass.name,
    glslVersion: THREE.GLSL3,
    uniforms,
    vertexShader,
    fragmentShader: pass.fragmentShader,
    blending: THREE.NoBlending,
    depthTest: false,
    depthWrite: false,
  });
}
// #if sampling

const filters = {
  nearest: [THREE.NearestFilter, THREE.NearestFilter],
  linear: [THREE.LinearFilter, THREE.LinearFilter],
  mipmap: [THREE.LinearFilter, THREE.LinearMipmapLinearFilter],
};

/** The parameters of a texture that is sampled so. */
function parameters({ filter, wrap }) {
  const wrapping =
    wrap === "repeat" ? THREE.RepeatWrapping : THREE.ClampToEdgeWrapping;
  const [magFilter, minFilter] = filters[filter];
  return {
    wrapS: wrapping,
    wrapT: wrapping,
    magFilter,
    minFilter,
    generateMipmaps: filter === "mipmap",
  };
}
// #endif
// #if channels

/** A channel without a texture is opaque black. */
function createBlack() {
  const black = new THREE.DataTexture(new Uint8Array([0, 0, 0, 255]), 1, 1);
  black.needsUpdate = true;
  return black;
}

/** Width and height of a texture in pixels, as far as it is loaded. */
function sizeOf({ image }) {
  const width = image?.videoWidth ?? image?.naturalWidth ?? image?.width ?? 0;
  const height =
    image?.videoHeight ?? image?.naturalHeight ?? image?.height ?? 0;
  return [width, height];
}
// #endif
// #if copies

const copyShader = /* glsl */ `precision highp float;
precision highp sampler2D;

uniform sampler2D source;
out vec4 color;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    bool isInside = all(lessThan(at, textureSize(source, 0)));
    color = isInside ? texelFetch(source, at, 0) : vec4(0.0);
}
`;

/** A target of 32-bit floats. A new one is zero, and targets are never cleared. */
function createTarget(renderer, [width, height], sampler) {
  const target = new THREE.WebGLRenderTarget(width, height, {
    type: THREE.FloatType,
    colorSpace: THREE.NoColorSpace,
    depthBuffer: false,
    ...parameters(sampler),
  });
  renderer.setRenderTarget(target);
  return target;
}
// #endif
// #if buffers

const samplerKey = ({ filter, wrap }) => `${filter} ${wrap}`;

/**
 * What a pass renders: two sides, of which one holds the last image while the other is rendered.
 *
 * A texture of three.js has one sampler, so a side has a target for each sampler that a channel reads it with. The pass
 * renders the first; the others are copies.
 */
class Buffer {
  constructor(name) {
    this.last = 0;
    this.samplers = {};
    const inputs = passes.flatMap(({ channels }) => Object.values(channels));
    for (const input of inputs.filter(({ buffer }) => buffer === name)) {
      this.samplers[samplerKey(input)] = input;
    }
    const samplers = Object.values(this.samplers);
    if (samplers.length === 0) {
      samplers.push({ filter: "nearest", wrap: "clamp" });
    }
    this.samplers = samplers;
    this.sides = [];
  }

  /** Makes the targets; of old ones, the lower left part is kept. */
  resize(renderer, size, copy) {
    const old = this.sides;
    this.sides = [0, 1].map((side) =>
      this.samplers.map((sampler, at) => {
        const target = createTarget(renderer, size, sampler);
        if (old.length > 0) copy(old[side][at].texture, target);
        return target;
      }),
    );
    for (const target of old.flat()) target.dispose();
  }

  /** The texture of the last image that is sampled so. */
  texture(input) {
    const key = samplerKey(input);
    const at = this.samplers.map(samplerKey).indexOf(key);
    return this.sides[this.last][at].texture;
  }
}
// #endif
// #if keyboard

/** ShaderToy's keyboard: of each key, whether it is down, was pressed in this frame, and is toggled. */
class Keyboard {
  constructor() {
    this.texels = new Uint8Array(256 * 3);
    this.texture = new THREE.DataTexture(this.texels, 256, 3, THREE.RedFormat);
    this.texture.needsUpdate = true;
  }

  set(key, isDown) {
    if (key > 255) return;
    if (isDown && this.texels[key] === 0) {
      this.texels[256 + key] = 255;
      this.texels[512 + key] = 255 - this.texels[512 + key];
    }
    this.texels[key] = isDown ? 255 : 0;
    this.texture.needsUpdate = true;
  }

  endFrame() {
    this.texels.fill(0, 256, 512);
    this.texture.needsUpdate = true;
  }
}
// #endif

/**
 * Renders the shader over a whole canvas or render target.
 *
 *     const shader = new Shader(renderer);
 *     renderer.setAnimationLoop((milliseconds) => {
 *       shader.update(milliseconds / 1000);
 *       shader.render();
 *     });
 */
export class Shader {
  // #if textures
  /**
   * `textures` are those of `media`, by their names. Their sampling, orientation and color space are set as ShaderToy
   * has them; a texture that is missing is black.
   */
  // #endif
  constructor($constructor) {
    this.renderer = renderer;
    this.inputs = createInputs();
    this.passes = passes.map((pass) => ({
      ...pass,
      material: createMaterial(pass, this.inputs),
    }));
    // One triangle covers the target.
    const geometry = new THREE.BufferGeometry();
    const corners = new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]);
    geometry.setAttribute("position", new THREE.BufferAttribute(corners, 3));
    this.mesh = new THREE.Mesh(geometry);
    this.mesh.frustumCulled = false;
    this.camera = new THREE.Camera();
    // #if channels
    this.black = createBlack();
    // #endif
    // #if textures
    this.textures = textures;
    for (const name in media) {
      const { filter, wrap, flipY } = media[name];
      const texture = textures[name];
      if (!texture) continue;
      if (filter) Object.assign(texture, parameters({ filter, wrap }));
      if (flipY !== undefined && !texture.isDataTexture) texture.flipY = flipY;
      texture.colorSpace = THREE.NoColorSpace;
      if (texture.image) texture.needsUpdate = true;
    }
    // #endif
    // #if buffers
    this.buffers = {};
    for (const { name, channels } of passes) {
      const read = Object.values(channels).map(({ buffer }) => buffer);
      for (const buffer of name === "image" ? read : [name, ...read]) {
        if (buffer) this.buffers[buffer] ??= new Buffer(buffer);
      }
    }
    // #endif
    // #if copies
    this.copyMaterial = new THREE.RawShaderMaterial({
      name: "copy",
      glslVersion: THREE.GLSL3,
      uniforms: { source: { value: null } },
      vertexShader,
      fragmentShader: copyShader,
      blending: THREE.NoBlending,
      depthTest: false,
      depthWrite: false,
    });
    // #endif
    // #if keyboard
    this.keyboard = new Keyboard();
    // #endif
    this.frame = 0;
    this.seconds = 0;
  }

  /**
   * Sets the inputs of the next frame: `seconds` is iTime, and `given` replaces other inputs by their names, such as
   * `{ iFrame: 0 }`.
   */
  update(seconds, given = {}) {
    const delta = this.frame > 0 ? seconds - this.seconds : 1 / 60;
    this.seconds = seconds;
    const now = new Date();
    const midnight = new Date(now).setHours(0, 0, 0, 0);
    const { iDate, iChannelTime } = this.inputs;
    iDate.value.set(
      now.getFullYear(),
      now.getMonth(),
      now.getDate(),
      (now - midnight) / 1000,
    );
    iChannelTime.value.fill(seconds);
    const values = {
      iTime: seconds,
      iTimeDelta: delta,
      iFrameRate: 1 / (delta || 1 / 60),
      iFrame: this.frame,
      ...given,
    };
    for (const name in values) {
      const input = this.inputs[name];
      // Vectors stay the same objects, which handlers of events write to.
      if (input.value?.copy && values[name]?.isVector4) {
        input.value.copy(values[name]);
      } else {
        input.value = values[name];
      }
    }
    this.frame += 1;
  }

  /** Renders a frame into a render target, or on the canvas. */
  render(target = null) {
    const { renderer } = this;
    const before = renderer.getRenderTarget();
    const { autoClear } = renderer;
    renderer.autoClear = false;
    const size = target
      ? [target.width, target.height]
      : renderer.getDrawingBufferSize(new THREE.Vector2()).toArray();
    this.resize(size);
    for (const pass of this.passes) {
      // #if channels
      this.bind(pass);
      // #endif
      this.renderPass(pass, target);
    }
    renderer.setRenderTarget(before);
    renderer.autoClear = autoClear;
    // #if mouse
    // The click is positive in one frame only.
    const mouse = this.inputs.iMouse.value;
    mouse.w = -Math.abs(mouse.w);
    // #endif
    // #if keyboard
    this.keyboard.endFrame();
    // #endif
  }

  /** Adapts to a size in pixels; `render` does so, too. */
  resize([width, height]) {
    const resolution = this.inputs.iResolution.value;
    if (resolution.x === width && resolution.y === height) return;
    resolution.set(width, height, 1);
    // #if copies
    const before = this.renderer.getRenderTarget();
    const copy = (from, to) => this.copy(from, to);
    // #endif
    // #if buffers
    for (const name in this.buffers) {
      this.buffers[name].resize(this.renderer, [width, height], copy);
    }
    // #endif
    // #if discards
    const old = this.image;
    const sampler = { filter: "nearest", wrap: "clamp" };
    this.image = createTarget(this.renderer, [width, height], sampler);
    if (old) copy(old.texture, this.image);
    old?.dispose();
    // #endif
    // #if copies
    this.renderer.setRenderTarget(before);
    // #endif
  }
  // #if channels

  /** Sets the textures of a pass. */
  bind({ channels, material: { uniforms } }) {
    for (const name in channels) {
      const channel = channels[name];
      let read = this.black;
      let size = [0, 0];
      // #if buffers
      if (channel.buffer) read = this.buffers[channel.buffer].texture(channel);
      // #endif
      // #if textures
      if (channel.texture) read = this.textures[channel.texture] ?? read;
      // #endif
      // #if keyboard
      if (channel.keyboard) read = this.keyboard.texture;
      // #endif
      if (read !== this.black) size = sizeOf(read);
      uniforms[name].value = read;
      const resolutions = uniforms.iChannelResolution?.value;
      resolutions?.[Number(name.at(-1))].set(...size, size[0] > 0 ? 1 : 0);
    }
  }
  // #endif

  // #if buffers
  renderPass({ name, material }, target) {
    if (name !== "image") {
      const buffer = this.buffers[name];
      const [first, ...copies] = buffer.sides[1 - buffer.last];
      this.draw(material, first);
      for (const other of copies) this.copy(first.texture, other);
      buffer.last = 1 - buffer.last;
      return;
    }
    // #endif
    // #if !buffers
  renderPass({ material }, target) {
    // #endif
    // #if discards
    // Discarded pixels keep the color of the last frame, so the image is a texture of its own.
    this.draw(material, this.image);
    this.copy(this.image.texture, target);
    // #endif
    // #if !discards
    this.draw(material, target);
    // #endif
  }
  // #if copies

  copy(from, to) {
    this.copyMaterial.uniforms.source.value = from;
    this.draw(this.copyMaterial, to);
  }
  // #endif

  draw(material, target) {
    this.mesh.material = material;
    this.renderer.setRenderTarget(target);
    this.renderer.render(this.mesh, this.camera);
  }
  // #if listens

  /** Follows the user's input on an element; returns a function that ends it. */
  listen(element = this.renderer.domElement) {
    const control = new AbortController();
    const listen = (on, type, react) =>
      on.addEventListener(type, react, { signal: control.signal });
    // #if mouse
    const mouse = this.inputs.iMouse.value;
    const move = (event) => {
      const { x, y } = this.inputs.iResolution.value;
      const bounds = element.getBoundingClientRect();
      const across = (event.clientX - bounds.left) / bounds.width;
      const up = (bounds.bottom - event.clientY) / bounds.height;
      mouse.x = Math.floor(across * x);
      mouse.y = Math.floor(up * y);
    };
    listen(element, "pointerdown", (event) => {
      move(event);
      mouse.z = mouse.x;
      mouse.w = mouse.y;
    });
    listen(element, "pointermove", (event) => event.buttons && move(event));
    listen(window, "pointerup", () => (mouse.z = -Math.abs(mouse.z)));
    // #endif
    // #if keyboard
    const { keyboard } = this;
    listen(window, "keydown", ({ keyCode }) => keyboard.set(keyCode, true));
    listen(window, "keyup", ({ keyCode }) => keyboard.set(keyCode, false));
    // #endif
    return () => control.abort();
  }
  // #endif

  dispose() {
    this.mesh.geometry.dispose();
    for (const { material } of this.passes) material.dispose();
    // #if channels
    this.black.dispose();
    // #endif
    // #if buffers
    for (const name in this.buffers) {
      for (const target of this.buffers[name].sides.flat()) target.dispose();
    }
    // #endif
    // #if discards
    this.image?.dispose();
    // #endif
    // #if copies
    this.copyMaterial.dispose();
    // #endif
    // #if keyboard
    this.keyboard.texture.dispose();
    // #endif
  }
}

// Texture lookup: §8.8. Texel (x, y) of channel 0 is (x/4, y/4, 1/2, 1); the other channels are black.

//# 8.8 holds a texel is fetched by its place
bool holds() { return texelFetch(iChannel0, ivec2(iFrame, 1), 0) == vec4(0.75, 0.25, 0.5, 1.0); }

//# 8.8 holds a texture is sampled at the center of a texel
bool holds() { return texture(iChannel0, vec2(2.5, 1.5) / 4.0) == vec4(0.5, 0.25, 0.5, 1.0); }

//# 8.8 holds a texture is looked up with a bias
bool holds() { return texture(iChannel0, vec2(2.5, 1.5) / 4.0, 0.0).xy == vec2(0.5, 0.25); }

//# 8.8 holds a texture is looked up at a level
bool holds() { return textureLod(iChannel0, vec2(iTime + 0.5, 1.5) / 4.0, 0.0).xy == vec2(0.5, 0.25); }

//# 8.8 holds a texture is looked up with derivatives
bool holds() { return textureGrad(iChannel0, vec2(0.5, iTime + 0.5) / 4.0, vec2(0.0), vec2(0.0)).xy == vec2(0.0, 0.5); }

//# 8.8 holds an offset counts texels
bool holds() { return textureOffset(iChannel0, vec2(0.5) / 4.0, ivec2(1, 2)).xy == vec2(0.25, 0.5); }

//# 8.8 holds offsets go with levels and derivatives
bool holds() { vec2 p = vec2(2.5) / 4.0, d = vec2(0.0); return textureLodOffset(iChannel0, p, 0.0, ivec2(-1, 1)).xy == vec2(0.25, 0.75) && textureGradOffset(iChannel0, p, d, d, ivec2(1, -2)).xy == vec2(0.75, 0.0); }

//# 8.8 holds a fetch may be offset
bool holds() { return texelFetchOffset(iChannel0, ivec2(1), 0, ivec2(2, -1)).xy == vec2(0.75, 0.0); }

//# 8.8 holds a projection divides by its last number
bool holds() { return textureProj(iChannel0, vec3(2.5, 1.5, 1.0) / iTime * 0.5).xy == vec2(0.0) || textureProj(iChannel0, vec3(1.25, 0.75, 2.0)).xy == vec2(0.5, 0.25); }

//# 8.8 holds a projection of four numbers leaves out the third
bool holds() { return textureProj(iChannel0, vec4(1.25, 0.75, 99.0, iTime)).xy == vec2(0.5, 0.25); }

//# 8.8 holds projections go with levels, derivatives and offsets
bool holds() {
    vec3 p = vec3(1.25, 0.75, iTime);
    vec2 d = vec2(0.0);
    return textureProjLod(iChannel0, p, 0.0).xy == vec2(0.5, 0.25) && textureProjGrad(iChannel0, p, d, d).xy == vec2(0.5, 0.25)
        && textureProjOffset(iChannel0, p, ivec2(1)).xy == vec2(0.75, 0.5) && textureProjLodOffset(iChannel0, p, 0.0, ivec2(-1)).xy == vec2(0.25, 0.0)
        && textureProjGradOffset(iChannel0, p, d, d, ivec2(0, 1)).xy == vec2(0.5, 0.5);
}

//# 8.8 holds a texture has a size
bool holds() { return textureSize(iChannel0, 0) == ivec2(4, 4); }

//# 8.8 holds a texel's components are chosen like a vector's
bool holds() { return texelFetch(iChannel0, ivec2(iFrame, 2), 0).yx == vec2(0.5, 0.75) && texelFetch(iChannel0, ivec2(0), 0)[2] == 0.5; }

//# 8.8 holds a sampler is passed to a function
vec2 at(sampler2D s, float x, float y) { return texture(s, (vec2(x, y) + 0.5) / vec2(textureSize(s, 0))).xy; }
bool holds() { return at(iChannel0, 3.0, 1.0) == vec2(0.75, 0.25); }

//# 8.8 holds a function may take several samplers
float sum(sampler2D a, sampler2D b) { return texelFetch(a, ivec2(1, 0), 0).x + texelFetch(b, ivec2(0), 0).x; }
bool holds() { return sum(iChannel0, iChannel1) == 0.25 && sum(iChannel1, iChannel0) == 0.0 && sum(iChannel0, iChannel0) == 0.25; }

//# 8.8 holds lookups are allowed in loops and branches
bool holds() { float s = 0.0; for (int i = 0; i < 4; i++) if (i != 1) s += texelFetch(iChannel0, ivec2(i, 0), 0).x; return s == 1.25; }

//# 8.8 holds a lookup may depend on a lookup
bool holds() { vec2 p = texelFetch(iChannel0, ivec2(1, 2), 0).xy; return texelFetch(iChannel0, ivec2(p * 4.0), 0).xy == p; }

//# 8.8 holds an offset may be a constant expression
const int one = 1;
bool holds() { return textureOffset(iChannel0, vec2(0.5) / 4.0, ivec2(one, 2 * one)).xy == vec2(0.25, 0.5); }

//# 8.8 holds an unbound channel is black
bool holds() { return texture(iChannel1, vec2(0.5)).xyz == vec3(0.0) && iChannelResolution[1] == vec3(0.0); }

//# 8.8 holds a channel may be a cube
// iChannel1: samplerCube
bool holds() { return texture(iChannel1, vec3(0.0, 1.0, iTime)).xyz == vec3(0.0); }

//# 8.8 holds a channel may be a volume
// iChannel2: sampler3D
bool holds() { return texelFetch(iChannel2, ivec3(0), 0).xyz == vec3(0.0) && texture(iChannel2, vec3(0.5)).xyz == vec3(0.0); }

//# 8.8 holds a channel takes the shape of the parameter that it is passed to
// iChannel3: samplerCube
vec4 f(samplerCube s) { return textureLod(s, vec3(1.0), 0.0); }
bool holds() { return f(iChannel3).xyz == vec3(0.0); }

//# 8.8 holds a texture is looked up where the fragment lies
bool holds() { return texture(iChannel0, gl_FragCoord.xy / 4.0).xy == vec2(0.0) && texelFetch(iChannel0, ivec2(gl_FragCoord.xy), 0).z == 0.5; }

//# 8.8 E0302 a texture is looked up by floats
vec4 f(ivec2 p) {
    return texture(iChannel0, p);  //!
}

//# 8.8 E0302 a texture is looked up at a place
vec4 f() {
    return texture(iChannel0);  //!
}

//# 8.8 E0302 a texture of two dimensions is looked up by two numbers
vec4 f(sampler2D s) {
    return texture(s, vec3(0.5));  //!
}

//# 8.8 E0302 a texture is not looked up by one number
vec4 f() {
    return texture(iChannel0, 0.5);  //!
}

//# 8.8 E0302 a texture is not looked up by four numbers
vec4 f() {
    return texture(iChannel0, vec4(0.5));  //!
}

//# 8.8 E0302 a cube is looked up by a direction
vec4 f(samplerCube s) {
    return texture(s, vec2(0.5));  //!
}

//# 8.8 E0302 a volume is looked up by three numbers
vec4 f(sampler3D s) {
    return texture(s, vec2(0.5));  //!
}

//# 8.8 E0302 the bias is a float
vec4 f(vec2 p) {
    return texture(iChannel0, p, 1);  //!
}

//# 8.8 E0302 texture takes three arguments at most
vec4 f(vec2 p) {
    return texture(iChannel0, p, 0.0, 0.0);  //!
}

//# 8.8 E0302 the sampler comes first
vec4 f(vec2 p) {
    return texture(p, iChannel0);  //!
}

//# 8.8 E0302 a number is not a sampler
vec4 f(vec2 p) {
    return texture(0, p);  //!
}

//# 8.8 E0302 a texel is fetched by integers
vec4 f(vec2 p) {
    return texelFetch(iChannel0, p, 0);  //!
}

//# 8.8 E0302 a texel is fetched at a level
vec4 f(ivec2 p) {
    return texelFetch(iChannel0, p);  //!
}

//# 8.8 E0302 the level of a fetch is an int
vec4 f(ivec2 p) {
    return texelFetch(iChannel0, p, 0.0);  //!
}

//# 8.8 E0302 no texel is fetched from a cube
vec4 f(samplerCube s) {
    return texelFetch(s, ivec3(0), 0);  //!
}

//# 8.8 E0302 the level of textureLod is a float
vec4 f(vec2 p) {
    return textureLod(iChannel0, p, 0);  //!
}

//# 8.8 E0302 textureLod has a level
vec4 f(vec2 p) {
    return textureLod(iChannel0, p);  //!
}

//# 8.8 E0302 textureGrad has two derivatives
vec4 f(vec2 p) {
    return textureGrad(iChannel0, p, p);  //!
}

//# 8.8 E0302 the derivatives have the size of the place
vec4 f(vec2 p) {
    return textureGrad(iChannel0, p, vec3(0.0), vec3(0.0));  //!
}

//# 8.8 E0302 textureSize has a level
ivec2 f() {
    return textureSize(iChannel0);  //!
}

//# 8.8 E0302 the level of textureSize is an int
ivec2 f() {
    return textureSize(iChannel0, 0.0);  //!
}

//# 8.8 E0301 textureSize gives integers
vec2 f() {
    vec2 size = textureSize(iChannel0, 0);  //!
    return size;
}

//# 8.8 E0301 a texture gives four numbers
vec3 f(vec2 p) {
    vec3 color = texture(iChannel0, p);  //!
    return color;
}

//# 8.8 E0302 textureProj takes three or four numbers
vec4 f(vec2 p) {
    return textureProj(iChannel0, p);  //!
}

//# 8.8 E0302 a cube map has no projective lookup
vec4 f(samplerCube s, vec4 p) {
    return textureProj(s, p);  //!
}

//# 8.8 E0302 an offset is made of integers
vec4 f(vec2 p) {
    return textureOffset(iChannel0, p, vec2(1.0));  //!
}

//# 8.8 E0302 an offset has the size of the texture
vec4 f(vec2 p) {
    return textureOffset(iChannel0, p, ivec3(1));  //!
}

//# 8.8 E0302 a cube has no offsets
vec4 f(samplerCube s) {
    return textureOffset(s, vec3(1.0), ivec2(1));  //!
}

//# 8.8 E0401 an offset does not depend on an input
vec4 f(vec2 p) {
    return textureOffset(iChannel0, p, ivec2(iFrame));  //!
}

//# 8.8 E0401 an offset does not depend on a parameter
vec4 f(ivec2 p, const ivec2 o) {
    return texelFetchOffset(iChannel0, p, 0, o);  //!
}

//# 8.8 E0304 an offset is not too small
vec4 f(vec2 p) {
    return textureOffset(iChannel0, p, ivec2(-9, 0));  //!
}

//# 8.8 E0304 an offset is not too large
vec4 f(ivec2 p) {
    return texelFetchOffset(iChannel0, p, 0, ivec2(0, 8));  //!
}

//# 8.8 holds an offset may be as far as the limits
bool holds() { return texelFetchOffset(iChannel0, ivec2(8, -7), 0, ivec2(-8, 7)) == vec4(0.0, 0.0, 0.5, 1.0); }

//# 8.8 E0302 the channels have one shape each
// ANGLE is told the shape; we tell it from the text.
vec4 f(vec2 p) {
    return texture(iChannel0, p)  //!
        + texture(iChannel0, vec3(p, 1.0));
}

//# 8.8 E0200 texture2D is of version 100
vec4 f(vec2 p) {
    return texture2D(iChannel0, p);  //!
}

//# 8.8 E0200 textureCube is of version 100
vec4 f(vec3 p) {
    return textureCube(iChannel0, p);  //!
}

//# 8.8 E0200 texture2DLod is of version 100
vec4 f(vec2 p) {
    return texture2DLod(iChannel0, p, 0.0);  //!
}

//# 8.8 E0200 textureGather is of version 310
vec4 f(vec2 p) {
    return textureGather(iChannel0, p);  //!
}

//# 8.8 E0200 textureQueryLevels is of desktop GLSL
int f() {
    return textureQueryLevels(iChannel0);  //!
}

//# 8.8 E0200 tex2D is HLSL's
vec4 f(vec2 p) {
    return tex2D(iChannel0, p);  //!
}

//# 8.8 E0200 images are of version 310
vec4 f(ivec2 p) {
    return imageLoad(iChannel0, p);  //!
}

//# 8.8 E0200 there is a channel of that number
vec4 f(vec2 p) {
    return texture(iChannel4, p);  //!
}

//# 8.8 E0304 the channels are no array
vec4 f(vec2 p) {
    return texture(iChannel0[1], p);  //!
}

//# 8.8 E0401 an array of samplers is indexed by constants
uniform sampler2D s[2];
vec4 f(vec2 p, int i) {
    return texture(s[i], p);  //!
}

//# 8.8 E0302 a shadow sampler is compared with a third number
float f(sampler2DShadow s, vec2 p) {
    return texture(s, p);  //!
}

//# 8.8 E0301 a shadow sampler gives one number
vec4 f(sampler2DShadow s, vec3 p) {
    vec4 v = texture(s, p);  //!
    return v;
}

//# 8.8 E0301 a sampler of integers gives integers
vec4 f(isampler2D s, vec2 p) {
    vec4 v = texture(s, p);  //!
    return v;
}

// Built-in variables, constants and functions without textures: §7 and §8.1 to §8.7, §8.9.

//# 7.2 holds the position of a fragment is its center
bool holds() { return gl_FragCoord.xy == vec2(0.5) && gl_FragCoord.w > 0.0; }

//# 7.2 holds the place of a fragment is known in functions
vec2 f() { return gl_FragCoord.xy; }
bool holds() { return f() == vec2(0.5); }

//# 7.2 holds a fragment faces somewhere
bool holds() { return gl_FrontFacing || !gl_FrontFacing; }

//# 7.2 holds the depth may be written and read again
bool holds() { gl_FragDepth = 0.5; return gl_FragDepth == 0.5; }

//# 7.2 E0400 the side of a fragment is not assigned to
void f() {
    gl_FrontFacing = true;  //!
}

//# 7.2 E0200 gl_FragColor is of version 100
void f() {
    gl_FragColor = vec4(1.0);  //!
}

//# 7.2 E0200 gl_FragData is of version 100
void f() {
    gl_FragData[0] = vec4(1.0);  //!
}

//# 7.2 E0200 gl_Position is the vertex shader's
void f() {
    gl_Position = vec4(1.0);  //!
}

//# 7.2 E0200 gl_VertexID is the vertex shader's
int f() {
    return gl_VertexID;  //!
}

//# 7.3 E0400 the constants of the implementation are not assigned to
void f() {
    gl_MaxDrawBuffers = 1;  //!
}

//# 7.3 E0200 there are no constants of desktop GLSL
int f() {
    return gl_MaxLights;  //!
}

//# 7.3 holds the constants of the implementation are what WebGL 2 promises at least
bool holds() { return gl_MaxVertexAttribs >= 16 && gl_MaxFragmentUniformVectors >= 224 && gl_MinProgramTexelOffset <= -8 && gl_MaxProgramTexelOffset >= 7; }

//# 8 holds most functions work on components
bool holds() { return abs(vec2(-1.0, iTime)) == vec2(1.0, 2.0) && floor(vec2(1.5, -1.5)) == vec2(1.0, -2.0) && sign(vec3(-2.0, 0.0, iTime)) == vec3(-1.0, 0.0, 1.0); }

//# 8.1 holds angles are turned into radians and back
bool holds() { return abs(radians(90.0 * iTime) - 3.14159265) < 1e-5 && abs(degrees(3.14159265) - 180.0) < 1e-3; }

//# 8.1 holds sine and cosine are of the unit circle
bool holds() { float s = sin(iTime), c = cos(iTime); return abs(s * s + c * c - 1.0) < 1e-3 && abs(s - 0.9092974) < 1e-3; }

//# 8.1 holds atan of two numbers knows the quarter
bool holds() { float q = 0.78539816; return abs(atan(iTime, 2.0) - q) < 1e-4 && abs(atan(iTime, -2.0) - 3.0 * q) < 1e-4 && abs(atan(-iTime, -2.0) + 3.0 * q) < 1e-4; }

//# 8.1 holds the inverse functions invert
bool holds() { float x = iTime / 4.0; return abs(sin(asin(x)) - x) < 1e-3 && abs(cos(acos(x)) - x) < 1e-3 && abs(tan(atan(x)) - x) < 1e-3; }

//# 8.1 holds hyperbolic functions go together
bool holds() { float x = iTime / 2.0; return abs(cosh(x) * cosh(x) - sinh(x) * sinh(x) - 1.0) < 1e-3 && abs(tanh(x) - sinh(x) / cosh(x)) < 1e-3 && abs(asinh(sinh(x)) - x) < 1e-3; }

//# 8.2 holds powers and roots go together
bool holds() { return abs(pow(iTime, 3.0) - 8.0) < 1e-3 && sqrt(iTime * 2.0) == 2.0 && abs(inversesqrt(iTime * 2.0) - 0.5) < 1e-5 && abs(exp2(iTime) - 4.0) < 1e-3 && abs(log2(iTime) - 1.0) < 1e-4 && abs(log(exp(iTime)) - 2.0) < 1e-3; }

//# 8.3 holds abs and sign take integers
bool holds() { int a = iFrame - 5; return abs(a) == 2 && sign(a) == -1 && abs(ivec2(a, 1)) == ivec2(2, 1); }

//# 8.3 holds min, max and clamp take all numbers
bool holds() { return min(iFrame, 2) == 2 && max(uint(iFrame), 5u) == 5u && clamp(iTime, 0.0, 1.0) == 1.0 && clamp(ivec2(iFrame, -3), 0, 2) == ivec2(2, 0) && min(vec2(iTime, 1.0), 1.5) == vec2(1.5, 1.0); }

//# 8.3 holds rounding goes four ways
bool holds() { float a = iTime + 0.75; return floor(a) == 2.0 && ceil(a) == 3.0 && trunc(-a) == -2.0 && round(a) == 3.0 && floor(-a) == -3.0; }

//# 8.3 holds roundEven rounds a half to the even side
bool holds() { float h = iTime + 0.5; return roundEven(h) == 2.0 && roundEven(h + 1.0) == 4.0 && roundEven(-h) == -2.0; }

//# 8.3 holds fract is what floor leaves
bool holds() { return fract(iTime + 0.25) == 0.25 && fract(-iTime - 0.25) == 0.75; }

//# 8.3 holds mod has the sign of its second argument
bool holds() { return mod(iTime + 5.5, 3.0) == 1.5 && mod(-iTime, 3.0) == 1.0 && mod(vec2(5.0, -1.0), iTime) == vec2(1.0, 1.0); }

//# 8.3 holds modf parts a number in two
bool holds() { float whole; float part = modf(iTime + 0.25, whole); vec2 wholes; vec2 parts = modf(vec2(-1.5, iTime), wholes); return whole == 2.0 && part == 0.25 && wholes == vec2(-1.0, 2.0) && parts == vec2(-0.5, 0.0); }

//# 8.3 holds mix goes from one to the other
bool holds() { return mix(1.0, 5.0, iTime / 4.0) == 3.0 && mix(vec2(0.0), vec2(4.0, 8.0), 0.25) == vec2(1.0, 2.0) && mix(vec2(0.0), vec2(4.0), vec2(0.5, 1.0)) == vec2(2.0, 4.0); }

//# 8.3 holds mix may choose by truth
bool holds() { bool b = iTime > 1.0; return mix(1.0, 5.0, b) == 5.0 && mix(vec2(1.0), vec2(2.0), bvec2(b, !b)) == vec2(2.0, 1.0); }

//# 8.3 holds step and smoothstep have their edges first
bool holds() { return step(1.0, iTime) == 1.0 && step(3.0, iTime) == 0.0 && step(1.5, vec2(1.0, iTime)) == vec2(0.0, 1.0) && smoothstep(1.0, 3.0, iTime) == 0.5 && smoothstep(0.0, 1.0, vec2(-1.0, iTime)) == vec2(0.0, 1.0); }

//# 8.3 holds infinity is told
bool holds() { float zero = iTime - 2.0; return isinf(1.0 / zero) && !isinf(iTime) && !isnan(iTime) && isinf(vec2(1.0, -1.0 / zero)).y; }

//# 8.3 holds floats and their bits are exchanged
bool holds() { return floatBitsToInt(iTime) == 0x40000000 && floatBitsToUint(-iTime) == 0xC0000000u && intBitsToFloat(0x3FC00000) + uintBitsToFloat(uint(iFrame) * 0u + 0x40000000u) == 3.5; }

//# 8.4 holds what is packed is unpacked again
bool holds() { vec2 v = vec2(0.5, iTime - 3.0); return unpackHalf2x16(packHalf2x16(v)) == v && packHalf2x16(vec2(1.0, iTime)) == 0x40003C00u && packUnorm2x16(vec2(0.0, iTime)) == 0xFFFF0000u && unpackSnorm2x16(packSnorm2x16(vec2(1.0, -1.0))) == vec2(1.0, -1.0) && unpackUnorm2x16(0x0000FFFFu).x == 1.0; }

//# 8.5 holds lengths and distances are Euclid's
bool holds() { return length(vec2(3.0, iTime * 2.0)) == 5.0 && distance(vec3(1.0), vec3(1.0, 1.0, iTime)) == 1.0 && length(-iTime) == 2.0 && dot(vec3(1.0, 2.0, 3.0), vec3(iTime)) == 12.0; }

//# 8.5 holds cross follows the right hand
bool holds() { return cross(vec3(iTime, 0.0, 0.0), vec3(0.0, 1.0, 0.0)) == vec3(0.0, 0.0, 2.0); }

//# 8.5 holds normalize gives length 1
bool holds() { return normalize(vec2(0.0, iTime)) == vec2(0.0, 1.0) && abs(length(normalize(vec3(1.0, 2.0, iTime))) - 1.0) < 1e-5 && normalize(-iTime) == -1.0; }

//# 8.5 holds reflect mirrors at a normal
bool holds() { return reflect(vec2(1.0, -iTime), vec2(0.0, 1.0)) == vec2(1.0, 2.0) && reflect(iTime, 1.0) == -2.0; }

//# 8.5 holds refract bends, or gives 0 where it cannot
bool holds() { vec2 n = vec2(0.0, 1.0); return refract(-n, n, iTime / 4.0) == -n && refract(normalize(vec2(1.0, -0.1)), n, iTime) == vec2(0.0); }

//# 8.5 holds faceforward turns a normal to the eye
bool holds() { vec2 n = vec2(0.0, iTime); return faceforward(n, vec2(0.0, -1.0), n) == n && faceforward(n, n, n) == -n; }

//# 8.6 holds matrices have functions of their own
bool holds() { mat2 m = mat2(1.0, 2.0, 3.0, iTime); return matrixCompMult(m, m) == mat2(1.0, 4.0, 9.0, 4.0) && transpose(m) == mat2(1.0, 3.0, 2.0, 2.0) && determinant(m) == -4.0; }

//# 8.6 holds a matrix times its inverse is the unit matrix
bool near(float a, float b) { return abs(a - b) < 1e-5; }
bool holds() { mat3 m = mat3(iTime, 0.0, 1.0, 0.0, 4.0, 0.0, 0.0, 0.0, 8.0), e = m * inverse(m); return near(e[0].x, 1.0) && near(e[1].y, 1.0) && near(e[2].z, 1.0) && near(e[0].z, 0.0) && inverse(mat2(iTime))[1][1] == 0.5; }

//# 8.6 holds outerProduct takes a column and a row
bool holds() { mat2x3 m = outerProduct(vec3(1.0, 2.0, 3.0), vec2(iTime, 10.0)); return m[0] == vec3(2.0, 4.0, 6.0) && m[1] == vec3(10.0, 20.0, 30.0) && transpose(m)[2] == vec2(6.0, 30.0); }

//# 8.7 holds vectors are compared by components
bool holds() { vec2 a = vec2(1.0, iTime), b = vec2(iTime, 2.0); return lessThan(a, b) == bvec2(true, false) && lessThanEqual(a, b) == bvec2(true) && greaterThan(ivec2(iFrame, 0), ivec2(1)) == bvec2(true, false) && greaterThanEqual(uvec2(1u), uvec2(2u, 1u)).y && equal(a, b) == bvec2(false, true) && notEqual(a, b).x; }

//# 8.7 holds truths are gathered
bool holds() { bvec3 b = bvec3(true, iTime > 1.0, iTime > 5.0); return any(b) && !all(b) && not(b) == bvec3(false, false, true) && equal(b, bvec3(true)) == b; }

//# 8.9 holds the derivative of equal neighbors is 0
bool holds() { return dFdx(iTime) == 0.0 && dFdy(vec2(iTime)) == vec2(0.0) && fwidth(iTime) == 0.0; }

//# 8.9 holds neighbors are one pixel apart
bool holds() { return dFdx(gl_FragCoord.x) == 1.0 && dFdy(gl_FragCoord.xy) == vec2(0.0, 1.0) && fwidth(gl_FragCoord.xy) == vec2(1.0); }

//# 8.1 E0302 functions of floats take no integers
float f() {
    return sin(1);  //!
}

//# 8.1 E0302 functions of floats take no integers from vectors
vec2 f(ivec2 v) {
    return cos(v);  //!
}

//# 8.1 E0302 sin takes one argument
float f() {
    return sin(1.0, 2.0);  //!
}

//# 8.1 E0302 sin takes an argument
float f() {
    return sin();  //!
}

//# 8.1 E0302 atan takes two of one size
vec2 f(vec2 v) {
    return atan(v, 1.0);  //!
}

//# 8.1 E0302 functions take no bools
float f(bool b) {
    return sin(b);  //!
}

//# 8.1 E0302 functions take no matrices
mat2 f(mat2 m) {
    return sin(m);  //!
}

//# 8.2 E0302 pow takes two of one size
vec3 f(vec3 v) {
    return pow(v, 2.0);  //!
}

//# 8.2 E0302 pow takes no integers
float f(float a) {
    return pow(a, 2);  //!
}

//# 8.2 E0302 sqrt takes no integers
float f() {
    return sqrt(4);  //!
}

//# 8.3 E0302 abs takes no unsigned integers
uint f(uint a) {
    return abs(a);  //!
}

//# 8.3 E0302 floor takes no integers
int f(int a) {
    return floor(a);  //!
}

//# 8.3 E0302 mod takes no integers
int f(int a) {
    return mod(a, 2);  //!
}

//# 8.3 E0302 mod of vectors takes vectors of one size
vec2 f(vec2 a, vec3 b) {
    return mod(a, b);  //!
}

//# 8.3 E0302 mod of a scalar takes no vector
vec2 f(float a, vec2 b) {
    return mod(a, b);  //!
}

//# 8.3 E0302 min takes two of one type
float f(float a) {
    return min(a, 1);  //!
}

//# 8.3 E0302 max has its vector first
vec2 f(vec2 v) {
    return max(0.0, v);  //!
}

//# 8.3 E0302 max takes two arguments
float f(float a) {
    return max(a, 1.0, 2.0);  //!
}

//# 8.3 E0302 clamp takes three of one type
float f(float a) {
    return clamp(a, 0, 1);  //!
}

//# 8.3 E0302 clamp takes three arguments
float f(float a) {
    return clamp(a, 1.0);  //!
}

//# 8.3 E0302 clamp has both bounds of one size
vec2 f(vec2 v) {
    return clamp(v, 0.0, vec2(1.0));  //!
}

//# 8.3 E0302 mix takes two of one type
vec3 f(vec3 v) {
    return mix(v, 1.0, 0.5);  //!
}

//# 8.3 E0302 mix takes no integers
int f(int a) {
    return mix(a, a, 1);  //!
}

//# 8.3 E0302 mix of integers by truth came later
// glslang lets it.
int f(int a, bool b) {
    return mix(a, a, b);  //!
}

//# 8.3 E0302 step has its edge first
vec2 f(vec2 v) {
    return step(v, 1.0);  //!
}

//# 8.3 E0302 smoothstep has both edges of one size
vec2 f(vec2 v) {
    return smoothstep(0.0, v, v);  //!
}

//# 8.3 E0302 smoothstep takes three arguments
float f(float a) {
    return smoothstep(0.0, a);  //!
}

//# 8.3 E0302 isnan takes floats
bool f(int a) {
    return isnan(a);  //!
}

//# 8.3 E0400 what modf writes is an lvalue
float f() {
    return modf(1.5, 1.0);  //!
}

//# 8.3 E0302 modf writes a float
float f() {
    int whole;
    return modf(1.5, whole);  //!
}

//# 8.3 E0302 bits of floats are taken of floats
int f(int a) {
    return floatBitsToInt(a);  //!
}

//# 8.4 E0302 two numbers are packed
uint f(vec3 v) {
    return packHalf2x16(v);  //!
}

//# 8.4 E0200 four numbers are not packed in 300 es
uint f(vec4 v) {
    return packUnorm4x8(v);  //!
}

//# 8.5 E0302 cross takes vectors of three
vec2 f(vec2 v) {
    return cross(v, v);  //!
}

//# 8.5 E0302 dot takes two of one size
float f(vec2 a, vec3 b) {
    return dot(a, b);  //!
}

//# 8.5 E0302 dot takes no integers
int f(ivec2 a) {
    return dot(a, a);  //!
}

//# 8.5 E0302 distance takes two of one size
float f(vec2 a) {
    return distance(a, 0.0);  //!
}

//# 8.5 E0302 length takes no integers
float f(ivec2 a) {
    return length(a);  //!
}

//# 8.5 E0302 normalize takes one argument
vec2 f(vec2 a) {
    return normalize(a, a);  //!
}

//# 8.5 E0302 refract takes a float last
vec2 f(vec2 a) {
    return refract(a, a, a);  //!
}

//# 8.5 E0301 the length of a vector is a float
vec2 f(vec2 a) {
    vec2 l = length(a);  //!
    return l;
}

//# 8.6 E0302 only square matrices have a determinant
float f(mat2x3 m) {
    return determinant(m);  //!
}

//# 8.6 E0302 only square matrices have an inverse
mat3x2 f(mat3x2 m) {
    return inverse(m);  //!
}

//# 8.6 E0301 transposing swaps columns and rows
mat2x3 f(mat2x3 m) {
    mat2x3 t = transpose(m);  //!
    return t;
}

//# 8.6 E0302 matrices multiplied by components have one shape
mat2 f(mat2 a, mat3 b) {
    return matrixCompMult(a, b);  //!
}

//# 8.7 E0302 scalars are compared by operators
bool f(float a) {
    return lessThan(a, 1.0);  //!
}

//# 8.7 E0302 vectors of different kinds are not compared
bvec2 f(vec2 a, ivec2 b) {
    return lessThan(a, b);  //!
}

//# 8.7 E0302 truths are not ordered
bvec2 f(bvec2 a) {
    return greaterThan(a, a);  //!
}

//# 8.7 E0302 any takes truths
bool f(vec2 a) {
    return any(a);  //!
}

//# 8.7 E0302 all takes a vector
bool f(bool a) {
    return all(a);  //!
}

//# 8.7 E0302 not takes a vector
bool f(bool a) {
    return not(a);  //!
}

//# 8.7 E0301 the comparison of vectors is a vector
void f(vec2 a, vec2 b) {
    if (lessThan(a, b)) { }  //!
}

//# 8.9 E0302 differences are of floats
int f(int a) {
    return dFdx(a);  //!
}

//# 8.9 E0200 fine differences are of desktop GLSL
float f(float a) {
    return dFdxFine(a);  //!
}

//# 8 E0200 fma is of version 320
float f(float a) {
    return fma(a, a, a);  //!
}

//# 8 E0200 lerp is HLSL's
float f(float a) {
    return lerp(a, a, 0.5);  //!
}

//# 8 E0200 mul is HLSL's
vec2 f(mat2 m, vec2 v) {
    return mul(m, v);  //!
}

//# 8 E0200 frac is HLSL's
float f(float a) {
    return frac(a);  //!
}

//# 8 E0200 atan2 is HLSL's
float f(float a) {
    return atan2(a, a);  //!
}

//# 8 E0200 bitCount is of version 310
int f(int a) {
    return bitCount(a);  //!
}

//# 8 E0200 noise is of desktop GLSL
float f(vec2 v) {
    return noise1(v);  //!
}

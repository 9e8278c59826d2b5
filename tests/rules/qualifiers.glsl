// Storage, parameters, interpolation, precision, invariance and the order of qualifiers: §4.3 to §4.7.

//# 4.3 holds a global variable keeps its value between calls
int n = 1;
void count() { n++; }
bool holds() { count(); count(); return n == 3; }

//# 4.3 holds a local variable may be const
bool holds() { const float a = 2.0; return a == iTime; }

//# 4.3 E0403 a local variable is not a uniform
void f() {
    uniform float a;  //!
}

//# 4.3 E0403 a local variable is not an input
void f() {
    in float a;  //!
}

//# 4.3 E0403 a local variable is not an output
void f() {
    out float a;  //!
}

//# 4.3 E0403 a global variable is not inout
inout float a;  //!

//# 4.3 E0403 a global variable has one storage
uniform const float a = 1.0;  //!

//# 4.3 E0403 a global variable is not in and out
in out vec4 a;  //!

//# 4.3 E0403 const is not repeated
const const float a = 1.0;  //!

//# 4.3.3 E0402 a constant has a value
const float a;  //!

//# 4.3.3 E0402 each constant of a declaration has a value
const float a = 1.0, b;  //!

//# 4.3.3 E0402 a local constant has a value
void f() {
    const vec2 a;  //!
}

//# 4.3.3 E0400 a constant is not assigned to
const float a = 1.0;
void f() {
    a = 2.0;  //!
}

//# 4.3.3 E0400 a component of a constant is not assigned to
const vec2 a = vec2(1.0);
void f() {
    a.x = 2.0;  //!
}

//# 4.3.3 E0400 an element of a constant array is not assigned to
const float a[2] = float[](1.0, 2.0);
void f() {
    a[0] = 2.0;  //!
}

//# 4.3.3 E0403 a member is not const by itself
struct S {
    const float a;  //!
};

//# 4.3.3 holds a constant structure has constant members
struct S { int n; };
const S s = S(3);
bool holds() { float a[s.n]; return a.length() == 3; }

//# 4.3.5 E0403 a uniform takes no value
uniform float a = 1.0;  //!

//# 4.3.5 E0400 a uniform is not assigned to
uniform float a;
void f() {
    a = 1.0;  //!
}

//# 4.3.5 E0400 ShaderToy's inputs are not assigned to
void f() {
    iMouse.x = 1.0;  //!
}

//# 4.3.5 E0400 a uniform is not stepped
void f() {
    iFrame++;  //!
}

//# 4.3.4 E0307 an input is not a bool
in bool a;  //!

//# 4.3.4 E0307 an input is not a vector of bools
in bvec2 a;  //!

//# 4.3.4 E0403 an input takes no value
in float a = 1.0;  //!

//# 4.3.4 E0400 an input is not assigned to
in vec2 a;
void f() {
    a = vec2(1.0);  //!
}

//# 4.3.4 error an integer input is flat
in int a;  //!

//# 4.3.4 error an input of integers is flat
in uvec2 a;  //!

//# 4.3.6 E0307 an output is not a bool
out bool a;  //!

//# 4.3.6 E0307 an output is not a matrix
out mat2 a;  //!

//# 4.3.6 E0307 an output is not a structure
struct S { float a; };
out S a;  //!

//# 4.3.6 E0307 a sampler comes from outside
in sampler2D s;  //!

//# 4.3.6 E0403 an output takes no value
out vec4 a = vec4(1.0);  //!

//# 4.4 holds a const parameter can be read
float f(const float a) { return a + 1.0; }
bool holds() { return f(1.0) == iTime; }

//# 4.4 E0400 a const parameter is not assigned to
void f(const float a) {
    a = 1.0;  //!
}

//# 4.4 E0400 a const in parameter is not assigned to
void f(const in vec2 a) {
    a.y = 1.0;  //!
}

//# 4.4 holds an in parameter is the function's own
float f(in float a) { a += 1.0; return a; }
bool holds() { float a = 1.0; return f(a) == 2.0 && a == 1.0; }

//# 4.4 holds an out parameter is written back
void f(out float a) { a = 2.0; }
bool holds() { float a = 1.0; f(a); return a == iTime; }

//# 4.4 holds an inout parameter is read and written back
void f(inout float a) { a += a; }
bool holds() { float a = 1.5; f(a); return a == 3.0; }

//# 4.4 holds a parameter without qualifier is in
void f(float a) { a = 5.0; }
bool holds() { float a = 1.0; f(a); return a == 1.0; }

//# 4.4 E0403 a const parameter is not out
void f(const out float a) { }  //!

//# 4.4 E0403 a const parameter is not inout
void f(const inout float a) { }  //!

//# 4.4 E0403 a parameter is not a uniform
void f(uniform float a) { }  //!

//# 4.4 E0403 a parameter has one direction
// glslang takes the last.
void f(in out float a) { }  //!

//# 4.4 E0403 const comes before in
// WebGL 2 follows the order of §4.7.
void f(in const float a) { }  //!

//# 4.4 E0403 a parameter is not flat
void f(flat float a) { }  //!

//# 4.4 E0403 a parameter is not invariant
void f(invariant float a) { }  //!

//# 4.4 E0403 a result has no storage
const float f() { return 1.0; }  //!

//# 4.4 E0403 a result has no direction
out float f() { return 1.0; }  //!

//# 4.3.9 E0403 interpolation is for inputs and outputs
void f() {
    flat float a;  //!
}

//# 4.3.9 E0403 a member is not flat
struct S {
    flat float a;  //!
};

//# 4.3.9 error interpolation is not for plain globals
// glslang lets it.
smooth float a = 1.0;  //!

//# 4.3.9 error interpolation is not for uniforms
// glslang lets it.
flat uniform float a;  //!

//# 4.3.9 error interpolation is not for outputs of a fragment shader
flat out vec4 a;  //!

//# 4.3.9 error centroid alone is not a storage qualifier
// glslang lets it.
centroid float a;  //!

//# 4.3.8 error a layout is not for plain globals
layout(location = 0) float a;  //!

//# 4.3.8 E0403 a layout is not for locals
void f() {
    layout(location = 0) float a;  //!
}

//# 4.3.8 error inputs of a fragment shader have no location
layout(location = 0) in vec4 a;  //!

//# 4.3.8 E0100 a layout is not empty
layout() out vec4 a;  //!

//# 4.3.8 E0100 a location is a number
layout(location = x) out vec4 a;  //!

//# 4.3.8 error an unknown layout is an error
layout(color = 1) out vec4 a;  //!

//# 4.5.3 holds numbers may have a precision
lowp float a = 1.0;
mediump int b = 2;
highp uvec2 c = uvec2(3u);
bool holds() { highp mat2 m = mat2(1.0); lowp vec3 v = vec3(a); return m[0][0] + v.y == float(b) && c.y == 3u; }

//# 4.5.3 holds parameters, members and results may have a precision
struct S { mediump vec2 a; lowp int b; };
highp float f(lowp float a, const in mediump float b) { return a + b; }
bool holds() { S s = S(vec2(1.0), 2); return f(s.a.x, float(s.b)) == 3.0; }

//# 4.5.3 E0403 a bool has no precision
highp bool a;  //!

//# 4.5.3 E0403 a structure has no precision
struct S { float a; };
highp S s;  //!

//# 4.5.3 E0403 a vector of bools has no precision
void f() {
    lowp bvec2 a;  //!
}

//# 4.5.3 E0403 nothing has no precision
lowp void f() { }  //!

//# 4.5.3 E0403 a parameter that is a bool has no precision
float f(mediump bool a) { return 1.0; }  //!

//# 4.5.3 E0403 one precision is enough
highp lowp float a;  //!

//# 4.5.4 holds a default precision may be set anywhere
precision mediump float;
bool holds() { precision highp float; precision lowp int; { precision mediump float; } return iTime == 2.0; }

//# 4.5.4 holds samplers may have a default precision
precision highp sampler2D;
precision lowp samplerCube;
precision mediump isampler3D;
bool holds() { return true; }

//# 4.5.4 E0307 uint has no default precision
precision highp uint;  //!

//# 4.5.4 E0307 vectors have no default precision
precision highp vec2;  //!

//# 4.5.4 E0307 bool has no default precision
precision lowp bool;  //!

//# 4.5.4 E0307 structures have no default precision
struct S { float a; };
precision lowp S;  //!

//# 4.5.4 error arrays have no default precision
precision lowp float[2];  //!

//# 4.5.4 E0100 a default precision names a precision
precision float;  //!

//# 4.5.4 E0100 a default precision names a type
precision highp;  //!

//# 4.5.4 E0100 a default precision ends with a semicolon
precision highp float  //!
float x;

//# 4.6.1 holds the depth may be invariant
invariant gl_FragDepth;
bool holds() { return true; }

//# 4.6.1 E0403 a plain global is not invariant
float a;
invariant a;  //!

//# 4.6.1 E0403 an input is not invariant in a fragment shader
in float a;
invariant a;  //!

//# 4.6.1 E0200 only what is declared is made invariant
invariant a;  //!

//# 4.6.1 error a local is not made invariant
void f() {
    float a;
    invariant a;  //!
}

//# 4.6.1 error a plain global is not declared invariant
invariant float a;  //!

//# 4.6.1 error a uniform is not declared invariant
invariant uniform float a;  //!

//# 4.7 holds qualifiers have an order
const highp float a = 2.0;
float f(const in highp float b) { return a + b; }
bool holds() { return f(1.0) == 3.0; }

//# 4.7 E0403 precision comes last
highp const float a = 1.0;  //!

//# 4.7 E0403 precision comes last in parameters
float f(highp in float a) { return a; }  //!

//# 4.7 E0403 storage comes before precision
highp uniform float a;  //!

//# 4.7 E0100 qualifiers come before the type
float const a = 1.0;  //!

//# 4.7 E0100 precision comes before the type
float highp a = 1.0;  //!

//# 4.3.7 E0403 ShaderToy binds no interface blocks
// WebGL 2 has them, but who feeds it?
uniform Block { float a; };  //!

//# 4.3.9 holds inputs may be interpolated in each way
flat in int a;
smooth in vec2 b;
centroid in float c;
flat in uvec3 d;
smooth centroid in vec4 e;
bool holds() { return true; }

//# 4.3.9 E0100 interpolation needs a declaration
in float a;
flat a;  //!

//# 4.3.8 E0100 a layout needs a declaration
float a;
layout(location = 0) a;  //!

//# 4.3.9 error centroid is not for outputs of a fragment shader
centroid out vec4 a;  //!

//# 4.6.1 error an input is not declared invariant
invariant in float a;  //!

//# 4.3.9 error interpolation qualifiers are not repeated
flat smooth in float a;  //!

// Constructors: §5.4.

//# 5.4.1 holds numbers are converted by name
bool holds() { float a = float(iFrame); int b = int(iTime); uint c = uint(iFrame); return a == 3.0 && b == 2 && c == 3u; }

//# 5.4.1 holds floats are cut off toward zero
bool holds() { float a = iTime + 0.75; return int(a) == 2 && int(-a) == -2 && uint(a) == 2u; }

//# 5.4.1 holds what is not 0 is true
bool holds() { return bool(iTime) && bool(iFrame) && bool(-0.5) && !bool(iFrame - 3) && !bool(0.0) && bool(1u); }

//# 5.4.1 holds true is 1
bool holds() { bool t = iTime > 1.0; return float(t) == 1.0 && int(!t) == 0 && uint(t) == 1u; }

//# 5.4.1 holds int and uint keep their bits
bool holds() { int a = iFrame - 4; return uint(a) == 0xFFFFFFFFu && int(uint(a)) == -1; }

//# 5.4.1 holds a type may be made of itself
bool holds() { return float(iTime) == 2.0 && bool(iTime > 1.0) && vec2(vec2(1.0, iTime)).y == 2.0; }

//# 5.4.1 holds a scalar is made of the first component
bool holds() { return float(vec3(iTime, 1.0, 0.0)) == 2.0 && int(ivec2(iFrame, 0)) == 3 && bool(bvec2(iTime > 1.0, false)); }

//# 5.4.1 holds a scalar is made of the first component of a matrix
bool holds() { return float(mat2(iTime, 5.0, 6.0, 7.0)) == 2.0; }

//# 5.4.2 holds one scalar fills a vector
bool holds() { return vec3(iTime) == vec3(2.0, 2.0, 2.0) && ivec2(iTime) == ivec2(2, 2) && bvec2(iFrame) == bvec2(true); }

//# 5.4.2 holds a vector is made of what gives its components
bool holds() { vec2 a = vec2(1.0, iTime); vec4 b = vec4(a, 3.0, 4.0), c = vec4(0.0, a, 5.0), d = vec4(a, a); return b.yz == vec2(2.0, 3.0) && c.yz == a && d.w == 2.0; }

//# 5.4.2 holds the last argument may give more than is needed
bool holds() { vec4 a = vec4(1.0, 2.0, 3.0, iTime); return vec3(0.0, a).z == 2.0 && vec2(a) == vec2(1.0, 2.0) && vec3(a).z == 3.0; }

//# 5.4.2 holds the components are converted
bool holds() { vec3 a = vec3(1, true, 2u); ivec2 b = ivec2(vec2(1.5, -1.5)); uvec2 c = uvec2(iFrame, 2.9); return a == vec3(1.0, 1.0, 2.0) && b == ivec2(1, -1) && c == uvec2(3u, 2u); }

//# 5.4.2 holds a vector is made of a vector of another type
bool holds() { ivec3 a = ivec3(iFrame, -1, 0); return vec3(a) == vec3(3.0, -1.0, 0.0) && bvec3(a) == bvec3(true, true, false) && uvec3(a).y == 0xFFFFFFFFu; }

//# 5.4.2 holds a vector of four is made of a matrix of four
bool holds() { return vec4(mat2(1.0, 2.0, 3.0, iTime)) == vec4(1.0, 2.0, 3.0, 2.0); }

//# 5.4.2 holds one scalar fills the diagonal of a matrix
bool holds() { return mat2(iTime) == mat2(2.0, 0.0, 0.0, 2.0) && mat2x3(iTime)[1] == vec3(0.0, 2.0, 0.0) && mat3x2(iTime)[2] == vec2(0.0); }

//# 5.4.2 holds a matrix is filled column by column
bool holds() { mat2 m = mat2(1.0, 2.0, 3.0, iTime); return m[0] == vec2(1.0, 2.0) && m[1][0] == 3.0 && m[1][1] == 2.0; }

//# 5.4.2 holds a matrix is made of its columns
bool holds() { mat2x3 m = mat2x3(vec3(1.0, 2.0, iTime), vec3(4.0)); return m[0].z == 2.0 && m[1] == vec3(4.0); }

//# 5.4.2 holds a matrix is made of vectors that cross its columns
bool holds() { mat3 m = mat3(vec2(1.0, 2.0), vec4(3.0, 4.0, 5.0, 6.0), vec3(7.0, 8.0, 9.0)); return m[0] == vec3(1.0, 2.0, 3.0) && m[1] == vec3(4.0, 5.0, 6.0) && m[2] == vec3(7.0, 8.0, 9.0); }

//# 5.4.2 holds a matrix is made of a vector of four
bool holds() { return mat2(vec4(1.0, 2.0, 3.0, iTime)) == mat2(1.0, 2.0, 3.0, 2.0); }

//# 5.4.2 holds a smaller matrix is cut from a larger one
bool holds() { mat3 m = mat3(1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, iTime); return mat2(m) == mat2(1.0, 2.0, 4.0, 5.0) && mat2x3(m)[1] == vec3(4.0, 5.0, 6.0); }

//# 5.4.2 holds a larger matrix is filled up with the unit matrix
bool holds() { mat2 m = mat2(1.0, 2.0, 3.0, iTime); mat3 a = mat3(m); return a[1] == vec3(3.0, 2.0, 0.0) && a[2] == vec3(0.0, 0.0, 1.0) && mat4(m)[3] == vec4(0.0, 0.0, 0.0, 1.0) && mat4x2(m)[3] == vec2(0.0); }

//# 5.4.2 holds the components of a matrix are converted
bool holds() { mat2 m = mat2(1, 2u, true, iFrame); return m == mat2(1.0, 2.0, 1.0, 3.0); }

//# 5.4.2 holds a matrix may be made of integers in vectors
bool holds() { return mat2(ivec2(1, 2), ivec2(3, iFrame)) == mat2(1.0, 2.0, 3.0, 3.0); }

//# 5.4.2 holds arguments are read from left to right once each
int n = 0;
float next() { n++; return float(n); }
bool holds() { vec3 v = vec3(next(), next(), next()); return v == vec3(1.0, 2.0, 3.0) && n == 3; }

//# 5.4.3 holds a structure is made of its members
struct S { float a; ivec2 b; };
bool holds() { S s = S(iTime, ivec2(iFrame)); return s.a == 2.0 && s.b.y == 3; }

//# 5.4.3 holds a structure may be made of structures and arrays
struct A { float a; };
struct B { A a; float b[2]; };
bool holds() { B b = B(A(iTime), float[2](1.0, 3.0)); return b.a.a == 2.0 && b.b[1] == 3.0; }

//# 5.4 holds a constructor is allowed where a value is
bool holds() { return vec2(1.0, iTime).y + float[](1.0, 2.0)[1] + mat2(2.0)[0].x == 6.0; }

//# 5.4 holds a constructor as a statement does nothing
bool holds() { vec2(1.0); float(1); return true; }

//# 5.4.1 E0303 a scalar takes one argument
float a = float(1.0, 2.0);  //!

//# 5.4.1 E0303 a scalar takes an argument
void f() {
    float();  //!
}

//# 5.4.1 E0303 a number is not made of a structure
struct S { float a; };
float f(S s) {
    return float(s);  //!
}

//# 5.4.1 E0303 a number is not made of an array
float f(float a[2]) {
    return float(a);  //!
}

//# 5.4.1 E0303 a number is not made of a sampler
float f() {
    return float(iChannel0);  //!
}

//# 5.4.1 E0303 a number is not made of nothing
void nothing() { }
float f() {
    return float(nothing());  //!
}

//# 5.4.1 E0303 a bool takes one argument
bool f() {
    return bool(true, false);  //!
}

//# 5.4.2 E0303 a vector needs all its components
vec3 a = vec3(1.0, 2.0);  //!

//# 5.4.2 E0303 a vector needs all its components, also from vectors
vec4 a = vec4(vec2(1.0), 1.0);  //!

//# 5.4.2 E0303 a vector is not made of a smaller one
vec3 f(vec2 v) {
    return vec3(v);  //!
}

//# 5.4.2 E0303 a vector takes no argument too many
vec2 a = vec2(1.0, 2.0, 3.0);  //!

//# 5.4.2 E0303 a vector takes no argument too many after a vector
vec2 f(vec2 v) {
    return vec2(v, 1.0);  //!
}

//# 5.4.2 E0303 a vector takes no argument too many after vectors
vec3 f(vec2 v) {
    return vec3(v, v, 1.0);  //!
}

//# 5.4.2 E0303 a vector needs arguments
void f() {
    vec2();  //!
}

//# 5.4.2 E0303 a vector is not made of an array
vec2 f(float a[2]) {
    return vec2(a);  //!
}

//# 5.4.2 E0303 a vector is not made of a structure
struct S { float a, b; };
vec2 f(S s) {
    return vec2(s);  //!
}

//# 5.4.2 E0303 a vector is not made of a sampler
vec2 f() {
    return vec2(iChannel0);  //!
}

//# 5.4.2 E0303 a matrix needs all its components
mat2 a = mat2(1.0, 2.0, 3.0);  //!

//# 5.4.2 E0303 a matrix takes no component too many
mat2 a = mat2(1.0, 2.0, 3.0, 4.0, 5.0);  //!

//# 5.4.2 E0303 a matrix needs all its columns
mat3 f(vec3 v) {
    return mat3(v, v);  //!
}

//# 5.4.2 E0303 a matrix takes no column too many
mat2 f(vec2 v) {
    return mat2(v, v, v);  //!
}

//# 5.4.2 E0303 a matrix is not made of one vector of its height
mat2 f(vec2 v) {
    return mat2(v);  //!
}

//# 5.4.2 E0303 a matrix is not made of a matrix and more
mat3 f(mat2 m) {
    return mat3(m, 1.0, 2.0, 3.0, 4.0, 5.0);  //!
}

//# 5.4.2 E0303 a matrix is not made of two matrices
mat4 f(mat2 m) {
    return mat4(m, m, m, m);  //!
}

//# 5.4.2 E0303 a matrix is not made of an array
mat2 f(float a[4]) {
    return mat2(a);  //!
}

//# 5.4.3 E0303 a structure needs all its members
struct S { float a, b; };
S f() {
    return S(1.0);  //!
}

//# 5.4.3 E0303 a structure takes no member too many
struct S { float a; };
S f() {
    return S(1.0, 2.0);  //!
}

//# 5.4.3 E0303 a structure is not made of nothing
struct S { float a; };
void f() {
    S();  //!
}

//# 5.4.3 E0301 a structure converts no member
struct S { float a; };
S f() {
    return S(1);  //!
}

//# 5.4.3 E0301 a structure spreads no vector over its members
struct S { vec2 a; float b; };
S f() {
    return S(vec2(1.0), vec2(1.0));  //!
}

//# 5.4.3 E0301 a structure takes its members in order
// ANGLE names the line of the constructor.
struct S { vec2 a; float b; };
S f() {
    return S(
        vec2(1.0),
        true  //!
    );
}

//# 5.4 E0303 void has no constructor
void f() {
    void(1.0);  //!
}

//# 5.4 E0303 samplers have no constructors
vec4 f() {
    return texture(sampler2D(1), vec2(0.0));  //!
}

//# 5.4 E0100 a type is not a value
float f() {
    return float;  //!
}

//# 5.4 E0200 a constructor is a known name
vec2 f() {
    return vec5(1.0);  //!
}

//# 5.4 E0200 HLSL's names are not GLSL's
vec3 f() {
    return float3(1.0, 2.0, 3.0);  //!
}

//# 5.4 E0100 arguments are parted by commas
vec2 a = vec2(1.0 2.0);  //!

//# 5.4 E0100 no comma follows the last argument
vec2 a = vec2(1.0, 2.0,);  //!

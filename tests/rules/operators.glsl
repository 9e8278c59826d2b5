// Operators, assignment and lvalues: §5.1 to §5.9.

//# 5.1 holds operators bind by their precedence
bool holds() { int a = iFrame; return a + 2 * a == 9 && a << 1 + 1 == 12 && (a | 4 & 6) == 7 && a - 1 - 1 == 1 && -a + a == 0; }

//# 5.1 holds comparison binds tighter than equality, and equality than &
bool holds() { return 1 < 2 == true && (6 & 3) == 2 && (1 | 2 ^ 3 & 1) == 3; }

//# 5.1 holds && binds tighter than ^^, and ^^ than ||
bool holds() { bool t = iTime > 1.0, f = !t; return (t || t ^^ t && f) && (f ^^ t || f); }

//# 5.1 holds assignment groups to the right
bool holds() { int a, b = 1; a = b = iFrame; a += b -= 1; return a == 5 && b == 2; }

//# 5.1 holds ?: groups to the right
bool holds() { int i = iFrame; return (i == 1 ? 10 : i == 3 ? 30 : 40) == 30; }

//# 5.9 holds scalars apply to each component
bool holds() { vec3 v = vec3(1.0, 2.0, 3.0); return 2.0 * v - 1.0 == vec3(1.0, 3.0, 5.0) && 6.0 / v == vec3(6.0, 3.0, 2.0); }

//# 5.9 holds vectors apply component by component
bool holds() { ivec2 a = ivec2(7, 8), b = ivec2(2, 3); return a * b == ivec2(14, 24) && a / b == ivec2(3, 2) && a % b == ivec2(1, 2); }

//# 5.9 holds a matrix times a vector is linear algebra
bool holds() { mat2 m = mat2(1.0, 2.0, 3.0, 4.0); vec2 v = vec2(1.0, iTime); return m * v == vec2(7.0, 10.0) && v * m == vec2(5.0, 11.0); }

//# 5.9 holds a matrix times a matrix is linear algebra
bool holds() { mat2 a = mat2(1.0, 2.0, 3.0, 4.0), b = mat2(0.0, 1.0, iTime, 0.0); return a * b == mat2(3.0, 4.0, 2.0, 4.0); }

//# 5.9 holds matrices that are not square multiply where they fit
bool holds() { mat2x3 a = mat2x3(1.0, 2.0, 3.0, 4.0, 5.0, 6.0); mat3x2 b = mat3x2(1.0); mat3 c = a * b; return c[1] == vec3(4.0, 5.0, 6.0) && a * vec2(1.0, 0.0) == vec3(1.0, 2.0, 3.0); }

//# 5.9 holds matrices are added, subtracted and divided by components
bool holds() { mat2 a = mat2(iTime), b = mat2(4.0, 4.0, 4.0, 4.0); return a + b == mat2(6.0, 4.0, 4.0, 6.0) && a / b == mat2(0.5) && (b - 1.0)[1][0] == 3.0 && (1.0 / b)[0][1] == 0.25; }

//# 5.9 holds v *= m multiplies the vector from the left
bool holds() { vec2 v = vec2(1.0, 2.0); v *= mat2(1.0, 2.0, 3.0, 4.0); return v == vec2(5.0, 11.0); }

//# 5.9 holds a compound assignment takes a scalar to a vector
bool holds() { ivec3 v = ivec3(1, 2, 3); v <<= 1; v += 1; v %= 4; return v == ivec3(3, 1, 3); }

//# 5.9 holds shifts take signs as they come
bool holds() { int a = -8; uint b = 3u; return a >> 1 == -4 && a >> b == -1 && 1u << iFrame == 8u && 0xF0000000u >> 28 == 15u; }

//# 5.9 holds a vector is shifted by a vector
bool holds() { return ivec2(1, 1) << ivec2(1, 2) == ivec2(2, 4) && uvec2(8u) >> uvec2(1u, 2u) == uvec2(4u, 2u) && ivec2(1) << 3u == ivec2(8); }

//# 5.9 holds bits are combined
bool holds() { int a = 12, b = 10; return (a & b) == 8 && (a | b) == 14 && (a ^ b) == 6 && ~a == -13 && (uvec2(5u) & 4u) == uvec2(4u); }

//# 5.9 holds integers wrap around
bool holds() { int a = 0x7FFFFFFF; uint b = 0u; a += iFrame - 2; b--; return a < 0 && b == 0xFFFFFFFFu; }

//# 5.9 holds integer division rounds toward zero
bool holds() { int a = -7; return a / (iFrame - 1) == -3 && 7 / 2 == 3 && 7u / 2u == 3u; }

//# 5.9 holds the remainder fits the quotient for positive numbers
bool holds() { int a = iFrame + 4; return a % 4 == 3 && a == a / 4 * 4 + a % 4 && 7u % 4u == 3u; }

//# 5.9 holds unsigned integers are negated modulo 2^32
bool holds() { uint a = uint(iFrame); return -a == 0xFFFFFFFDu && -a + a == 0u; }

//# 5.9 holds vectors and matrices are equal as a whole
bool holds() { return vec2(1.0, iTime) == vec2(1.0, 2.0) && vec2(1.0, iTime) != vec2(1.0) && mat2(1.0) != mat2(iTime) && bvec2(true, false) == bvec2(true, iTime < 1.0); }

//# 5.9 holds && does not ask its right side after false
int n = 0;
bool asked() { n++; return true; }
bool holds() { bool a = iTime < 1.0 && asked(); bool b = iTime > 1.0 && asked(); return n == 1 && !a && b; }

//# 5.9 holds || does not ask its right side after true
int n = 0;
bool asked() { n++; return true; }
bool holds() { bool a = iTime > 1.0 || asked(); bool b = iTime < 1.0 || asked(); return n == 1 && a && b; }

//# 5.9 holds ^^ evaluates both sides
int n = 0;
bool asked() { n++; return true; }
bool holds() { bool a = asked() ^^ asked(); return n == 2 && !a; }

//# 5.9 holds ?: evaluates one side only
int n = 0;
int asked(int by) { n += by; return n; }
bool holds() { int a = iTime > 1.0 ? asked(1) : asked(10); return a == 1 && n == 1; }

//# 5.9 holds ?: chooses whole vectors and matrices
bool holds() { vec3 v = iTime > 1.0 ? vec3(1.0) : vec3(2.0); mat2 m = iTime < 1.0 ? mat2(1.0) : mat2(3.0); return v == vec3(1.0) && m[1][1] == 3.0; }

//# 5.9 holds a sequence has the value of its last part
bool holds() { int a = 1; int b = (a += 2, a * 2); return b == 6; }

//# 5.9 holds stepping before gives the new value, stepping after the old one
bool holds() { int a = 1; int b = a++ * 10; int c = ++a; float x = 1.5; float y = x--; return b == 10 && c == 3 && a == 3 && x == 0.5 && y == 1.5; }

//# 5.9 holds vectors and matrices are stepped by components
bool holds() { vec2 v = vec2(1.0, 2.0); vec2 w = v++; mat2 m = mat2(1.0); --m; return v == vec2(2.0, 3.0) && w == vec2(1.0, 2.0) && m == mat2(0.0, -1.0, -1.0, 0.0); }

//# 5.5 holds components have three sets of names
bool holds() { vec4 v = vec4(1.0, 2.0, 3.0, 4.0); return v.xyzw == v.rgba && v.stpq == v.rgba && v.y == v.g && v.q == v.w; }

//# 5.5 holds components are chosen in any order, and more than once
bool holds() { vec2 v = vec2(1.0, iTime); return v.yx == vec2(2.0, 1.0) && v.xxyy == vec4(1.0, 1.0, 2.0, 2.0) && v.yy.x == 2.0; }

//# 5.5 holds components are written in any order
bool holds() { vec4 v = vec4(0.0); v.wx = vec2(1.0, 2.0); v.yz += 3.0; v.zyx.y = 5.0; return v == vec4(2.0, 5.0, 3.0, 1.0); }

//# 5.5 holds components of components and of elements are written
bool holds() { mat3 m = mat3(0.0); m[1].zx = vec2(1.0, 2.0); vec2 a[2]; a[1].y = 3.0; return m[1] == vec3(2.0, 0.0, 1.0) && a[1].y == 3.0; }

//# 5.5 holds a swap by swizzle reads before it writes
bool holds() { vec2 v = vec2(1.0, iTime); v = v.yx; v.xy = v.yx + v.xx; return v == vec2(3.0, 4.0); }

//# 5.8 holds an assignment is a value
bool holds() { float a; return (a = iTime) + a == 4.0; }

//# 5.8 holds parentheses keep an lvalue
bool holds() { float a = 1.0; (a) = iTime; vec2 v; (v.x) = a; return a == 2.0 && v.x == 2.0; }

//# 5.9 holds == of structures compares all members
struct S { int a; vec2 b; };
bool holds() { S s = S(1, vec2(2.0)), t = s; bool same = s == t; t.b.y = 0.0; return same && s != t; }

//# 5.9 holds unary plus and minus
bool holds() { vec2 v = vec2(1.0, -2.0); int a = +iFrame; return -v == vec2(-1.0, 2.0) && +v == v && - -a == 3 && -mat2(1.0) == mat2(-1.0); }

//# 5.9 E0300 there are no conversions: int and float
float f() {
    return 1.0 + 1;  //!
}

//# 5.9 E0300 there are no conversions: float and int
float f(int i) {
    return 2.0 * i;  //!
}

//# 5.9 E0300 there are no conversions: int and uint
uint f(uint u) {
    return u + 1;  //!
}

//# 5.9 E0300 there are no conversions: vectors of float and int
vec2 f(vec2 v) {
    return v * ivec2(1);  //!
}

//# 5.9 E0300 there are no conversions in comparison
bool f(float a) {
    return a > 0;  //!
}

//# 5.9 E0300 there are no conversions in equality
bool f(float a) {
    return a == 0;  //!
}

//# 5.9 E0300 vectors of different sizes are not added
vec3 f(vec2 a, vec3 b) {
    return a + b;  //!
}

//# 5.9 E0300 bools are not added
bool f(bool a, bool b) {
    return a + b;  //!
}

//# 5.9 E0300 bools are not multiplied
bool f(bvec2 a) {
    return a * a == a;  //!
}

//# 5.9 E0300 a bool is not negated with minus
bool f(bool a) {
    return -a;  //!
}

//# 5.9 E0300 only bools are negated with !
bool f(int a) {
    return !a;  //!
}

//# 5.9 E0300 ! takes no vectors
bvec2 f(bvec2 a) {
    return !a;  //!
}

//# 5.9 E0300 ~ takes no floats
float f(float a) {
    return ~a;  //!
}

//# 5.9 E0300 % takes no floats
float f(float a) {
    return a % 2.0;  //!
}

//# 5.9 E0300 & takes no floats
float f(float a) {
    return a & 1.0;  //!
}

//# 5.9 E0300 | takes no bools
bool f(bool a) {
    return a | true;  //!
}

//# 5.9 E0300 & takes one kind of integers
int f(int a, uint b) {
    return a & b;  //!
}

//# 5.9 E0300 % takes vectors of one size
ivec2 f(ivec2 a, ivec3 b) {
    return a % b;  //!
}

//# 5.9 E0300 << takes no floats
int f(int a) {
    return a << 1.0;  //!
}

//# 5.9 E0300 a scalar is not shifted by a vector
ivec2 f(int a) {
    return a << ivec2(1);  //!
}

//# 5.9 E0300 vectors of different sizes are not shifted
ivec2 f(ivec2 a, ivec3 b) {
    return a >> b;  //!
}

//# 5.9 E0300 && takes bools only
bool f(int a) {
    return a && true;  //!
}

//# 5.9 E0300 || takes no vectors
bool f(bvec2 a, bvec2 b) {
    return a || b == a;  //!
}

//# 5.9 E0300 ^^ takes bools only
bool f(float a) {
    return a ^^ true;  //!
}

//# 5.9 E0300 < takes no vectors
bool f(vec2 a, vec2 b) {
    return a < b;  //!
}

//# 5.9 E0300 < takes no bools
bool f(bool a, bool b) {
    return a < b;  //!
}

//# 5.9 E0300 >= takes no structures
struct S { float a; };
bool f(S a, S b) {
    return a >= b;  //!
}

//# 5.9 E0300 comparisons do not chain
bool f(float a) {
    return 0.0 < a < 1.0;  //!
}

//# 5.9 E0300 == takes equal types: vectors
bool f(vec2 a, vec3 b) {
    return a == b;  //!
}

//# 5.9 E0300 == takes equal types: structures
struct S { float a; };
struct T { float a; };
bool f(S a, T b) {
    return a == b;  //!
}

//# 5.9 E0300 samplers are not compared
bool f() {
    return iChannel0 == iChannel1;  //!
}

//# 5.9 E0300 structures are not added
struct S { float a; };
void f(S a, S b) {
    a + b;  //!
}

//# 5.9 E0300 a matrix is not multiplied by a vector of another size
vec2 f(mat2 m, vec3 v) {
    return m * v;  //!
}

//# 5.9 E0300 matrices are multiplied if columns match rows
mat2x3 f(mat2x3 a, mat2x3 b) {
    return a * b;  //!
}

//# 5.9 E0300 matrices of different sizes are not added
mat2 f(mat2 a, mat3 b) {
    return a + b;  //!
}

//# 5.9 E0300 a matrix and a vector are not added
mat2 f(mat2 a, vec2 b) {
    return a + b;  //!
}

//# 5.9 E0300 a void call is not an operand
void nothing() { }
float f() {
    return nothing() + 1.0;  //!
}

//# 5.9 E0300 a bool is not stepped
void f(bool a) {
    a++;  //!
}

//# 5.9 E0300 a structure is not stepped
struct S { float a; };
void f(S a) {
    --a;  //!
}

//# 5.9 E0301 the condition of ?: is a bool
float f(float a) {
    return a ? 1.0 : 2.0;  //!
}

//# 5.9 E0301 the condition of ?: is one bool
vec2 f(bvec2 a) {
    return a ? vec2(1.0) : vec2(2.0);  //!
}

//# 5.9 E0301 the sides of ?: have one type
float f(bool a) {
    return a ? 1.0 : 2;  //!
}

//# 5.9 E0307 ?: does not choose between calls without value
// glslang lets it.
void nothing() { }
void f(bool a) {
    a ? nothing() : nothing();  //!
}

//# 5.9 E0307 ?: does not choose arrays in WebGL
// glslang and the specification allow it.
float f(bool b, float x[2], float y[2]) {
    return (b ? x : y)[0];  //!
}

//# 5.9 E0307 ?: does not choose structures in WebGL
// glslang and the specification allow it.
struct S { float a; };
float f(bool b, S x, S y) {
    return (b ? x : y).a;  //!
}

//# 5.9 E0307 ?: does not choose samplers
vec4 f(bool b) {
    return texture(b ? iChannel0 : iChannel1, vec2(0.0));  //!
}

//# 5.8 E0301 an assignment takes the type of its target
void f(float a) {
    a = 1;  //!
}

//# 5.8 E0301 a vector does not become a scalar by assignment
void f(float a, vec2 b) {
    a = b;  //!
}

//# 5.8 E0301 a scalar does not become a vector by assignment
void f(vec2 a) {
    a = 1.0;  //!
}

//# 5.8 E0301 a bool does not become a number
void f(int a) {
    a = true;  //!
}

//# 5.8 E0301 structures of one shape and two names are two types
struct S { float a; };
struct T { float a; };
void f(S a, T b) {
    a = b;  //!
}

//# 5.8 E0300 a compound assignment keeps the type of its target
void f(float a) {
    a *= vec2(2.0);  //!
}

//# 5.8 E0300 a compound assignment keeps the size of its target
void f(vec3 v) {
    v *= mat3x2(1.0);  //!
}

//# 5.8 E0300 a compound assignment converts nothing
void f(int a) {
    a += 1.0;  //!
}

//# 5.8 E0300 a compound shift takes integers
void f(float a) {
    a <<= 1;  //!
}

//# 5.8 E0400 a number is not assigned to
void f() {
    1.0 = 2.0;  //!
}

//# 5.8 E0400 a sum is not assigned to
void f(float a) {
    a + 1.0 = 2.0;  //!
}

//# 5.8 E0400 a call is not assigned to
float g() { return 1.0; }
void f() {
    g() = 2.0;  //!
}

//# 5.8 E0400 a component of a call is not assigned to
vec2 g() { return vec2(1.0); }
void f() {
    g().x = 2.0;  //!
}

//# 5.8 E0400 a choice is not assigned to
void f(bool c, float a, float b) {
    (c ? a : b) = 2.0;  //!
}

//# 5.8 E0400 an assignment is not assigned to
void f(float a, float b) {
    (a = b) = 2.0;  //!
}

//# 5.8 E0400 a step is not stepped
void f(int a) {
    a++++;  //!
}

//# 5.8 E0400 a constructor is not assigned to
void f() {
    vec2(1.0) = vec2(2.0);  //!
}

//# 5.8 E0400 a sequence is not assigned to
void f(float a, float b) {
    (a, b) = 2.0;  //!
}

//# 5.8 E0400 the place of a fragment is not assigned to
void f() {
    gl_FragCoord.z = 1.0;  //!
}

//# 5.5 E0400 a swizzle with a component twice is not assigned to
void f(vec2 v) {
    v.xx = vec2(1.0);  //!
}

//# 5.5 E0400 a swizzle with a component twice is not stepped
void f(vec2 v) {
    v.yxy++;  //!
}

//# 5.5 E0203 a component exists
float f(vec2 v) {
    return v.z;  //!
}

//# 5.5 E0203 a color component exists
float f(vec3 v) {
    return v.a;  //!
}

//# 5.5 E0203 the sets of names are not mixed
vec2 f(vec4 v) {
    return v.xg;  //!
}

//# 5.5 E0203 no more than four components are chosen
void f(vec4 v) {
    v.xyzwx;  //!
}

//# 5.5 E0203 a component has a known name
float f(vec4 v) {
    return v.u;  //!
}

//# 5.5 E0203 a scalar has no components
float f(float a) {
    return a.x;  //!
}

//# 5.5 E0203 a matrix has no components by name
vec2 f(mat2 m) {
    return m.x;  //!
}

//# 5.5 E0100 a point is followed by a name
float f(vec2 v) {
    return v.;  //!
}

//# 5.1 E0100 an operator has two sides
float f(float a) {
    return a *;  //!
}

//# 5.1 E0105 parentheses close
float f(float a) {
    return (a * 2.0;  //!
}

//# 5.1 E0100 there is no address-of operator
void f(float a) {
    &a;  //!
}

//# 5.1 E0100 there is no dereference operator
void f(float a) {
    *a;  //!
}

//# 5.1 E0100 ?: has a colon
float f(bool a) {
    return a ? 1.0;  //!
}

//# 5.1 E0100 there are no casts
float f(int a) {
    return (float) a;  //!
}

//# 5.9 E0100 empty parentheses are no value
float f() {
    return ();  //!
}

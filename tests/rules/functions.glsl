// Functions: declarations, definitions, calls and overloads: §6.1.

//# 6.1 holds a function may be declared many times and defined once
float f(float a);
float f(float b);
float f(float) { return iTime; }
float f(float c);
bool holds() { return f(1.0) == 2.0; }

//# 6.1 holds a function without parameters may say so
float f(void) { return iTime; }
bool holds() { return f() == 2.0 && f(void) == 2.0; }

//# 6.1 holds parameters need no names
float f(float, int b, bool) { return float(b); }
bool holds() { return f(1.0, iFrame, true) == 3.0; }

//# 6.1 holds functions are told apart by the number of their parameters
int f() { return 0; }
int f(float a) { return 1; }
int f(float a, float b) { return 2; }
bool holds() { return f() == 0 && f(1.0) == 1 && f(1.0, 2.0) == 2; }

//# 6.1 holds functions are told apart by the types of their parameters
int f(float a) { return 1; }
int f(int a) { return 2; }
int f(uint a) { return 3; }
int f(bool a) { return 4; }
int f(vec2 a) { return 5; }
int f(mat2 a) { return 6; }
bool holds() { return f(1.0) == 1 && f(1) == 2 && f(1u) == 3 && f(true) == 4 && f(vec2(1.0)) == 5 && f(mat2(1.0)) == 6; }

//# 6.1 holds functions are told apart by structures
struct S { float a; };
struct T { float a; };
int f(S s) { return 1; }
int f(T t) { return 2; }
bool holds() { return f(S(1.0)) == 1 && f(T(1.0)) == 2; }

//# 6.1 holds functions are told apart by the sizes of arrays
int f(float a[2]) { return 2; }
int f(float a[3]) { return 3; }
bool holds() { float a[2], b[3]; return f(a) == 2 && f(b) == 3; }

//# 6.1 holds overloads may have different results and directions
float f(float a) { return a; }
void f(out int a) { a = 5; }
bool holds() { int i; f(i); return f(iTime) == 2.0 && i == 5; }

//# 6.1 holds an overload may call another
float f(float a) { return a + 1.0; }
vec2 f(vec2 a) { return vec2(f(a.x), f(a.y)); }
bool holds() { return f(vec2(1.0, iTime)) == vec2(2.0, 3.0); }

//# 6.1 holds an overload may be declared after a call of another
float f(float a) { return a; }
float g() { return f(iTime); }
float f(int a) { return 9.0; }
bool holds() { return g() == 2.0 && f(1) == 9.0; }

//# 6.1 holds prototypes allow functions in any order
float even(int n);
float twice(int n) { return even(n) * 2.0; }
float even(int n) { return n % 2 == 0 ? 1.0 : 0.0; }
bool holds() { return twice(2) == 2.0 && twice(iFrame) == 0.0; }

//# 6.1 holds a prototype that nobody calls needs no body
float never(float a);
bool holds() { return true; }

//# 6.1 holds a function may return a structure, an array or a matrix
struct S { float a; };
S s() { return S(iTime); }
float[2] a() { return float[](1.0, iTime); }
mat2 m() { return mat2(iTime); }
bool holds() { return s().a == 2.0 && a()[1] == 2.0 && m()[1].y == 2.0; }

//# 6.1 holds a function may end on many ways
int f(int n) { if (n < 0) return -1; for (int i = 0; i < 10; i++) if (i * i >= n) return i; return 99; }
bool holds() { return f(-5) == -1 && f(iFrame) == 2 && f(1000) == 99; }

//# 6.1 holds a function without value may return
int n = 0;
void f(bool stop) { n++; if (stop) return; n += 10; }
bool holds() { f(true); f(false); return n == 12; }

//# 6.1 holds a function without value needs no return
float x;
void f() { x = iTime; }
bool holds() { f(); return x == 2.0; }

//# 6.1 holds the value of a call may be left alone
int n = 0;
int f() { return ++n; }
bool holds() { f(); f(); return n == 2; }

//# 6.1.1 holds arguments are copied in before the call
float x = 1.0;
float f(float a) { x = 5.0; return a; }
bool holds() { return f(x) == 1.0 && x == 5.0; }

//# 6.1.1 holds out arguments are copied back after the call
float x = 1.0;
float f(out float a) { a = 5.0; return x; }
bool holds() { float seen = f(x); return seen == 1.0 && x == 5.0; }

//# 6.1.1 holds two inout arguments are two copies
void f(inout float a, inout float b) { a += 1.0; b += 10.0; }
bool holds() { float a = 1.0, b = 2.0; f(a, b); return a == 2.0 && b == 12.0; }

//# 6.1.1 holds an argument is evaluated once
int n = 0;
int next() { return ++n; }
int f(int a, int b) { return a * 10 + b; }
bool holds() { return f(next(), next()) == 12 && n == 2; }

//# 6.1.1 holds out arguments may be components, swizzles, elements and members
struct S { vec2 a; };
void f(out float a, out vec2 b) { a = 7.0; b = vec2(8.0, 9.0); }
bool holds() {
    vec4 v = vec4(0.0); float a[2]; S s; mat2 m;
    f(v.y, v.wx); f(a[1], s.a); f(m[1][0], m[0]);
    return v == vec4(9.0, 7.0, 0.0, 8.0) && a[1] == 7.0 && s.a == vec2(8.0, 9.0) && m[1].x == 7.0 && m[0].y == 9.0;
}

//# 6.1.1 holds the place of an out argument is found before the call
int i = 0;
void f(out int a) { i = 1; a = 5; }
bool holds() { int a[2] = int[](0, 0); f(a[i]); return a[0] == 5 && a[1] == 0; }

//# 6.1.1 holds structures and arrays are inout as a whole
struct S { float a[2]; };
void f(inout S s, inout float a[2]) { s.a[0] = a[1]; a[0] = 4.0; }
bool holds() { S s; float a[2] = float[](1.0, 2.0); f(s, a); return s.a[0] == 2.0 && a[0] == 4.0; }

//# 6.1.1 holds an out argument may be passed on
void g(out float a) { a = 3.0; }
void f(out float a) { g(a); a += 1.0; }
bool holds() { float a; f(a); return a == 4.0; }

//# 6.1 holds samplers are parameters
vec4 f(sampler2D s, ivec2 at) { return texelFetch(s, at, 0); }
vec4 g(const in sampler2D s) { return f(s, ivec2(1, 2)); }
bool holds() { return g(iChannel0).xy == vec2(0.25, 0.5); }

//# 6.1 holds what a function leaves local is new at each call
float f(bool set) { float a = 0.0; if (set) a = 5.0; return a; }
bool holds() { return f(true) == 5.0 && f(false) == 0.0; }

//# 6.1.2 holds functions may call functions in a long row
int a(int n) { return n + 1; }
int b(int n) { return a(n) + a(n); }
int c(int n) { return b(n) + a(n); }
int d(int n) { return c(n) + b(n) + a(n); }
bool holds() { return d(iFrame) == 24; }

//# 6.1 E0302 a call has an argument for each parameter: too few
float f(float a, float b) { return a; }
float g() {
    return f(1.0);  //!
}

//# 6.1 E0302 a call has an argument for each parameter: too many
float f(float a) { return a; }
float g() {
    return f(1.0, 2.0);  //!
}

//# 6.1 E0302 a call has an argument for each parameter: no arguments
float f(float a) { return a; }
float g() {
    return f();  //!
}

//# 6.1 E0302 an argument is not converted: int to float
float f(float a) { return a; }
float g() {
    return f(1);  //!
}

//# 6.1 E0302 an argument is not converted: float to int
float f(int a) { return 1.0; }
float g() {
    return f(1.0);  //!
}

//# 6.1 E0302 an argument is not converted: int to uint
float f(uint a) { return 1.0; }
float g() {
    return f(1);  //!
}

//# 6.1 E0302 an argument has the size of its parameter
float f(vec3 a) { return a.x; }
float g(vec2 v) {
    return f(v);  //!
}

//# 6.1 E0302 an argument has the structure of its parameter
struct S { float a; };
struct T { float a; };
float f(S s) { return s.a; }
float g(T t) {
    return f(t);  //!
}

//# 6.1 E0302 an overload must match
float f(float a) { return a; }
float f(vec2 a) { return a.x; }
float g(vec3 v) {
    return f(v);  //!
}

//# 6.1 E0302 a void call is not an argument
void nothing() { }
float f(float a) { return a; }
float g() {
    return f(nothing());  //!
}

//# 6.1 E0302 an out argument is not converted
void f(out float a) { a = 1.0; }
void g() {
    int i;
    f(i);  //!
}

//# 6.1 E0302 the order of the arguments counts
float f(float a, vec2 b) { return a; }
float g() {
    return f(vec2(1.0), 1.0);  //!
}

//# 6.1 E0200 a function exists
float g() {
    return f(1.0);  //!
}

//# 6.1 E0200 HLSL's functions are not GLSL's
float g(float a) {
    return saturate(a);  //!
}

//# 6.1 E0201 a function is defined once
float f() { return 1.0; }
float f() { return 2.0; }  //!

//# 6.1 E0201 a function is defined once, whatever its parameters are called
float f(float a) { return 1.0; }
float f(float b) { return 2.0; }  //!

//# 6.1 E0406 a function does not differ by its result alone
float f(float a) { return a; }
int f(float a) { return 1; }  //!

//# 6.1 E0406 a prototype and its function have one result
float f(float a);
int f(float a) { return 1; }  //!

//# 6.1 E0406 a function does not differ by the direction of its parameters alone
void f(in float a) { }
void f(out float a) { }  //!

//# 6.1 E0406 a prototype and its function have the same directions
void f(inout float a);
void f(out float a) { }  //!

//# 6.1 E0406 a prototype and its function agree about const
void f(const float a);
void f(float a) { }  //!

//# 6.1 E0405 what is called has a body
// glslang leaves it to the linker.
float f(float a);
float g() {
    return f(1.0);  //!
}

//# 6.1 E0100 a function is not defined inside of another
void f() {
    void g() { }  //!
}

//# 6.1 E0100 a function is not declared inside of another
void f() {
    float g(float a);  //!
}

//# 6.1 E0100 a parameter has a type
float f(a) { return 1.0; }  //!

//# 6.1 E0100 parameters are parted by commas
float f(float a float b) { return 1.0; }  //!

//# 6.1 E0100 each parameter has its own type
float f(float a, b) { return 1.0; }  //!

//# 6.1 E0100 a parameter has no default
float f(float a = 1.0) { return a; }  //!

//# 6.1 E0307 a parameter is not void
float f(void a) { return 1.0; }  //!

//# 6.1 E0307 no parameter among others is void
float f(float a, void) { return 1.0; }  //!

//# 6.1 error a function has a result
f(float a) { return a; }  //!

//# 6.1 E0100 a structure is not declared as a parameter
// glslang lets it.
float f(struct S { float a; } s) { return s.a; }  //!

//# 6.1 holds a structure may be declared as a result
struct S { float a; } f() { return S(iTime); }
bool holds() { S s = f(); return s.a == 2.0; }

//# 6.1 E0307 a function returns no sampler
sampler2D f() {  //!
    return iChannel0;
}

//# 6.1 E0307 a sampler is not out
void f(out sampler2D s) { }  //!

//# 6.1 E0307 a sampler is not inout
void f(inout sampler2D s) { }  //!

//# 6.1 E0400 a sampler is not assigned to
void f(sampler2D s) {
    s = iChannel0;  //!
}

//# 6.1 E0302 a sampler argument has the shape of its parameter
vec4 f(samplerCube s) { return texture(s, vec3(1.0)); }
vec4 g(sampler2D s) {
    return f(s);  //!
}

//# 6.1.1 E0400 an out argument is an lvalue, not a number
void f(out float a) { a = 1.0; }
void g() {
    f(1.0);  //!
}

//# 6.1.1 E0400 an inout argument is an lvalue, not a sum
void f(inout float a) { }
void g(float b) {
    f(b + 1.0);  //!
}

//# 6.1.1 E0400 an out argument is not a constant
void f(out float a) { a = 1.0; }
const float c = 1.0;
void g() {
    f(c);  //!
}

//# 6.1.1 E0400 an out argument is not an input
void f(out float a) { a = 1.0; }
void g() {
    f(iTime);  //!
}

//# 6.1.1 E0400 an out argument is not a const parameter
void f(out float a) { a = 1.0; }
void g(const float b) {
    f(b);  //!
}

//# 6.1.1 E0400 an out argument names no component twice
void f(out vec2 a) { a = vec2(1.0); }
void g(vec2 v) {
    f(v.xx);  //!
}

//# 6.1.1 E0400 an out argument is not a call
void f(out float a) { a = 1.0; }
float h() { return 1.0; }
void g() {
    f(h());  //!
}

//# 6.4 E0308 a function with a result returns a value
float f() {
    return;  //!
}

//# 6.4 E0308 a function without a result returns no value
void f() {
    return 1.0;  //!
}

//# 6.4 E0308 what is returned is not converted
float f() {
    return 1;  //!
}

//# 6.4 E0308 what is returned has the size of the result
vec3 f() {
    return vec4(1.0);  //!
}

//# 6.4 E0308 what is returned has the structure of the result
struct S { float a; };
S f() {
    return 1.0;  //!
}

//# 6.4 E0308 a function with a result returns somewhere
float f(float a) {  //!
    a += 1.0;
}

//# 6.4 E0308 not even the call of a function without value is returned
// glslang lets it.
void g() { }
void f() {
    return g();  //!
}

//# 6.1.2 E0404 a function does not call itself
// glslang leaves it to the linker.
int factorial(int n) {
    return n <= 1 ? 1 : n * factorial(n - 1);  //!
}

//# 6.1.2 E0404 a function does not call itself where it is never reached
// glslang leaves it to the linker.
void f() {
    if (false) f();  //!
}

//# 6.1.2 error two functions do not call each other
// glslang leaves it to the linker.
void g();
void f() { g(); }  //!
void g() { f(); }

//# 6.1.2 holds a call of an overload is not recursion
float f(vec2 v) { return v.x; }
float f(float a) { return f(vec2(a)); }
bool holds() { return f(iTime) == 2.0; }

//# 6.1 E0202 a variable is not called
float f(float a) {
    return a(1.0);  //!
}

//# 6.1 error what a call gives is not called
float f() { return 1.0; }
float g() {
    return f()();  //!
}

//# 6.1 E0201 main is ShaderToy's
// On the site its header defines it.
void main() { }  //!

//# 6.1 E0105 a body ends
// ANGLE names the last line.
void mainImage(out vec4 c, in vec2 p) {  //!
    c = vec4(1.0);

//# 6.1 E0105 a body ends before the next function
// glslang names the next function.
float f() {  //!
    return 1.0;
void mainImage(out vec4 c, in vec2 p) { c = vec4(f()); }

// Types and structures: §4.1.

//# 4.1 holds a variable that nobody wrote is 0 in WebGL
bool holds() { float a; vec3 b; mat2 c; int d[2]; bool e; return a == 0.0 && b == vec3(0.0) && c == mat2(0.0) && d[1] == 0 && !e; }

//# 4.1 holds a global variable that nobody wrote is 0 in WebGL
struct S { float a; ivec2 b; };
S s;
uint u;
bool holds() { return s == S(0.0, ivec2(0)) && u == 0u; }

//# 4.1.1 holds void is for functions without value
void f(void) { }
bool holds() { f(); return true; }

//# 4.1.1 E0307 a variable is not void
void a;  //!

//# 4.1.1 E0307 a local variable is not void
void f() {
    void a;  //!
}

//# 4.1.1 E0307 a member is not void
struct S {
    void a;  //!
};

//# 4.1.1 error a void call has no value to assign
void nothing() { }
void f() {
    float a = nothing();  //!
}

//# 4.1.2 holds true and false are bools
bool yes = true, no = false;
bool holds() { return yes && !no && yes != no; }

//# 4.1.2 E0301 a bool is not a number
bool a = 1;  //!

//# 4.1.2 E0301 a number is not a bool
int a = true;  //!

//# 4.1.3 E0301 an int is not a uint
uint a = 1;  //!

//# 4.1.3 E0301 a uint is not an int
int a = 1u;  //!

//# 4.1.3 E0301 a float is not an int
int a = 1.0;  //!

//# 4.1.4 E0301 an int is not a float
float a = 1;  //!

//# 4.1.4 E0301 a negative int is not a float
float a = -1;  //!

//# 4.1.5 E0301 vectors of different sizes are different
vec3 a = vec2(1.0);  //!

//# 4.1.5 E0301 a vector of ints is not a vector of floats
vec2 a = ivec2(1);  //!

//# 4.1.5 E0301 a scalar is not a vector
vec3 a = 1.0;  //!

//# 4.1.5 error a vector has at least two components
vec1 a;  //!

//# 4.1.5 error a vector has at most four components
vec5 a;  //!

//# 4.1.5 error Metal's and HLSL's types are not GLSL's
float3 a;  //!

//# 4.1.6 holds matCxR has C columns of R rows
bool holds() { mat2x3 m = mat2x3(1.0, 2.0, 3.0, 4.0, 5.0, iTime); vec3 column = m[1]; return column == vec3(4.0, 5.0, 2.0); }

//# 4.1.6 holds matN is matNxN
bool holds() { mat3 a = mat3x3(iTime); mat2x2 b = mat2(1.0); return a[2][2] == 2.0 && b == mat2x2(1.0); }

//# 4.1.6 E0301 matrices of different shape are different
mat2 a = mat2x3(1.0);  //!

//# 4.1.6 E0301 columns and rows are not swapped
mat2x3 a = mat3x2(1.0);  //!

//# 4.1.6 E0301 a scalar is not a matrix
mat2 a = 1.0;  //!

//# 4.1.6 error there are no matrices of five
mat5 a;  //!

//# 4.1.6 error there are no matrices of ints
imat2 a;  //!

//# 4.1.6 error a matrix has more than one column
mat1x2 a;  //!

//# 4.1.6 E0301 a column has as many components as there are rows
void f(mat2x3 m) {
    m[0] = vec2(1.0);  //!
}

//# 4.1.7 E0307 a sampler is not a local variable
void f() {
    sampler2D s;  //!
}

//# 4.1.7 E0307 a sampler is not a plain global
sampler2D s;  //!

//# 4.1.7 E0307 a sampler is not a constant
const sampler2D s = iChannel0;  //!

//# 4.1.7 E0307 a structure with a sampler is not a local variable
struct S { sampler2D s; };
void f() {
    S s;  //!
}

//# 4.1.7 E0304 a sampler has no elements
vec4 f(sampler2D s) {
    return s[0];  //!
}

//# 4.1.7 E0300 samplers are not added
void f(sampler2D s) {
    s + s;  //!
}

//# 4.1.7 E0203 a sampler has no members
void f(sampler2D s) {
    s.x;  //!
}

//# 4.1.8 holds members are read and written by name
struct S { float a; vec2 b; };
bool holds() { S s; s.a = iTime; s.b.y = 3.0; return s.a + s.b.x + s.b.y == 5.0; }

//# 4.1.8 holds structures are values
struct S { int a; };
bool holds() { S s = S(iFrame), t = s; t.a++; return s.a == 3 && t.a == 4; }

//# 4.1.8 holds structures hold structures
struct A { float a; };
struct B { A a, b; };
bool holds() { B b; b.b.a = iTime; b.a = b.b; return b.a.a == 2.0; }

//# 4.1.8 holds a structure and a variable are declared together
struct S { float a; } s = S(1.0), t;
bool holds() { t.a = iTime; return s.a + t.a == 3.0; }

//# 4.1.8 holds a structure needs no name
struct { float a; int b[2]; } s;
bool holds() { s.a = iTime; s.b[1] = 3; return s.a == 2.0 && s.b[1] == 3; }

//# 4.1.8 holds a structure may be local
bool holds() { struct S { float a; } s = S(iTime); S t = s; return t.a == 2.0; }

//# 4.1.8 holds members may be declared together and be arrays
struct S { float a, b[2], c; vec2[2] d; };
bool holds() { S s; s.b[1] = iTime; s.c = 1.0; s.d[1] = vec2(3.0); return s.b[1] + s.c + s.d[1].x == 6.0; }

//# 4.1.8 holds arrays of structures are written by element
struct S { float a; vec2 b; };
bool holds() { S s[3]; for (int i = 0; i < 3; i++) s[i] = S(float(i), vec2(i)); s[1].b.x = 7.0; return s[iFrame - 1].a == 2.0 && s[1].b == vec2(7.0, 1.0); }

//# 4.1.8 holds a structure may be const
struct S { float a; vec2 b; };
const S s = S(1.0, vec2(2.0));
bool holds() { return s.a + s.b.y == 3.0; }

//# 4.1.8 holds a matrix may be a member
struct S { mat2 m; mat3x2 n; };
bool holds() { S s; s.m = mat2(iTime); s.n[2].y = 5.0; return s.m[1].y == 2.0 && s.n[2] == vec2(0.0, 5.0); }

//# 4.1.8 holds structures nest four levels deep
struct A { float a; };
struct B { A a; };
struct C { B b; };
struct D { C c; };
bool holds() { D d; d.c.b.a.a = iTime; return d.c.b.a.a == 2.0; }

//# 4.1.8 E0101 structures nest no deeper than WebGL allows
// glslang has no limit.
struct A { float a; };
struct B { A a; };
struct C { B b; };
struct D { C c; };
struct E { D d; };  //!
E e;

//# 4.1.8 E0203 a member exists
struct S { float a; };
float f(S s) {
    return s.b;  //!
}

//# 4.1.8 E0203 the case of a member counts
struct S { float radius; };
float f(S s) {
    return s.Radius;  //!
}

//# 4.1.8 E0203 a structure has no methods
struct S { float a; };
float f(S s) {
    return s.a();  //!
}

//# 4.1.8 E0203 a structure has no length
struct S { float a; };
int f(S s) {
    return s.length();  //!
}

//# 4.1.8 E0201 two members have two names
// ANGLE names the line of the structure.
struct S {
    float a;
    int a;  //!
};

//# 4.1.8 E0100 a structure has members
struct S { };  //!

//# 4.1.8 E0100 a structure is not declared in a structure
struct S {
    struct T { float a; } t;  //!
};

//# 4.1.8 E0200 a structure does not hold itself
struct S {
    float a;
    S s;  //!
};

//# 4.1.8 E0100 a structure ends with a semicolon
struct S { float a; }  //!
float x;

//# 4.1.8 E0100 a member ends with a semicolon
struct S {
    float a  //!
};

//# 4.1.8 E0100 a member has no value
struct S {
    float a = 1.0;  //!
};

//# 4.1.8 E0100 a member has a name
struct S {
    float;  //!
};

//# 4.1.8 E0100 a member has a type
struct S {
    a;  //!
};

//# 4.1.8 E0100 a structure has no functions
struct S {
    float f() { return 1.0; }  //!
};

//# 4.1.8 E0403 a member is not a uniform
struct S {
    uniform float a;  //!
};

//# 4.1.8 E0403 a member is not in
struct S {
    in float a;  //!
};

//# 4.1.8 error a structure is known before it is used
S s;  //!
struct S { float a; };

//# 4.1.8 E0301 a structure does not begin with a number
struct S { float a; };
S s = 1.0;  //!

//# 4.1.8 error a structure does not begin with braces
struct S { float a; };
S s = { 1.0 };  //!

//# 4.1.8 E0301 two structures without name are two types
// glslang takes structures of one shape for one type.
struct { float a; } s;
struct { float a; } t;
void f() {
    s = t;  //!
}

//# 4.1.8 E0301 a structure is not a vector
struct S { float x, y; };
vec2 f(S s) {
    vec2 v = s;  //!
    return v;
}

//# 4.1.8 error a declaration has a type
a = 1.0;  //!

//# 4.1.8 error a type is known
flaot a;  //!

//# 4.1.8 E0100 a declaration has one type
float int a;  //!

//# 4.1.8 E0100 a declaration ends with a semicolon
float a  //!
float b;

//# 4.1.8 E0100 there are no pointers
float *a;  //!

//# 4.1.8 E0100 there are no references
void f(float &a) { }  //!

//# 4.1.8 E0100 there are no initialisers in parentheses
void f() {
    float a(1.0);  //!
}

//# 4.1.8 error auto is not supported
void f() {
    auto a = 1.0;  //!
}

//# 4.1.8 E0301 a value has the type of its variable
void f(vec3 v) {
    float a = v;  //!
}

//# 4.1.8 E0301 the second value has the type of its variable, too
float a = 1.0,
      b = 2;  //!

// Arrays: §4.1.9, §5.4.4 and §5.7.

//# 4.1.9 holds the size follows the name or the type
bool holds() { float a[2]; float[2] b; a[1] = 2.0; b = a; return b[1] == iTime; }

//# 4.1.9 holds a declaration may have arrays beside plain variables
bool holds() { float a = 1.0, b[2], c[3]; return a == 1.0 && b.length() + c.length() == 5; }

//# 4.1.9 holds a size after the type applies to all names
bool holds() { float[3] a, b; return a.length() + b.length() == 6; }

//# 4.1.9 holds the size may be unsigned
float a[3u];
bool holds() { return a.length() == 3; }

//# 4.1.9 holds the initializer determines an omitted size
bool holds() { float a[] = float[](1.0, 2.0, 3.0); float[] b = float[2](1.0, 2.0); return a.length() + b.length() == 5; }

//# 4.1.9 holds the arguments determine an omitted size
bool holds() { return float[](1.0, 2.0, 3.0).length() == 3; }

//# 4.1.9 holds the size may be the length of another array
float a[2];
float b[a.length() * 2];
bool holds() { return b.length() == 4; }

//# 4.1.9 holds an array may have one element
bool holds() { float a[1] = float[1](2.0); return a[0] == iTime; }

//# 4.1.9 holds elements are written one by one
bool holds() { int a[4]; for (int i = 0; i < 4; i++) a[i] = i * i; return a[iFrame] == 9; }

//# 4.1.9 holds arrays may hold structures, and structures arrays
struct S { float a[2]; };
bool holds() { S s[2]; s[1].a[1] = 2.0; s[0] = s[1]; return s[0].a[1] == iTime; }

//# 4.1.9 holds arrays are values
float[2] f(float a[2]) { a[0] += 10.0; return a; }
bool holds() { float a[2] = float[](1.0, 2.0); float b[2] = f(a); return a[0] == 1.0 && b[0] == 11.0 && b[1] == 2.0; }

//# 4.1.9 holds arrays may be out and inout
void f(out float a[2], inout int b[2]) { a = float[](1.0, 2.0); b[1]++; }
bool holds() { float a[2]; int b[2] = int[](1, 2); f(a, b); return a[1] == 2.0 && b[1] == 3; }

//# 4.1.9 holds arrays are assigned as a whole
bool holds() { vec2 a[2], b[2]; a[0] = vec2(1.0); a[1] = vec2(2.0); b = a; a[1] = vec2(3.0); return b[1] == vec2(2.0); }

//# 5.9 holds arrays are compared as a whole
bool holds() { int a[2] = int[](1, 2), b[2] = int[](1, 2); bool same = a == b; b[1]++; return same && a != b; }

//# 5.7 holds an index may be any int or uint
bool holds() { float a[3] = float[](1.0, 2.0, 3.0); uint u = 1u; return a[iFrame - 1] + a[u] + a[int(iTime)] == 8.0; }

//# 5.7 holds an index is computed once
int n = 0;
int next() { return n++; }
bool holds() { int a[3] = int[](1, 2, 3); a[next()] += 10; return a[0] == 11 && n == 1; }

//# 5.7 holds a literal array may be indexed
bool holds() { return int[](5, 6, 7)[iFrame - 2] == 6; }

//# 5.7 holds the result of a function may be indexed
int[3] f() { return int[](5, 6, 7); }
bool holds() { return f()[2] == 7; }

//# 5.7 holds length is an int
bool holds() { float a[3]; int n = a.length() - 4; return n == -1; }

//# 5.7 holds vectors and matrices are indexed
bool holds() { vec3 v = vec3(1.0, 2.0, 3.0); mat2 m = mat2(1.0, 2.0, 3.0, 4.0); int i = iFrame - 2; return v[i] + m[i][i] == 6.0; }

//# 5.7 holds columns of matrices are written by index
bool holds() { mat3 m = mat3(0.0); int i = iFrame - 1; m[i] = vec3(1.0, 2.0, 3.0); m[0][i] = 5.0; return m[2].y == 2.0 && m[0].z == 5.0; }

//# 5.7 holds components of vectors are written by index
bool holds() { vec4 v = vec4(0.0); v[iFrame] = 2.0; v[0]++; return v == vec4(1.0, 0.0, 0.0, 2.0); }

//# 4.1.9 E0305 an array has elements
float a[0];  //!

//# 4.1.9 E0305 an array has no negative size
float a[-1];  //!

//# 4.1.9 E0305 the size of an array is not a float
float a[2.0];  //!

//# 4.1.9 E0305 the size of an array is not a bool
float a[true];  //!

//# 4.1.9 E0305 the size of an array is not a vector
// glslang takes its first component.
float a[ivec2(2)];  //!

//# 4.1.9 E0305 an array has a size
float a[];  //!

//# 4.1.9 E0305 a local array has a size
void f() {
    vec2 a[];  //!
}

//# 4.1.9 E0305 a parameter has a size
float f(float a[]) { return a[0]; }  //!

//# 4.1.9 E0305 a member has a size
struct S {
    float a[];  //!
};

//# 4.1.9 E0305 a result has a size
float[] f() { return float[](1.0); }  //!

//# 4.1.9 E0306 there are no arrays of arrays
float a[2][3];  //!

//# 4.1.9 E0306 arrays of arrays are not supported, wherever the sizes are
float[2] a[3];  //!

//# 4.1.9 E0306 there are no arrays of arrays as parameters
void f(float a[2][2]) { }  //!

//# 4.1.9 E0306 there are no arrays of arrays as members
struct S {
    float a[2][2];  //!
};

//# 4.1.9 E0307 there are no arrays of void
void a[2];  //!

//# 4.1.9 E0305 WebGL limits the size of arrays
// glslang does not.
float a[16777217];  //!

//# 4.1.9 E0301 the sizes of a declaration and its value agree
float a[3] = float[2](1.0, 2.0);  //!

//# 4.1.9 E0301 an array does not begin with a scalar
float a[2] = 1.0;  //!

//# 4.1.9 error there are no lists in braces
float a[2] = { 1.0, 2.0 };  //!

//# 4.1.9 E0301 arrays of different sizes are not assigned
void f() {
    float a[2], b[3];
    a = b;  //!
}

//# 4.1.9 E0301 arrays of different elements are not assigned
void f() {
    float a[2];
    int b[2];
    a = b;  //!
}

//# 5.9 E0300 arrays are not added
void f() {
    float a[2], b[2];
    a + b;  //!
}

//# 5.9 E0300 arrays are not multiplied by a number
void f(float a[2]) {
    a * 2.0;  //!
}

//# 5.9 E0300 arrays of different sizes are not compared
bool f(float a[2], float b[3]) {
    return a == b;  //!
}

//# 5.9 E0300 arrays have no order
bool f(float a[2], float b[2]) {
    return a < b;  //!
}

//# 5.9 E0300 arrays are not negated
void f(float a[2]) {
    -a;  //!
}

//# 5.4.4 E0303 an array is made of as many elements as it has: too few
float a[3] = float[3](1.0, 2.0);  //!

//# 5.4.4 E0303 an array is made of as many elements as it has: too many
float a[1] = float[1](1.0, 2.0);  //!

//# 5.4.4 E0303 an array is made of something
void f() {
    float[]();  //!
}

//# 5.4.4 E0301 the elements of an array have its type
float a[2] = float[2](1.0, 2);  //!

//# 5.4.4 E0301 the elements of an array have its size
vec2 a[2] = vec2[2](vec2(1.0), vec3(1.0));  //!

//# 5.4.4 E0301 the elements of an array are not spread from a vector
float a[2] = float[2](vec2(1.0), 2.0);  //!

//# 5.7 E0304 an index is not a float
float f(float a[2]) {
    return a[1.0];  //!
}

//# 5.7 E0304 an index is not a bool
float f(float a[2]) {
    return a[true];  //!
}

//# 5.7 E0304 an index is not a vector
float f(float a[2], ivec2 i) {
    return a[i];  //!
}

//# 5.7 E0304 a constant index is not negative
float f(float a[2]) {
    return a[-1];  //!
}

//# 5.7 E0304 a constant index is not too large
float f(float a[2]) {
    return a[2];  //!
}

//# 5.7 E0304 a constant index is not too large, however it is written
const int n = 1;
float f(float a[2]) {
    return a[n * 2 + 1];  //!
}

//# 5.7 E0304 a constant index fits a vector
float f(vec2 v) {
    return v[2];  //!
}

//# 5.7 E0304 a constant index fits a matrix
vec2 f(mat2 m) {
    return m[2];  //!
}

//# 5.7 E0304 a constant index fits the column of a matrix
float f(mat3x2 m) {
    return m[2][2];  //!
}

//# 5.7 E0304 a scalar has no elements
float f(float a) {
    return a[0];  //!
}

//# 5.7 E0304 a structure has no elements
struct S { float a; };
float f(S s) {
    return s[0];  //!
}

//# 5.7 E0203 only arrays have a length method
int f(vec3 v) {
    return v.length();  //!
}

//# 5.7 E0203 scalars have no length
int f(float a) {
    return a.length();  //!
}

//# 5.7 error length takes nothing
int f(float a[2]) {
    return a.length(1);  //!
}

//# 5.7 E0203 length is called
int f(float a[2]) {
    return a.length;  //!
}

//# 5.7 E0203 arrays have no other method
int f(float a[2]) {
    return a.size();  //!
}

//# 5.7 E0203 arrays have no components
float f(float a[2]) {
    return a.x;  //!
}

//# 4.1.9 E0302 an array of a different size is not a valid argument
float f(float a[2]) { return a[0]; }
float g(float a[3]) {
    return f(a);  //!
}

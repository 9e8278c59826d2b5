// Constant expressions: §4.3.3, and where they are asked for.

//# 4.3.3 holds literals and operators on them are constant
const float a = 1.0 + 2.0 * 3.0, b = -a;
const bool c = a > 5.0 && !(b > 0.0);
bool holds() { return c && a + b == 0.0; }

//# 4.3.3 holds constants are constant
const int n = 2, m = n * n;
float a[m];
bool holds() { return a.length() == 4; }

//# 4.3.3 holds constructors of constants are constant
const vec3 v = vec3(1.0, vec2(2.0, 3.0));
const mat2 m = mat2(1.0, 2.0, 3.0, 4.0);
float a[int(v.z) + int(m[1][1])];
bool holds() { return a.length() == 7; }

//# 4.3.3 holds built-in functions of constants are constant
const float a = sqrt(4.0), b = max(a, 1.0), c = dot(vec2(1.0), vec2(2.0));
float x[int(b + c + abs(-1.0))];
bool holds() { return x.length() == 7; }

//# 4.3.3 holds the length of an array is constant
const float a[3] = float[](1.0, 2.0, 3.0);
float b[a.length()];
bool holds() { return b.length() == 3; }

//# 4.3.3 holds the length of any array is constant
bool holds() { float a[3]; const int n = a.length(); float b[n + 1]; return b.length() == 4; }

//# 4.3.3 holds the length of an input array is constant
float a[iChannelTime.length()];
bool holds() { return a.length() == 4; }

//# 4.3.3 holds elements of constant arrays are constant
const int a[3] = int[](1, 2, 4);
float b[a[2]];
bool holds() { return b.length() == 4; }

//# 4.3.3 holds members of constant structures are constant
struct S { int a; ivec2 b; };
const S s = S(1, ivec2(2, 3));
float x[s.a + s.b.y];
bool holds() { return x.length() == 4; }

//# 4.3.3 holds ?: of constants is constant
const bool b = false;
float a[b ? 1 : 2];
bool holds() { return a.length() == 2; }

//# 4.3.3 holds swizzles and columns of constants are constant
const mat2 m = mat2(1.0, 2.0, 3.0, 4.0);
float a[int(m[1].yx.y)];
bool holds() { return a.length() == 3; }

//# 4.3.3 holds comparisons of constants are constant
const bool same = vec2(1.0, 2.0) == vec2(1.0, 2.0);
float a[same ? 5 : 1];
bool holds() { return a.length() == 5; }

//# 4.3.3 holds integer arithmetic of constants is constant
const int n = (7 / 2 << 2 | 1) ^ 5 % 3;
float a[n];
bool holds() { return a.length() == 15; }

//# 4.3.3 holds the constants of the implementation are constant
const int n = gl_MaxDrawBuffers;
float a[gl_MaxTextureImageUnits];
bool holds() { return n >= 4 && a.length() >= 16; }

//# 4.3.3 holds a global variable may begin with a constant
const vec2 half_size = vec2(0.5);
vec2 size = half_size * 2.0;
bool holds() { return size == vec2(1.0); }

//# 4.3.3 holds a local constant may depend on a global one
const int n = 2;
bool holds() { const int m = n + 1; float a[m]; return a.length() == 3; }

//# 4.3.3 holds integers of constant expressions wrap around
const int big = 2147483647 + 1;
const uint small = 0u - 1u;
bool holds() { return big < 0 && small == 0xFFFFFFFFu; }

//# 4.3.3 holds division of constant integers rounds toward zero
const int a = -7 / 2, b = 7 / 2;
bool holds() { return a == -3 && b == 3; }

//# 4.3.3 holds constant conversions cut off
const int a = int(-1.75), b = int(1.75), c = int(true);
const uint d = uint(2.5);
bool holds() { return a == -1 && b == 1 && c == 1 && d == 2u; }

//# 4.3.3 holds trigonometry of constants is constant
const float a = sin(0.0) + cos(0.0) + atan(0.0, 1.0);
float x[int(a)];
bool holds() { return x.length() == 1; }

//# 4.3.3 holds matrix functions of constants are constant
// glslang does not fold them.
const float d = determinant(mat2(2.0, 0.0, 0.0, 3.0)), t = transpose(mat2(1.0, 2.0, 3.0, 4.0))[0][1];
bool holds() { return d + t == 9.0; }

//# 4.3.3 holds sizes may come out of matrices
// glslang does not fold matrix functions.
const mat2 m = matrixCompMult(mat2(1.0, 2.0, 3.0, 4.0), outerProduct(vec2(1.0, 2.0), vec2(1.0, 0.5)));
float a[int(transpose(m)[0][1]) + int(determinant(mat3(2.0)) + inverse(mat2(0.25))[1][1])];
bool holds() { return a.length() == 13; }

//# 4.3.3 holds products of constant matrices are constant
const vec2 v = mat2(1.0, 2.0, 3.0, 4.0) * vec2(1.0, 2.0);
const mat2 m = mat2(0.0, 1.0, 1.0, 0.0) * mat2(v, v);
float a[int(v.x) + int(m[1].x)];
bool holds() { return a.length() == 17; }

//# 4.3.3 holds vector relations of constants are constant
const bool b = all(lessThan(vec2(1.0), vec2(2.0))) && any(bvec2(false, true)) && !not(bvec2(true)).x;
float x[b ? 2 : 1];
bool holds() { return x.length() == 2; }

//# 4.3.3 holds bits of constants are constant
// glslang does not fold them.
const int bits = floatBitsToInt(1.0);
const float one = intBitsToFloat(0x3F800000);
bool holds() { return bits == 0x3F800000 && one == 1.0; }

//# 4.3.3 E0401 an input is not constant
const float a = iTime;  //!

//# 4.3.3 E0401 a global variable is not constant
float a = 1.0;
const float b = a;  //!

//# 4.3.3 E0401 a global variable does not begin with another
float a = 1.0;
float b = a;  //!

//# 4.3.3 E0401 a global variable does not begin with an input
vec2 size = iResolution.xy;  //!

//# 4.3.3 E0401 a global variable does not begin with a built-in variable
float x = gl_FragCoord.x;  //!

//# 4.3.3 E0401 a global variable does not begin with a call
float f() { return 1.0; }
float a = f();  //!

//# 4.3.3 E0401 an own function is not constant, however constant its arguments
float f(float a) { return a; }
const float b = f(1.0);  //!

//# 4.3.3 E0401 a local variable is not constant
void f() {
    float a = 1.0;
    const float b = a;  //!
}

//# 4.3.3 E0401 a parameter is not constant
void f(float a) {
    const float b = a;  //!
}

//# 4.3.3 E0401 a const parameter is not constant
void f(const float a) {
    const float b = a;  //!
}

//# 4.3.3 E0401 a texture is not constant
const vec4 a = texture(iChannel0, vec2(0.0));  //!

//# 4.3.3 E0401 the size of a texture is not constant
const ivec2 a = textureSize(iChannel0, 0);  //!

//# 4.3.3 E0401 a sequence is not constant
const float a = (1.0, 2.0);  //!

//# 4.3.3 error an assignment is not constant
float a;
const float b = a = 1.0;  //!

//# 4.3.3 error a step is not constant
int a;
const int b = a++;  //!

//# 4.3.3 E0401 one part that is not constant spoils the whole
const vec3 a = vec3(1.0, 2.0, iTime);  //!

//# 4.3.3 E0401 ?: is not constant if a side is not
const float a = true ? 1.0 : iTime;  //!

//# 4.3.3 E0401 an index that is not constant spoils the whole
const float a[2] = float[](1.0, 2.0);
const float b = a[iFrame];  //!

//# 4.3.3 E0401 a decided && is not constant if its right side is not
const bool a = false && iTime > 1.0;  //!

//# 4.3.3 E0305 the size of an array is constant
void f() {
    int n = 2;
    float a[n];  //!
}

//# 4.3.3 E0305 the size of an array does not depend on a parameter
void f(const int n) {
    float a[n];  //!
}

//# 4.3.3 E0305 the size of an array does not depend on an input
float a[iFrame];  //!

//# 4.3.3 E0401 a label is constant
void f(int n) {
    switch (n) {
        case iFrame: break;  //!
    }
}

//# 4.3.3 E0401 a label is not a variable
void f(int n) {
    int a = 1;
    switch (n) {
        case a: break;  //!
    }
}

//# 4.3.3 holds a label may be any constant expression
const int two = 2;
bool holds() { switch (iFrame) { case two + 1: return true; default: return false; } return false; }

//# 8.8 E0401 an offset is constant
vec4 f(ivec2 o) {
    return textureOffset(iChannel0, vec2(0.0), o);  //!
}

//# 8.8 holds an offset may be any constant expression
const ivec2 o = ivec2(1, 2) - ivec2(1, 0);
bool holds() { return texelFetchOffset(iChannel0, ivec2(1, 0), 0, o).xy == vec2(0.25, 0.5); }

//# 4.3.3 error nothing constant is divided by 0 where its value is needed
// glslang lets it.
float a[1 / 0];  //!

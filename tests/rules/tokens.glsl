// Characters, comments, tokens, numbers, names and reserved words: §3.1 to §3.8, §4.1.3 and §4.1.4.

//# 3.1 E0001 an at sign is not in the character set
float x = 1.0 @ 2.0;  //!

//# 3.1 E0001 a dollar sign is not part of names
float x$ = 1.0;  //!

//# 3.1 E0001 there are no strings
float x = "1.0";  //!

//# 3.1 E0001 there are no characters as values
int x = 'a';  //!

//# 3.1 E0001 a backslash alone is not a token
float x = 1.0 \ 2.0;  //!

//# 3.1 E0001 names are ASCII
float größe = 1.0;  //!

//# 3.1 holds comments may hold any character
// größe 🙂 @ $ "
/* größe 🙂 ' */
bool holds() { return true; }

//# 3.3 holds a comment is a blank
bool holds() { return/**/iTime/* 1 */==/* 2 */2.0; }

//# 3.3 holds block comments do not nest
/* /* */ bool holds() { return true; }

//# 3.3 E0100 block comments do not nest
/* /* */ */  //!

//# 3.3 holds a block comment hides a line comment
/* // */ bool holds() { return true; }

//# 3.3 holds a line comment hides a block comment
// /*
bool holds() { return true; }

//# 3.3 E0002 a block comment ends
// ANGLE names the last line.
float x; /* this does not  //!

//# 3.3 holds a line comment may go on in the next line
// a \
this is comment still
bool holds() { return true; }

//# 3.2 holds a backslash joins two lines, even inside of a name
bool hol\
ds() { return true; }

//# 3.2 holds tabs and form feeds are blanks
bool	holds()	{	return true; }

//# 3.5 holds the longest token is taken
bool holds() { int a = 1, b = 2; int c = a+++b; return c == 3 && a == 2 && b == 2; }

//# 3.5 E0400 the longest token is taken, sense or not
int f(int a, int b) {
    return a+++++b;  //!
}

//# 3.5 holds two minus signs with a blank are two
bool holds() { int a = 1; return - -a == 1; }

//# 3.5 E0100 a blank parts a token
bool f(int a, int b) {
    return a < = b;  //!
}

//# 3.6 holds every assignment operator is one token
bool holds() {
    int a = 12;
    a += 3; a -= 1; a *= 2; a /= 4; a %= 4; a <<= 3; a >>= 1; a &= 12; a ^= 5; a |= 16;
    return a == 25;
}

//# 4.1.3 holds integers are decimal, octal or hexadecimal
bool holds() { return 31 == 0x1F && 037 == 31 && 0Xab == 171 && 0 == 00; }

//# 4.1.3 holds integers may be unsigned
bool holds() { return 7u / 2U == 3u && 0xFFFFFFFFu == ~0u && 017u == 15u; }

//# 4.1.3 holds a hexadecimal int is its bits
bool holds() { return 0xFFFFFFFF == -1 && 0x80000000 < 0; }

//# 4.1.3 E0102 8 is not an octal digit
int x = 08;  //!

//# 4.1.3 E0102 9 is not an octal digit
int x = 0129;  //!

//# 4.1.3 E0102 a hexadecimal number has digits
int x = 0x;  //!

//# 4.1.3 E0102 g is not a hexadecimal digit
int x = 0x1g;  //!

//# 4.1.3 E0103 an integer has 32 bits
int x = 4294967296;  //!

//# 4.1.3 E0103 a hexadecimal integer has 32 bits
int x = 0x100000000;  //!

//# 4.1.3 E0103 an unsigned integer has 32 bits
uint x = 4294967296u;  //!

//# 4.1.3 E0102 long integers are not supported
int x = 1L;  //!

//# 4.1.3 E0102 a letter does not follow a number
int x = 12abc;  //!

//# 4.1.3 E0102 there are no binary numbers
int x = 0b101;  //!

//# 4.1.4 holds a float has a point or an exponent
bool holds() { return 2.0 == 2. && .5 == 5e-1 && 2e0 == iTime && 20E-1 == 2.0 && 0.2e+1 == 2.; }

//# 4.1.4 holds a float may say that it is one
bool holds() { return 2.0f == iTime && 2.F == 2e0f; }

//# 4.1.4 E0102 a suffix does not make an integer a float
float x = 1f;  //!

//# 4.1.4 E0102 a float has one point
float x = 1.0.0;  //!

//# 4.1.4 E0102 an exponent has digits
float x = 1e;  //!

//# 4.1.4 E0102 an exponent has digits, not only a sign
float x = 1.0e+;  //!

//# 4.1.4 E0102 there are no half floats
float x = 1.0h;  //!

//# 4.1.4 E0102 there are no doubles
float x = 1.0lf;  //!

//# 4.1.4 E0102 a float is not unsigned
float x = 1.0u;  //!

//# 4.1.4 E0102 there are no hexadecimal floats
float x = 0x1.8;  //!

//# 4.1.4 E0100 a point alone is not a number
float x = .;  //!

//# 4.1.4 holds leading zeros make no octal float
bool holds() { return 010.0 == 10.0 && 09.5 > 9.0; }

//# 4.1.4 holds a float too large is infinite
bool holds() { return 1e99 > 3e38 && 1e99 == 1e98; }

//# 4.1.4 holds a float too small is 0
bool holds() { return 1e-99 == 0.0; }

//# 3.8 holds names have letters, digits and underscores, and case counts
bool holds() { int a = 1, A = 2, _ = 3, a1 = 4, _a_1 = 5; return a + A + _ + a1 + _a_1 == 15; }

//# 3.8 error a name does not begin with a digit
float 2x = 1.0;  //!

//# 3.8 error names that begin with gl_ are GLSL's
float gl_mine = 1.0;  //!

//# 3.8 error functions that begin with gl_ are GLSL's
// glslang takes them.
float gl_mine() { return 1.0; }  //!

//# 3.8 error parameters that begin with gl_ are GLSL's
float f(float gl_mine) { return gl_mine; }  //!

//# 3.8 error members that begin with gl_ are GLSL's
// glslang takes them.
struct S {
    float gl_mine;  //!
};

//# 3.8 error structures that begin with gl_ are GLSL's
// glslang takes them.
struct gl_mine { float a; };  //!

//# 3.8 holds names may begin as keywords do
bool holds() { int inner = 1, floats = 2, ifs = 3, do_it = 4, true1 = 5; return inner + floats + ifs + do_it + true1 == 15; }

//# 3.8 holds what other languages keep is free here
bool holds() { int string = 1, new = 2, char = 3, auto = 4, self = 5, texture2D = 6; return string + new + char + auto + self + texture2D == 21; }

//# 3.8 holds a name may have 1024 characters
float aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa = 2.0;
bool holds() { return aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa == iTime; }

//# 3.8 error a name of 1025 characters is too long for WebGL
// glslang takes any length.
float aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa = 2.0;  //!

//# 3.7 E0100 a keyword is not a name
float while = 1.0;  //!

//# 3.7 E0100 the name of a type cannot be the name of a variable
float vec3 = 1.0;  //!

//# 3.7 E0100 true is not a name
bool true = false;  //!

//# 3.7 E0100 discard cannot be the name of a function
float discard() { return 1.0; }  //!

//# 3.7 E0104 attribute is a keyword no more
attribute float x;  //!

//# 3.7 E0104 varying is a keyword no more
varying float x;  //!

//# 3.7 E0104 half is reserved
half x;  //!

//# 3.7 E0104 double is reserved
double x;  //!

//# 3.7 E0104 long is reserved
float long = 1.0;  //!

//# 3.7 E0104 input is reserved
float input = 1.0;  //!

//# 3.7 E0104 output is reserved
float f(float output) { return output; }  //!

//# 3.7 E0104 sample is reserved
float sample(vec2 p) { return p.x; }  //!

//# 3.7 E0104 filter is reserved
float filter = 1.0;  //!

//# 3.7 E0104 active is reserved
bool f() {
    bool active = true;  //!
    return active;
}

//# 3.7 E0104 partition is reserved
int partition(int i) { return i; }  //!

//# 3.7 E0104 common is reserved
float common = 1.0;  //!

//# 3.7 E0104 patch is reserved
float patch = 1.0;  //!

//# 3.7 E0104 this is reserved
float f(vec2 this) { return this.x; }  //!

//# 3.7 E0104 goto is reserved
void f() {
    goto end;  //!
}

//# 3.7 E0104 class is reserved
class C { float x; };  //!

//# 3.7 E0104 enum is reserved
enum E { A };  //!

//# 3.7 E0104 typedef is reserved
typedef float real;  //!

//# 3.7 E0104 union is reserved
union U { float x; };  //!

//# 3.7 E0104 inline is reserved
inline float f() { return 1.0; }  //!

//# 3.7 E0104 static is reserved
static float x = 1.0;  //!

//# 3.7 E0104 unsigned is reserved
unsigned int x;  //!

//# 3.7 E0104 a member may not be a reserved word
struct S {
    float fixed;  //!
};

//# 3.7 E0104 dvec3 is reserved
dvec3 x;  //!

//# 3.7 E0104 sampler1D is reserved
float f(sampler1D s) { return 1.0; }  //!

//# 3.7 E0104 image2D is reserved
float f(image2D s) { return 1.0; }  //!

//# 3.7 E0104 coherent is reserved
coherent float x;  //!

//# 3.7 E0104 a reserved word is reserved in macros, too
#define NAME template
float f() {
    float NAME = 1.0;  //!
    return 1.0;
}

//# 3.7 holds a reserved word may be the name of a macro
#define half float
half x = 2.0;
bool holds() { return x == iTime; }

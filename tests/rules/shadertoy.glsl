// ShaderToy's surroundings: mainImage and the inputs. On the site, a main below the author's text calls mainImage, and that is where
// compilers find the mistakes of mainImage's header; we name the header.

//# - holds mainImage sets the color
void mainImage(out vec4 c, in vec2 p) { c = vec4(1.0, 0.5, 0.25, 1.0); }

//# - holds the names of mainImage's parameters are the author's
void mainImage(out vec4 fragColor, in vec2 fragCoord) { fragColor = vec4(fragCoord.x * 2.0); }

//# - holds the second parameter of mainImage may do without in
void mainImage(out vec4 c, vec2 p) { c = vec4(p.y * 2.0); }

//# - holds mainImage's parameters may have a precision
void mainImage(out highp vec4 c, in mediump vec2 p) { c = vec4(1.0); }

//# - holds the color is initially opaque black
void mainImage(inout vec4 c, in vec2 p) { c.x += c.w - c.y; }

//# - holds mainImage may promise to leave its place alone
void mainImage(out vec4 c, const in vec2 p) { c = vec4(p.x * 2.0); }

//# - holds mainImage may be declared before
void mainImage(out vec4 c, in vec2 p);
void shade(out vec4 c) { c = vec4(iTime - 1.0); }
void mainImage(out vec4 c, in vec2 p) { shade(c); }

//# - holds mainImage may be called by the author, too
float f(vec2 p) { return p.x * 2.0; }
void mainImage(out vec4 c, in vec2 p) { c = vec4(f(p)); }

//# - holds mainImage may be overloaded
vec4 mainImage(vec2 p) { return vec4(p.x * 2.0); }
void mainImage(out vec4 c, in vec2 p) { c = mainImage(p); }

//# - holds mainImage may return early
void mainImage(out vec4 c, in vec2 p) { c = vec4(1.0); if (iTime > 1.0) return; c = vec4(0.0); }

//# - holds mainImage may write components
void mainImage(out vec4 c, in vec2 p) { c.x = 0.5; c.yz = p; c.x += p.x; }

//# - holds mainImage may change its own copy of the place
void mainImage(out vec4 c, in vec2 p) { p += 0.5; c = vec4(p.x); }

//# - holds the position is the center of a pixel
void mainImage(out vec4 c, in vec2 p) { c = vec4(p == gl_FragCoord.xy && p == vec2(0.5)); }

//# - holds the color may be out of range
void mainImage(out vec4 c, in vec2 p) { c = vec4(9.0, -5.0, 0.0, 0.0); c.r -= 8.0; }

//# - holds the inputs are there
bool holds() { return iResolution == vec3(1.0) && iTime == 2.0 && iFrame == 3 && iMouse == vec4(1.0, 2.0, 3.0, 4.0); }

//# - holds the date and the rates are there
bool holds() { return iDate.x == 2025.0 && iDate.w == 3600.0 && iSampleRate == 44100.0 && iFrameRate == 60.0 && iTimeDelta > 0.0; }

//# - holds the channels have times and sizes
bool holds() { float t = 0.0; for (int i = 0; i < 4; i++) t += iChannelTime[i]; return iChannelResolution[0].xy == vec2(4.0) && t >= 0.0; }

//# - holds the inputs are seen in all functions
float f() { return iTime; }
bool holds() { return f() == 2.0; }

//# - holds a local variable may hide an input
bool holds() { float iTime = 5.0; vec2 iResolution = vec2(iTime); return iResolution.y == 5.0; }

//# - holds a parameter may hide an input
float f(float iTime) { return iTime; }
bool holds() { return f(7.0) == 7.0; }

//# - holds a macro may hide an input
#define iTime 7.0
bool holds() { return iTime == 7.0; }

//# - holds HW_PERFORMANCE is defined
#ifdef HW_PERFORMANCE
bool holds() { return HW_PERFORMANCE >= 0; }
#endif

//# - holds a uniform that nobody feeds is 0
uniform float mine;
bool holds() { return mine == 0.0; }

//# - holds globals are anew for each pixel
float n = 1.0;
void mainImage(out vec4 c, in vec2 p) { c = vec4(n); n += 1.0; }

//# - holds main may be the name of a variable
bool holds() { float main = iTime; return main == 2.0; }

//# - holds mainSound and mainVR may be defined too
vec2 mainSound(int sample_, float time) { return vec2(time); }
void mainVR(out vec4 c, in vec2 p, in vec3 o, in vec3 d) { c = vec4(0.0); }
bool holds() { return mainSound(0, iTime).x == 2.0; }

//# - E0409 there is a mainImage
float f() { return 1.0; } // no mainImage //!

//# - E0409 mainImage has a body
// glslang leaves it to the linker.
void mainImage(out vec4 c, in vec2 p);  //!

//# - E0409 mainImage has an out parameter
// The site compiles it, and stays black.
void mainImage(vec4 c, in vec2 p) { c = vec4(1.0); }  //!

//# - E0409 mainImage has two parameters
void mainImage(out vec4 c) { c = vec4(1.0); }  //!

//# - E0409 mainImage has two parameters and no more
void mainImage(out vec4 c, in vec2 p, in float t) { c = vec4(1.0); }  //!

//# - E0409 mainImage's color has four components
void mainImage(out vec3 c, in vec2 p) { c = vec3(1.0); }  //!

//# - E0409 mainImage's place has two components
void mainImage(out vec4 c, in vec4 p) { c = p; }  //!

//# - E0409 mainImage has its parameters in order
void mainImage(in vec2 p, out vec4 c) { c = vec4(1.0); }  //!

//# - E0409 mainImage returns nothing
vec4 mainImage(in vec2 p) { return vec4(1.0); }  //!

//# - E0409 mainImage is written so
void mainimage(out vec4 c, in vec2 p) { c = vec4(1.0); } // not mainImage //!

//# - E0409 mainImage's place is not out
void mainImage(out vec4 c, inout vec2 p) { c = vec4(1.0); }  //!

//# - E0201 main is ShaderToy's
void main() { gl_FragDepth = 1.0; }  //!

//# - E0201 iTime is declared
float iTime = 1.0;  //!

//# - E0201 iResolution is declared
uniform vec3 iResolution;  //!

//# - E0201 iChannel0 is declared
uniform sampler2D iChannel0;  //!

//# - E0201 iMouse cannot be the name of a function
vec2 iMouse() { return vec2(1.0); }  //!

//# - E0400 the resolution is not assigned to
void f() {
    iResolution = vec3(1.0);  //!
}

//# - E0400 a channel's time is not assigned to
void f() {
    iChannelTime[0] = 1.0;  //!
}

//# - E0301 iResolution has three components
vec2 f() {
    vec2 size = iResolution;  //!
    return size;
}

//# - E0300 iFrame is an int
float f() {
    return iFrame * 0.1;  //!
}

//# - E0300 iResolution is not divided by two numbers
vec2 f(vec2 p) {
    return p / iResolution;  //!
}

//# - E0304 there are four channels
vec3 f() {
    return iChannelResolution[4];  //!
}

//# - E0200 iGlobalTime is of the old site
float f() {
    return iGlobalTime;  //!
}

//# - E0200 other sites' inputs are not ShaderToy's
float f() {
    return u_time;  //!
}

//# - E0200 fragCoord is mainImage's
vec2 f() {
    return fragCoord;  //!
}
void mainImage(out vec4 fragColor, in vec2 fragCoord) { fragColor = vec4(f(), 0.0, 1.0); }

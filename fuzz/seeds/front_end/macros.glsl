#define PI 3.14159
#define ROT(a) mat2(cos(a), -sin(a), \
    sin(a), cos(a))
#define CAT(a, b) a##b
#define F(x) (G(x) + 1.0)
#define G(x) (x * (x))
#ifdef GL_ES
#define LOW 1
#else
#define LOW 0
#endif
#if defined(PI) && LOW > 0 && (__VERSION__ >= 300 || __LINE__ == 12)
const float k = F(2.0);
#elif !LOW
const float k = bad;
#else
#error never
#endif
#undef F
#pragma optimize(off)
#line 100
/* a comment
   of two lines */
void mainImage(out vec4 o, in vec2 p) { o = vec4(ROT(PI * k) * p, float(__LINE__), 1.0); } // end

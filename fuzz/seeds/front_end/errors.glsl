uniform float speed = 1.0;
float twice(float x) { float x = 2; return x * speed }
vec3 v = vec2(1.0;
int i = 1.5 % 2; bool b = v;
void f(int a) { f(a); undeclared = a; a.x = 1; const int c; c = 2; }
void mainImage(out vec4 o, in vec2 p) {
    o = vec4(1, 2, 3); iTime = 1.0; float half = texture(iChannel0); gl_x = 1;
    for (int i = 0; i < 3; i++) { break } else { switch (1.0) { case 1: case 1: } }
    while (1) { return 1.0; } v[3] = 1.0; f(1.0, 2); goto end; "string"; 'c' @ ` é
}

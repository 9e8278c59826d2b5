void mainImage(out vec4 c, in vec2 p) { c = vec4(noise(p)); }
float noise(vec2 p) { return fract(p.x * 7.3); }

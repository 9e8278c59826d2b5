void mainImage(out vec4 o, in vec2 p) {
    vec3 a = vec3(p, iTime), b = normalize(a.zxy + 0.1); float w;
    a = mix(a, b, smoothstep(0.0, 1.0, b)) + mod(a, 2.0) + pow(abs(a), vec3(2)) + refract(b, a, 0.7) + faceforward(a, b, a);
    a += modf(b, a) + sign(a) * floor(b) + ceil(b) - round(a) + roundEven(b) + trunc(a) + fract(b) + mix(a, b, bvec3(true, false, true));
    w = dot(a, b) + length(cross(a, b)) + distance(a, b) + atan(a.y, a.x) + atan(a.z) + sinh(w) + acosh(2.0) + exp2(b.x) + log2(3.0);
    mat3 m = outerProduct(a, b); m = inverse(m) * transpose(m) + matrixCompMult(m, m);
    bvec3 t = lessThan(a, b); t = not(equal(ivec3(a), ivec3(b)));
    o = vec4(m * a, determinant(m)) + float(any(t) ^^ all(t)) + fwidth(w) + (isnan(w) || isinf(w) ? 1.0 : 0.0) + min(w, 1.0) + clamp(w, 0.0, 1.0);
}

// A filter of an image: the gradient of the brightness, from 3x3 texels (Sobel), is long at edges, which
// become dark lines over a paler image. Change the weights to blur, sharpen or emboss the image.

#ifdef GL_ES
precision mediump float;
#endif

uniform vec2 u_resolution;
uniform sampler2D u_tex0;
uniform vec2 u_tex0Resolution;

// The brightness as the eye weighs the colors.
float brightness(vec3 color) {
    return dot(color, vec3(0.299, 0.587, 0.114));
}

// The change of the brightness to the right and upward, from three differences with the weights 1, 2 and 1.
vec2 gradient(vec2 uv) {
    vec2 texel = 1.0 / u_tex0Resolution;
    vec2 sum = vec2(0.0);
    for (int y = -1; y <= 1; y++) {
        for (int x = -1; x <= 1; x++) {
            vec2 offset = vec2(float(x), float(y));
            float value = brightness(texture2D(u_tex0, uv + offset * texel).rgb);
            // For x, the weights in a row are -1, 0 and 1, and the middle row counts twice.
            sum += value * offset * (2.0 - abs(offset.yx));
        }
    }
    return sum;
}

void main() {
    vec2 uv = gl_FragCoord.xy / u_resolution;
    vec3 color = texture2D(u_tex0, uv).rgb;
    float edge = smoothstep(0.15, 0.6, length(gradient(uv)));
    vec3 pale = mix(vec3(1.0), color, 0.6);
    gl_FragColor = vec4(mix(pale, vec3(0.1, 0.1, 0.2), edge), 1.0);
}

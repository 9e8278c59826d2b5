// Renders shaders with the inputs that a file contains.
#pragma once

// The headers of C++ declare `abs` and others of Metal's functions, so none is included.
#include <stdio.h>

#include "textures.h"

typedef metal::float4 (*Fragment)(const void *block, const metal::Image *channels, metal::float4 position);

// A texture of a channel.
template <class Texture> Texture bound(const metal::Image *image) {
    Texture texture;
    texture.image = image;
    return texture;
}

inline void read(void *to, size_t bytes, FILE *file) {
    if (fread(to, 1, bytes, file) != bytes) __builtin_trap();
}

// Denormals are zero, as in the evaluator.
inline void flush_denormals() {
#if defined(__x86_64__)
    __builtin_ia32_ldmxcsr(0x9fc0);
#elif defined(__aarch64__)
    __builtin_arm_wsr64("fpcr", 1 << 24);
#endif
}

// Renders the quad whose lower left pixel is (x, y).
inline void render_quad(Fragment shader, const char *block, const metal::Image *channels, const int *size,
    int x, int y, float *image) {
    metal::Quad &quad = metal::quad;
    memset(&quad, 0, sizeof quad);
    metal::Quad before;
    // Each run determines the next derivative at least.
    for (int run = 0; run <= metal::Quad::max_calls; ++run) {
        before = quad;
        for (quad.pixel = 0; quad.pixel < 4; ++quad.pixel) {
            const int column = x + quad.pixel % 2, row = y + quad.pixel / 2;
            quad.call = 0;
            quad.is_discarded = false;
            const metal::float4 position(float(column) + 0.5f, float(row) + 0.5f, 0.0f, 1.0f);
            metal::float4 color = shader(block, channels, position);
            quad.calls[quad.pixel] = quad.call;
            // The evaluator marks discarded pixels by this color.
            if (quad.is_discarded) color = metal::float4(0.0f, 0.0f, 0.0f, 0.5f);
            if (column < size[0] && row < size[1])
                memcpy(image + size_t(4) * size_t(row * size[0] + column), color.all, sizeof color.all);
        }
        if (memcmp(before.values, quad.values, sizeof quad.values) == 0
            && memcmp(before.calls, quad.calls, sizeof quad.calls) == 0)
            return;
    }
}

// Renders one image of a shader: its size, the uniform block and the textures are in `in`.
inline void render(Fragment shader, FILE *in, FILE *out) {
    int size[2];
    alignas(16) char block[208];
    metal::Image channels[4];
    read(size, sizeof size, in);
    read(block, sizeof block, in);
    for (metal::Image &channel : channels) {
        read(channel.size, sizeof channel.size, in);
        const size_t count = size_t(4) * size_t(channel.size[0]) * size_t(channel.size[1]) * size_t(channel.size[2]);
        float *texels = new float[count];
        read(texels, count * sizeof(float), in);
        channel.texels = texels;
    }
    const size_t count = size_t(4) * size_t(size[0]) * size_t(size[1]);
    float *image = new float[count];
    for (int y = 0; y < size[1]; y += 2)
        for (int x = 0; x < size[0]; x += 2) render_quad(shader, block, channels, size, x, y, image);
    if (fwrite(image, sizeof(float), count, out) != count) __builtin_trap();
    delete[] image;
    for (metal::Image &channel : channels) delete[] channel.texels;
}

// Renders every image, in the order of the file: the number of a shader stands before each.
inline int render_all(const Fragment *shaders, const char *inputs, const char *images) {
    flush_denormals();
    FILE *in = fopen(inputs, "rb"), *out = fopen(images, "wb");
    if (!in || !out) return 2;
    int number;
    while (fread(&number, sizeof number, 1, in) == 1) render(shaders[number], in, out);
    return fclose(out) == 0 ? 0 : 2;
}

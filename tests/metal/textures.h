// What a fragment of Metal has beside numbers: textures, derivatives and `discard_fragment`.
#pragma once

#include "functions.h"

namespace metal {

// The pixels of a quad, which are run in turn. A derivative needs the values of the neighbors at the same
// call: the quad is run again until these no longer change.
struct Quad {
    enum { max_calls = 256 };
    float values[4][max_calls];
    // The number of calls so far of the pixel that runs, and of each in its last run.
    int call, calls[4];
    int pixel;
    bool is_discarded;
};
static Quad quad;

// The difference to the neighbor along an axis: 1 for x, 2 for y.
inline float difference(float value, int axis) {
    const int neighbor = quad.pixel ^ axis, call = quad.call++;
    if (call >= Quad::max_calls) __builtin_trap();
    quad.values[quad.pixel][call] = value;
    const float beside = call < quad.calls[neighbor] ? quad.values[neighbor][call] : value;
    return quad.pixel & axis ? value - beside : beside - value;
}
inline float dfdx(float value) { return difference(value, 1); }
inline float dfdy(float value) { return difference(value, 2); }
inline float fwidth(float value) {
    const float along_x = dfdx(value);
    return abs(along_x) + abs(dfdy(value));
}
#define DERIVATIVES(N)                                                                                                 \
    inline vec<float, N> dfdx(vec<float, N> v) {                                                                       \
        for (int i = 0; i < N; ++i) v[i] = dfdx(v[i]);                                                                 \
        return v;                                                                                                      \
    }                                                                                                                  \
    inline vec<float, N> dfdy(vec<float, N> v) {                                                                       \
        for (int i = 0; i < N; ++i) v[i] = dfdy(v[i]);                                                                 \
        return v;                                                                                                      \
    }                                                                                                                  \
    inline vec<float, N> fwidth(vec<float, N> v) {                                                                     \
        for (int i = 0; i < N; ++i) v[i] = fwidth(v[i]);                                                               \
        return v;                                                                                                      \
    }
DERIVATIVES(2)
DERIVATIVES(3)
DERIVATIVES(4)
#undef DERIVATIVES

inline void discard_fragment() { quad.is_discarded = true; }

struct sampler {};
struct bias {
    explicit bias(float) {}
};
struct level {
    explicit level(float) {}
};
struct gradient2d {
    gradient2d(float2, float2) {}
};
struct gradient3d {
    gradient3d(float3, float3) {}
};

// A texture of one level, which is repeated and filtered linearly; a plane has the depth 1.
struct Image {
    int size[3];
    const float *texels;
};

template <int N> struct texture {
    const Image *image;

    float4 at(const int *place) const {
        const int *size = image->size;
        const float *texel = image->texels + 4 * ((place[2] * size[1] + place[1]) * size[0] + place[0]);
        return float4(texel[0], texel[1], texel[2], texel[3]);
    }
    float4 filtered(vec<float, N> place, vec<int, N> offset) const {
        int texels[2][3] = {};
        float weights[3] = {};
        for (int axis = 0; axis < N; ++axis) {
            const int size = image->size[axis];
            const float scaled = (place[axis] - floor(place[axis])) * float(size) - 0.5f;
            const float clamped = clamp(scaled, -1.0f, float(size));
            weights[axis] = clamped - floor(clamped);
            for (int next = 0; next < 2; ++next) {
                const int texel = int(floor(clamped)) + offset[axis] + next;
                texels[next][axis] = (texel % size + size) % size;
            }
        }
        // The bits of a corner's number choose its texel along each axis.
        float4 corners[1 << N];
        for (int corner = 0; corner < 1 << N; ++corner) {
            int chosen[3] = {};
            for (int axis = 0; axis < N; ++axis) chosen[axis] = texels[corner >> axis & 1][axis];
            corners[corner] = at(chosen);
        }
        for (int axis = 0, left = 1 << N; axis < N; ++axis) {
            left /= 2;
            for (int corner = 0; corner < left; ++corner)
                corners[corner] = corners[2 * corner] + (corners[2 * corner + 1] - corners[2 * corner]) * weights[axis];
        }
        return corners[0];
    }
    // Level, bias and gradients choose the only level.
    float4 sample(sampler, vec<float, N> place, vec<int, N> offset = vec<int, N>(0)) const {
        return filtered(place, offset);
    }
    template <class Option>
    float4 sample(sampler, vec<float, N> place, Option, vec<int, N> offset = vec<int, N>(0)) const {
        static_assert(is_same<Option, bias>::value || is_same<Option, level>::value || is_same<Option, gradient2d>::value
                          || is_same<Option, gradient3d>::value,
            "an option of Metal");
        return filtered(place, offset);
    }
    float4 read(vec<uint, N> place, uint) const {
        int texel[3] = {};
        for (int axis = 0; axis < N; ++axis) texel[axis] = int(place[axis]);
        return at(texel);
    }
    uint get_width(uint = 0) const { return uint(image->size[0]); }
    uint get_height(uint = 0) const { return uint(image->size[1]); }
    uint get_depth(uint = 0) const { return uint(image->size[2]); }
    uint get_num_mip_levels() const { return 1; }
};
template <class T> struct texture2d;
template <> struct texture2d<float> : texture<2> {};
template <class T> struct texture3d;
template <> struct texture3d<float> : texture<3> {};

} // namespace metal

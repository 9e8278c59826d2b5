// Functions of Metal's library.
#pragma once

#include "vectors.h"

namespace metal {

// Each function of scalars is one of vectors, component by component. Those of vectors are no templates, so
// that they take scalars in place of vectors as Metal's do.
#define FUNCTION_1(T, R, N, name)                                                                                      \
    inline vec<R, N> name(vec<T, N> x) {                                                                               \
        vec<R, N> result;                                                                                              \
        for (int i = 0; i < N; ++i) result[i] = name(x[i]);                                                            \
        return result;                                                                                                 \
    }
#define FUNCTION_2(T, R, N, name)                                                                                      \
    inline vec<R, N> name(vec<T, N> x, vec<T, N> y) {                                                                  \
        vec<R, N> result;                                                                                              \
        for (int i = 0; i < N; ++i) result[i] = name(x[i], y[i]);                                                      \
        return result;                                                                                                 \
    }
#define FUNCTION_3(T, R, N, name)                                                                                      \
    inline vec<R, N> name(vec<T, N> x, vec<T, N> y, vec<T, N> z) {                                                     \
        vec<R, N> result;                                                                                              \
        for (int i = 0; i < N; ++i) result[i] = name(x[i], y[i], z[i]);                                                \
        return result;                                                                                                 \
    }
#define SIZES(FUNCTION, T, R, name) FUNCTION(T, R, 2, name) FUNCTION(T, R, 3, name) FUNCTION(T, R, 4, name)
#define UNARY(T, name, value)                                                                                          \
    inline T name(T x) { return value; }                                                                               \
    SIZES(FUNCTION_1, T, T, name)
#define BINARY(T, name, value)                                                                                         \
    inline T name(T x, T y) { return value; }                                                                          \
    SIZES(FUNCTION_2, T, T, name)
#define TERNARY(T, name, value)                                                                                        \
    inline T name(T x, T y, T z) { return value; }                                                                     \
    SIZES(FUNCTION_3, T, T, name)

UNARY(float, sin, evaluator::math_sin(x))
UNARY(float, cos, evaluator::math_cos(x))
UNARY(float, tan, evaluator::math_tan(x))
UNARY(float, asin, evaluator::math_asin(x))
UNARY(float, acos, evaluator::math_acos(x))
UNARY(float, atan, evaluator::math_atan(x))
UNARY(float, sinh, evaluator::math_sinh(x))
UNARY(float, cosh, evaluator::math_cosh(x))
UNARY(float, tanh, evaluator::math_tanh(x))
UNARY(float, asinh, evaluator::math_asinh(x))
UNARY(float, acosh, evaluator::math_acosh(x))
UNARY(float, atanh, evaluator::math_atanh(x))
UNARY(float, exp, evaluator::math_exp(x))
UNARY(float, exp2, evaluator::math_exp2(x))
UNARY(float, log, evaluator::math_log(x))
UNARY(float, log2, evaluator::math_log2(x))
UNARY(float, sqrt, __builtin_sqrtf(x))
UNARY(float, rsqrt, 1.0f / __builtin_sqrtf(x))
UNARY(float, abs, __builtin_fabsf(x))
UNARY(float, floor, __builtin_floorf(x))
UNARY(float, ceil, __builtin_ceilf(x))
UNARY(float, trunc, __builtin_truncf(x))
UNARY(float, rint, __builtin_rintf(x))
UNARY(float, fract, x - __builtin_floorf(x))
UNARY(float, sign, x < 0.0f ? -1.0f : 0.0f < x ? 1.0f : 0.0f)
BINARY(float, pow, evaluator::math_pow(x, y))
BINARY(float, atan2, evaluator::math_atan2(x, y))
BINARY(float, step, y < x ? 0.0f : 1.0f)
TERNARY(float, mix, x * (1.0f - z) + y * z)
BINARY(float, min, y < x ? y : x)
BINARY(float, max, x < y ? y : x)
TERNARY(float, clamp, min(max(x, y), z))
inline float unit(float t) {
    t = 0.0f < t ? t : 0.0f;
    return t < 1.0f ? t : 1.0f;
}
inline float smooth(float t) { return t * t * (3.0f - 2.0f * t); }
TERNARY(float, smoothstep, smooth(unit((z - x) / (y - x))))

UNARY(int, abs, x < 0 ? -x : x)
BINARY(int, min, y < x ? y : x)
BINARY(int, max, x < y ? y : x)
TERNARY(int, clamp, min(max(x, y), z))
BINARY(uint, min, y < x ? y : x)
BINARY(uint, max, x < y ? y : x)
TERNARY(uint, clamp, min(max(x, y), z))

template <int N> bool all(vec<bool, N> x) {
    for (int i = 0; i < N; ++i)
        if (!x[i]) return false;
    return true;
}
template <int N> bool any(vec<bool, N> x) { return !all(!x); }

template <class T, int N> vec<T, N> select(vec<T, N> x, vec<T, N> y, vec<bool, N> chosen) {
    for (int i = 0; i < N; ++i) x[i] = chosen[i] ? y[i] : x[i];
    return x;
}
template <class T, typename enable_if<is_scalar<T>::value, int>::type = 0> T select(T x, T y, bool chosen) {
    return chosen ? y : x;
}

// Geometric functions: of vectors only, as in Metal.
#define GEOMETRIC(T)                                                                                                   \
    inline float dot(T x, T y) {                                                                                       \
        float sum = x[0] * y[0];                                                                                       \
        for (size_t i = 1; i < sizeof x.all / sizeof(float); ++i) sum += x[i] * y[i];                                  \
        return sum;                                                                                                    \
    }                                                                                                                  \
    inline float length(T x) { return sqrt(dot(x, x)); }                                                               \
    inline float distance(T x, T y) { return length(x - y); }                                                          \
    inline T normalize(T x) { return x / length(x); }                                                                  \
    inline T faceforward(T n, T i, T reference) { return dot(reference, i) < 0.0f ? n : -n; }                          \
    inline T reflect(T i, T n) { return i - 2.0f * dot(n, i) * n; }                                                    \
    inline T refract(T i, T n, float eta) {                                                                            \
        float cosine = dot(n, i);                                                                                      \
        float k = 1.0f - eta * eta * (1.0f - cosine * cosine);                                                         \
        float along = eta * cosine + sqrt(k);                                                                          \
        return k < 0.0f ? T(0.0f) : eta * i - along * n;                                                               \
    }
GEOMETRIC(float2)
GEOMETRIC(float3)
GEOMETRIC(float4)
inline float3 cross(float3 a, float3 b) {
    return float3(a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y);
}

template <int C, int R> matrix<R, C> transpose(const matrix<C, R> &m) {
    matrix<R, C> result;
    for (int c = 0; c < C; ++c)
        for (int r = 0; r < R; ++r) result[r][c] = m[c][r];
    return result;
}
inline float determinant(const float2x2 &m) { return m[0].x * m[1].y - m[1].x * m[0].y; }
inline float determinant(const float3x3 &m) { return dot(m[0], cross(m[1], m[2])); }

// The same bits as another type. Metal's `half` only occurs in packed pairs.
template <class T, class S> T as_type(S value) {
    static_assert(sizeof(T) == sizeof(S), "types of the same size");
    T result;
    memcpy((void *)&result, (const void *)&value, sizeof result);
    return result;
}

#undef FUNCTION_1
#undef FUNCTION_2
#undef FUNCTION_3
#undef SIZES
#undef UNARY
#undef BINARY
#undef TERNARY
#undef GEOMETRIC
} // namespace metal

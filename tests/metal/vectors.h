// Vectors, matrices and arrays of Metal.
#pragma once

#include <stddef.h>
#include <stdint.h>
#include <string.h>

typedef unsigned int uint;

namespace metal {

template <bool condition, class T = void> struct enable_if {};
template <class T> struct enable_if<true, T> { typedef T type; };
template <class A, class B> struct is_same { static constexpr bool value = false; };
template <class A> struct is_same<A, A> { static constexpr bool value = true; };
template <class T> struct is_scalar {
    static constexpr bool value = is_same<T, float>::value || is_same<T, int>::value || is_same<T, uint>::value
        || is_same<T, bool>::value;
};

template <class T, int N> struct vec;

// The number of components that an argument contributes to a vector of T; -100 for other types, so that no sum
// of them fits.
template <class T, class A> struct components { static constexpr int count = is_scalar<A>::value ? 1 : -100; };
template <class T, int N> struct components<T, vec<T, N>> { static constexpr int count = N; };
template <class T, class... A> struct total { static constexpr int count = 0; };
template <class T, class A, class... Rest> struct total<T, A, Rest...> {
    static constexpr int count = components<T, A>::count + total<T, Rest...>::count;
};

// A swizzle of a vector whose components begin at this address, for assignments.
template <class T, int... I> struct swizzle {
    typedef vec<T, sizeof...(I)> vector;
    T first;
    vector value() const {
        const T *all = &first;
        return vector(all[I]...);
    }
    vector operator=(vector from) {
        T *all = &first;
        const int places[] = {I...};
        for (size_t at = 0; at < sizeof...(I); ++at) all[places[at]] = from[at];
        return from;
    }
    swizzle &operator=(const swizzle &) = delete;
    vector operator+=(vector other) { return *this = value() + other; }
    vector operator-=(vector other) { return *this = value() - other; }
    vector operator*=(vector other) { return *this = value() * other; }
    vector operator/=(vector other) { return *this = value() / other; }
    vector operator%=(vector other) { return *this = value() % other; }
    vector operator&=(vector other) { return *this = value() & other; }
    vector operator|=(vector other) { return *this = value() | other; }
    vector operator^=(vector other) { return *this = value() ^ other; }
    vector operator<<=(vector other) { return *this = value() << other; }
    vector operator>>=(vector other) { return *this = value() >> other; }
    vector operator++() { *this = value() + vector(T(1)); return value(); }
    vector operator--() { *this = value() - vector(T(1)); return value(); }
    vector operator++(int) { vector before = value(); *this = before + vector(T(1)); return before; }
    vector operator--(int) { vector before = value(); *this = before - vector(T(1)); return before; }
};

// The components of a vector under their names. `SWIZZLES_2` and the others declare the swizzles.
template <class T, int N> struct named;
template <class T> struct named<T, 2> {
    union {
        T all[2];
        struct { T x, y; };
        struct { T r, g; };
        SWIZZLES_2
    };
};
template <class T> struct named<T, 3> {
    union {
        T all[3];
        struct { T x, y, z; };
        struct { T r, g, b; };
        SWIZZLES_3
    };
};
template <class T> struct named<T, 4> {
    union {
        T all[4];
        struct { T x, y, z, w; };
        struct { T r, g, b, a; };
        SWIZZLES_4
    };
};

// The operators, which extend a scalar on one side to a vector.
#define INFIX(R, op)                                                                                                   \
    friend vec<R, N> operator op(const vec &a, const vec &b) {                                                         \
        vec<R, N> result;                                                                                              \
        for (int i = 0; i < N; ++i) result[i] = R(a[i] op b[i]);                                                       \
        return result;                                                                                                 \
    }
#define PREFIX(R, op)                                                                                                  \
    friend vec<R, N> operator op(const vec &a) {                                                                       \
        vec<R, N> result;                                                                                              \
        for (int i = 0; i < N; ++i) result[i] = R(op a[i]);                                                            \
        return result;                                                                                                 \
    }
#define COMPOUND(op)                                                                                                   \
    INFIX(T, op) friend vec &operator op##=(vec &a, const vec &b) { return a = a op b; }
#define STEP(op, sign)                                                                                                 \
    friend vec &operator op(vec &a) { return a = a sign vec(T(1)); }                                                   \
    friend vec operator op(vec &a, int) {                                                                              \
        vec before = a;                                                                                                \
        a = a sign vec(T(1));                                                                                          \
        return before;                                                                                                 \
    }

// The alignment of a vector of three components is that of four.
template <class T, int N> struct alignas(sizeof(T) * (N == 3 ? 4 : N)) vec : named<T, N> {
    vec() = default;
    vec(const vec &) = default;
    vec &operator=(const vec &other) {
        memcpy(this->all, other.all, sizeof this->all);
        return *this;
    }
    vec(T splat) { fill(splat); }
    template <class S, typename enable_if<is_scalar<S>::value && !is_same<S, T>::value, int>::type = 0>
    explicit vec(S splat) { fill(T(splat)); }
    template <class S, typename enable_if<!is_same<S, T>::value, int>::type = 0>
    explicit vec(const vec<S, N> &other) {
        for (int i = 0; i < N; ++i) this->all[i] = T(other[i]);
    }
    template <class A, class B, class... C, typename enable_if<total<T, A, B, C...>::count == N, int>::type = 0>
    vec(const A &first, const B &second, const C &...rest) { append(0, first, second, rest...); }
    T &operator[](int i) { return this->all[i]; }
    const T &operator[](int i) const { return this->all[i]; }

    COMPOUND(+) COMPOUND(-) COMPOUND(*) COMPOUND(/) COMPOUND(%)
    COMPOUND(&) COMPOUND(|) COMPOUND(^) COMPOUND(<<) COMPOUND(>>)
    INFIX(bool, <) INFIX(bool, >) INFIX(bool, <=) INFIX(bool, >=) INFIX(bool, ==) INFIX(bool, !=)
    PREFIX(T, -) PREFIX(T, ~) PREFIX(bool, !) STEP(++, +) STEP(--, -)

private:
    void fill(T value) {
        for (int i = 0; i < N; ++i) this->all[i] = value;
    }
    void append(int) {}
    template <class A, class... B, typename enable_if<is_scalar<A>::value, int>::type = 0>
    void append(int at, const A &first, const B &...rest) {
        this->all[at] = T(first);
        append(at + 1, rest...);
    }
    template <int M, class... B> void append(int at, const vec<T, M> &first, const B &...rest) {
        for (int i = 0; i < M; ++i) this->all[at + i] = first[i];
        append(at + M, rest...);
    }
};

typedef vec<float, 2> float2;
typedef vec<float, 3> float3;
typedef vec<float, 4> float4;
typedef vec<int, 2> int2;
typedef vec<int, 3> int3;
typedef vec<int, 4> int4;
typedef vec<uint, 2> uint2;
typedef vec<uint, 3> uint3;
typedef vec<uint, 4> uint4;
typedef vec<bool, 2> bool2;
typedef vec<bool, 3> bool3;
typedef vec<bool, 4> bool4;

// Three floats of 12 bytes, as in a buffer.
struct packed_float3 {
    float x, y, z;
    operator float3() const { return float3(x, y, z); }
};

// An array that is a value.
template <class T, size_t N> struct array {
    T elements[N];
    T &operator[](size_t i) { return elements[i]; }
    const T &operator[](size_t i) const { return elements[i]; }
};

// C columns of R rows.
template <int C, int R> struct matrix {
    typedef vec<float, R> column;
    column columns[C];

    matrix() = default;
    // A diagonal matrix.
    explicit matrix(float diagonal) {
        for (int c = 0; c < C; ++c)
            for (int r = 0; r < R; ++r) columns[c][r] = c == r ? diagonal : 0.0f;
    }
    template <class... V, typename enable_if<sizeof...(V) == C && total<float, V...>::count == C * R, int>::type = 0>
    matrix(const V &...given) : columns{given...} {}
    column &operator[](int c) { return columns[c]; }
    const column &operator[](int c) const { return columns[c]; }

    friend matrix operator+(const matrix &a, const matrix &b) {
        matrix sum;
        for (int c = 0; c < C; ++c) sum[c] = a[c] + b[c];
        return sum;
    }
    friend matrix operator-(const matrix &a, const matrix &b) {
        matrix difference;
        for (int c = 0; c < C; ++c) difference[c] = a[c] - b[c];
        return difference;
    }
    friend matrix operator*(const matrix &a, float factor) {
        matrix product;
        for (int c = 0; c < C; ++c) product[c] = a[c] * factor;
        return product;
    }
    friend matrix operator*(float factor, const matrix &a) { return a * factor; }
    // A sum over the columns.
    friend vec<float, R> operator*(const matrix &a, const vec<float, C> &v) {
        column sum = a[0] * v[0];
        for (int c = 1; c < C; ++c) sum = sum + a[c] * v[c];
        return sum;
    }
    friend vec<float, C> operator*(const vec<float, R> &v, const matrix &a) {
        vec<float, C> product;
        for (int c = 0; c < C; ++c) {
            product[c] = v[0] * a[c][0];
            for (int r = 1; r < R; ++r) product[c] += v[r] * a[c][r];
        }
        return product;
    }
};
template <int K, int C, int R> matrix<C, R> operator*(const matrix<K, R> &a, const matrix<C, K> &b) {
    matrix<C, R> product;
    for (int c = 0; c < C; ++c) product[c] = a * b[c];
    return product;
}
typedef matrix<2, 2> float2x2;
typedef matrix<2, 3> float2x3;
typedef matrix<2, 4> float2x4;
typedef matrix<3, 2> float3x2;
typedef matrix<3, 3> float3x3;
typedef matrix<3, 4> float3x4;
typedef matrix<4, 2> float4x2;
typedef matrix<4, 3> float4x3;
typedef matrix<4, 4> float4x4;

#undef INFIX
#undef PREFIX
#undef COMPOUND
#undef STEP
} // namespace metal

/* Embree, timed on the caller's rays: its own sphere geometry, and a user geometry whose callback intersects a whole packet
 * with a sphere, which the compiler vectorizes.
 *
 * Standard input, binary, in the machine's byte order: the numbers of spheres and rays (two uint32), the spheres (x, y, z,
 * radius), the rays (origin, direction, nearest t), all float32. Then commands, a byte each:
 *   1  trace all rays one by one     8  eight at a time       i  the number of each ray's sphere
 *   u  user geometry: sixteen at a time, 8 by 2 pixels of an image of WIDTH by rays / WIDTH pixels, whose camera rays are
 *      computed here: from the origin to x in -1 to 1, y in proportion, at z = -2            j  as i, of the last command
 * Standard output: the seconds of processor time that building took, then for each command the seconds (float64), or for i
 * uint32s, UINT32_MAX for none. */
#include <embree3/rtcore.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#ifdef __SSE__
#include <xmmintrin.h>
#endif

enum { WIDTH = 640, PACKET = 16 };

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}

static void receive(void *to, size_t size, size_t count) {
    if (fread(to, size, count, stdin) != count) exit(2);
}

static void send(const void *from, size_t size, size_t count) {
    fwrite(from, size, count, stdout);
    fflush(stdout);
}

/* Of each sphere: x, y, z, radius. */
static float (*sphere)[4];

static void bounds(const struct RTCBoundsFunctionArguments *of) {
    const float *s = sphere[of->primID];
    *of->bounds_o = (struct RTCBounds){.lower_x = s[0] - s[3], .lower_y = s[1] - s[3], .lower_z = s[2] - s[3],
        .upper_x = s[0] + s[3], .upper_y = s[1] + s[3], .upper_z = s[2] + s[3]};
}

/* Intersects a packet of N rays, whose fields are arrays in the order of RTCRayHitN. The discriminant is that of the point of
 * the ray nearest to the center. Directions have unit length. */
static inline __attribute__((always_inline)) void intersect_packet(const struct RTCIntersectFunctionNArguments *of, int n) {
    const float *s = sphere[of->primID], x = s[0], y = s[1], z = s[2], radius2 = s[3] * s[3];
    const int *valid = of->valid;
    uint32_t id = of->primID;
    float *ox = (float *)of->rayhit, *oy = ox + n, *oz = oy + n, *tnear = oz + n, *dx = tnear + n, *dy = dx + n, *dz = dy + n;
    float *tfar = dz + 2 * n;
    uint32_t *prim = (uint32_t *)(tfar + 9 * n), *geom = prim + n;
#pragma GCC ivdep
    for (int i = 0; i < n; i++) {
        float cx = x - ox[i], cy = y - oy[i], cz = z - oz[i], along = cx * dx[i] + cy * dy[i] + cz * dz[i];
        float fx = cx - along * dx[i], fy = cy - along * dy[i], fz = cz - along * dz[i];
        float disc = radius2 - (fx * fx + fy * fy + fz * fz), half = sqrtf(disc < 0 ? 0 : disc);
        float near = along - half, t = near > tnear[i] ? near : along + half;
        int is_hit = (valid[i] != 0) & (disc >= 0) & (t > tnear[i]) & (t < tfar[i]);
        tfar[i] = is_hit ? t : tfar[i];
        prim[i] = is_hit ? id : prim[i];
        geom[i] = is_hit ? 0 : geom[i];
    }
}

static void intersect(const struct RTCIntersectFunctionNArguments *of) {
    switch (of->N) {
    case 16: return intersect_packet(of, 16);
    case 8: return intersect_packet(of, 8);
    case 4: return intersect_packet(of, 4);
    case 1: return intersect_packet(of, 1);
    default: abort();
    }
}

/* A packet's rays in the order of its pixels: two rows of eight. */
static uint32_t pixel(uint32_t packet, int i) {
    uint32_t in_row = WIDTH / 8, row = packet / in_row, column = packet % in_row;
    return (2 * row + i / 8) * WIDTH + 8 * column + i % 8;
}

/* The unit directions through the centers of a packet's pixels, of which `first` is the lowest left. */
static inline void camera_rays(struct RTCRayHit16 *to, uint32_t first, uint32_t height) {
    float left = (float)(first % WIDTH) + 0.5f, bottom = (float)(first / WIDTH) + 0.5f, aspect = (float)WIDTH / (float)height;
    for (int i = 0; i < PACKET; i++) {
        float x = (left + (float)(i % 8)) / WIDTH * 2 - 1, y = ((bottom + (float)(i / 8)) / (float)height * 2 - 1) / aspect;
        float length = sqrtf(x * x + y * y + 4);
        to->ray.dir_x[i] = x / length, to->ray.dir_y[i] = y / length, to->ray.dir_z[i] = -2 / length;
    }
}

int main(void) {
#ifdef __SSE__
    _mm_setcsr(_mm_getcsr() | 0x8040); /* Embree's manual: denormals are zero. */
#endif
    uint32_t counts[2];
    receive(counts, sizeof counts, 1);
    uint32_t spheres = counts[0], rays = counts[1];
    float(*ray)[7] = malloc(rays * sizeof *ray);
    uint32_t *ids = malloc(rays * sizeof *ids);

    RTCDevice device = rtcNewDevice("threads=1,set_affinity=0");
    RTCScene scene = rtcNewScene(device);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    float *points = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 16, spheres);
    receive(points, 16, spheres);
    sphere = (float(*)[4])points;
    receive(ray, sizeof *ray, rays);
    uint32_t packets = rays / PACKET;
    double start = now();
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcCommitScene(scene);
    double seconds = now() - start;
    send(&seconds, sizeof seconds, 1);

    RTCScene user_scene = rtcNewScene(device);
    RTCGeometry user = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(user, spheres);
    rtcSetGeometryBoundsFunction(user, (RTCBoundsFunction)bounds, 0);
    rtcSetGeometryIntersectFunction(user, intersect);
    rtcCommitGeometry(user);
    rtcAttachGeometry(user_scene, user);
    rtcCommitScene(user_scene);

    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    _Alignas(64) int all[PACKET];
    for (int i = 0; i < PACKET; i++) all[i] = -1;
    for (int command; (command = getchar()) != EOF;) {
        start = now();
        if (command == '8') {
            context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
            for (uint32_t at = 0; at + 8 <= rays; at += 8) {
                struct RTCRayHit8 hit;
                for (int i = 0; i < 8; i++) {
                    const float *r = ray[at + i];
                    hit.ray.org_x[i] = r[0], hit.ray.org_y[i] = r[1], hit.ray.org_z[i] = r[2];
                    hit.ray.dir_x[i] = r[3], hit.ray.dir_y[i] = r[4], hit.ray.dir_z[i] = r[5];
                    hit.ray.tnear[i] = r[6], hit.ray.tfar[i] = 1e30f, hit.ray.mask[i] = -1, hit.ray.flags[i] = 0;
                    hit.ray.time[i] = 0;
                    hit.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
                }
                rtcIntersect8(all, scene, &context, &hit);
                for (int i = 0; i < 8; i++)
                    ids[at + i] = hit.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID ? UINT32_MAX : hit.hit.primID[i];
            }
        } else if (command == 'u') {
            context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
            for (uint32_t packet = 0; packet < packets; packet++) {
                struct RTCRayHit16 hit;
                camera_rays(&hit, pixel(packet, 0), rays / WIDTH);
                for (int i = 0; i < PACKET; i++) {
                    hit.ray.tfar[i] = 1e30f, hit.ray.mask[i] = -1, hit.ray.flags[i] = 0, hit.ray.time[i] = 0;
                    hit.ray.org_x[i] = hit.ray.org_y[i] = hit.ray.org_z[i] = hit.ray.tnear[i] = 0;
                    hit.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID, hit.hit.primID[i] = UINT32_MAX;
                }
                rtcIntersect16(all, user_scene, &context, &hit);
                uint32_t at = pixel(packet, 0);
                memcpy(ids + at, hit.hit.primID, 32);
                memcpy(ids + at + WIDTH, hit.hit.primID + 8, 32);
            }
        } else if (command != 'j') {
            context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
            for (uint32_t at = 0; at < rays; at++) {
                const float *r = ray[at];
                struct RTCRayHit hit = {.ray = {.org_x = r[0], .org_y = r[1], .org_z = r[2], .tnear = r[6],
                    .dir_x = r[3], .dir_y = r[4], .dir_z = r[5], .tfar = 1e30f, .mask = -1},
                    .hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
                rtcIntersect1(scene, &context, &hit);
                ids[at] = hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? UINT32_MAX : hit.hit.primID;
            }
        }
        seconds = now() - start;
        if (command == 'i' || command == 'j') send(ids, sizeof *ids, rays);
        else send(&seconds, sizeof seconds, 1);
    }
    return 0;
}

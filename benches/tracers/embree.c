/* Embree's sphere geometry, timed on the caller's rays.
 *
 * Standard input, binary, in the machine's byte order: the numbers of spheres and rays (two uint32), the spheres (x, y, z,
 * radius), the rays (origin, direction, nearest t), all float32. Then commands, a byte each:
 *   1  meet all rays one by one      8  eight at a time       i  the number of each ray's sphere
 * Standard output: the seconds of processor time that building took, then for each command the seconds (float64), or for i
 * uint32s, UINT32_MAX for none. */
#include <embree3/rtcore.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}

static void take(void *to, size_t size, size_t count) {
    if (fread(to, size, count, stdin) != count) exit(2);
}

static void tell(const void *from, size_t size, size_t count) {
    fwrite(from, size, count, stdout);
    fflush(stdout);
}

int main(void) {
    uint32_t counts[2];
    take(counts, sizeof counts, 1);
    uint32_t spheres = counts[0], rays = counts[1];
    float(*ray)[7] = malloc(rays * sizeof *ray);
    uint32_t *ids = malloc(rays * sizeof *ids);

    RTCDevice device = rtcNewDevice("threads=1,set_affinity=0");
    RTCScene scene = rtcNewScene(device);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    float *points = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 16, spheres);
    take(points, 16, spheres);
    take(ray, sizeof *ray, rays);
    double start = now();
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcCommitScene(scene);
    double seconds = now() - start;
    tell(&seconds, sizeof seconds, 1);

    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    int all[8] = {-1, -1, -1, -1, -1, -1, -1, -1};
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
        } else {
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
        if (command == 'i') tell(ids, sizeof *ids, rays);
        else tell(&seconds, sizeof seconds, 1);
    }
    return 0;
}

/* Rays per second of Embree 4, one ray at a time on one thread, over the meshes and rays that the example `rays` of
 * tyndall-geometry wrote.
 *
 * usage: embree_rays LIBEMBREE ROUNDS FILE...
 *
 * The library comes from the Python wheel `embreex`, which brings no headers: what is called is declared here, after
 * Embree's reference manual. Prints one JSON line for each set of rays; a rate is the best of the rounds, in the thread's
 * CPU time. Robust traversal, a tree of high quality, rtcIntersect1 and rtcOccluded1 without arguments or filters.
 *
 * FILE, little-endian: numbers of vertices, triangles and sets; the vertices, 3 floats each; the triangles, 3 indices each;
 * of each set its name in 16 bytes, 1 where any hit will do, the number of rays; of each ray origin, direction, far end.
 */
#include <dlfcn.h>
#include <math.h>
#include <stdalign.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct {
    alignas(16) float org[3];
    float tnear, dir[3], time, tfar;
    unsigned mask, id, flags;
} Ray;

typedef struct {
    Ray ray;
    alignas(16) float ng[3];
    float u, v;
    /* triangle, geometry, instances; more room than any version asks for */
    unsigned prim, geom, inst[14];
} RayHit;

enum { TRIANGLES = 0, INDEX = 0, VERTEX = 1, UINT3 = 0x5003, FLOAT3 = 0x9003, ROBUST = 4, HIGH = 2, VERSION = 0 };

static void *(*new_device)(const char *);
static long (*device_property)(void *, int);
static int (*device_error)(void *);
static void *(*new_scene)(void *);
static void (*scene_flags)(void *, int);
static void (*scene_quality)(void *, int);
static void *(*new_geometry)(void *, int);
static void (*geometry_quality)(void *, int);
static void (*shared_buffer)(void *, int, unsigned, int, const void *, size_t, size_t, size_t);
static void (*commit_geometry)(void *);
static unsigned (*attach)(void *, void *);
static void (*commit_scene)(void *);
static void (*intersect)(void *, RayHit *, void *);
static void (*occluded)(void *, Ray *, void *);

static void fail(const char *what, const char *which) {
    fprintf(stderr, "error: %s: %s\n", which, what);
    exit(1);
}

static void *symbol(void *library, const char *name) {
    void *found = dlsym(library, name);
    if (!found) fail("not in the library", name);
    return found;
}

static void load(const char *path) {
    void *l = dlopen(path, RTLD_NOW);
    if (!l) fail(dlerror(), path);
    *(void **)&new_device = symbol(l, "rtcNewDevice");
    *(void **)&device_property = symbol(l, "rtcGetDeviceProperty");
    *(void **)&device_error = symbol(l, "rtcGetDeviceError");
    *(void **)&new_scene = symbol(l, "rtcNewScene");
    *(void **)&scene_flags = symbol(l, "rtcSetSceneFlags");
    *(void **)&scene_quality = symbol(l, "rtcSetSceneBuildQuality");
    *(void **)&new_geometry = symbol(l, "rtcNewGeometry");
    *(void **)&geometry_quality = symbol(l, "rtcSetGeometryBuildQuality");
    *(void **)&shared_buffer = symbol(l, "rtcSetSharedGeometryBuffer");
    *(void **)&commit_geometry = symbol(l, "rtcCommitGeometry");
    *(void **)&attach = symbol(l, "rtcAttachGeometry");
    *(void **)&commit_scene = symbol(l, "rtcCommitScene");
    *(void **)&intersect = symbol(l, "rtcIntersect1");
    *(void **)&occluded = symbol(l, "rtcOccluded1");
}

static double seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}

static void take(void *to, size_t size, size_t count, FILE *file, const char *path) {
    if (fread(to, size, count, file) != count) fail("the file ends too early", path);
}

/* Room for one vector more, which Embree may read beyond the last. */
static void *room(size_t bytes, const char *path) {
    void *p = malloc(bytes + 16);
    if (!p) fail("no memory", path);
    return p;
}

static void *build(void *device, const float *p, unsigned vertices, const unsigned *index, unsigned triangles) {
    void *scene = new_scene(device), *mesh = new_geometry(device, TRIANGLES);
    scene_flags(scene, ROBUST);
    scene_quality(scene, HIGH);
    geometry_quality(mesh, HIGH);
    shared_buffer(mesh, VERTEX, 0, FLOAT3, p, 0, 12, vertices);
    shared_buffer(mesh, INDEX, 0, UINT3, index, 0, 12, triangles);
    commit_geometry(mesh);
    attach(scene, mesh);
    commit_scene(scene);
    return scene;
}

/* Length of the diagonal of the mesh's bounds. */
static float extent(const float *p, unsigned vertices) {
    double sum = 0;
    for (int axis = 0; axis < 3; axis++) {
        float low = p[axis], high = p[axis];
        for (unsigned i = 1; i < vertices; i++) {
            float x = p[3 * (size_t)i + axis];
            low = x < low ? x : low;
            high = x > high ? x : high;
        }
        sum += (double)(high - low) * (high - low);
    }
    return (float)sqrt(sum);
}

/* Rays leave surfaces by bounds of our rounding errors; Embree knows none, and would meet the surface again: it gets the
 * usual short gap instead. */
static const float GAP = 1e-5f;

static void prepare(Ray *ray, const float *from, float size) {
    memcpy(ray->org, from, 12);
    memcpy(ray->dir, from + 3, 12);
    ray->tfar = from[6];
    const float *d = from + 3;
    ray->tnear = GAP * size / sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    ray->time = 0;
    ray->mask = ~0u;
    ray->id = ray->flags = 0;
}

static unsigned pass(void *scene, const float *rays, unsigned count, int any, float size) {
    unsigned hits = 0;
    for (unsigned i = 0; i < count; i++) {
        RayHit h;
        prepare(&h.ray, rays + 7 * (size_t)i, size);
        if (any) {
            occluded(scene, &h.ray, NULL);
            hits += h.ray.tfar < 0;
        } else {
            h.geom = ~0u;
            h.inst[0] = ~0u;
            intersect(scene, &h, NULL);
            hits += h.geom != ~0u;
        }
    }
    return hits;
}

static void measure(void *device, long version, int rounds, const char *path) {
    FILE *file = fopen(path, "rb");
    if (!file) fail("cannot be opened", path);
    unsigned n[3];
    take(n, 4, 3, file, path);
    float *p = room(12 * (size_t)n[0], path);
    unsigned *index = room(12 * (size_t)n[1], path);
    take(p, 12, n[0], file, path);
    take(index, 12, n[1], file, path);
    void *scene = build(device, p, n[0], index, n[1]);
    if (device_error(device)) fail("Embree reports an error", path);
    float size = extent(p, n[0]);
    const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path;
    int length = (int)strcspn(base, ".");
    for (unsigned s = 0; s < n[2]; s++) {
        char name[17] = {0};
        unsigned head[2], hits = 0;
        take(name, 1, 16, file, path);
        take(head, 4, 2, file, path);
        float *rays = room(28 * (size_t)head[1], path);
        take(rays, 28, head[1], file, path);
        double best = 0;
        for (int r = 0; r < rounds; r++) {
            double start = seconds();
            hits = pass(scene, rays, head[1], (int)head[0], size);
            double rate = head[1] / (seconds() - start) / 1e6;
            if (rate > best) best = rate;
        }
        printf("{\"kind\":\"rays\",\"renderer\":\"Embree %ld.%ld.%ld\",\"scene\":\"%.*s\",\"set\":\"%s\","
               "\"triangles\":%u,\"rays\":%u,\"mrays\":%.6g,\"hits\":%u}\n",
               version / 10000, version / 100 % 100, version % 100, length, base, name, n[1], head[1], best, hits);
        free(rays);
    }
    fclose(file);
}

int main(int count, char **words) {
    if (count < 4) fail("LIBEMBREE ROUNDS FILE...", "usage");
    load(words[1]);
    void *device = new_device("threads=1");
    if (!device) fail("no device", words[1]);
    long version = device_property(device, VERSION);
    for (int i = 3; i < count; i++) measure(device, version, atoi(words[2]), words[i]);
    return 0;
}

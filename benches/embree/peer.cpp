// The same pictures by Embree 3, in packets of N rays: what a fast library makes of the scene in the same time.
//
// Reads a scene that the benchmark has written, a row of single-precision numbers, writes the pixels as bytes
// of red, green and blue, and prints the milliseconds of the fastest of a few pictures.
//
// peer SCENE PIXELS

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <limits>
#include <thread>
#include <vector>

#include <embree3/rtcore.h>

namespace {

struct Vec {
    float x, y, z;
};

struct Material {
    Vec ambient, diffuse, specular;
    float exponent;
    bool reflective;
};

struct Light {
    Vec position;
    float intensity;
};

// Share of a length below which it is nothing.
constexpr float LITTLE = 2e-6f;
// Most mirror images in each other.
constexpr int MAX_MIRRORS = 64;
// Sides of the squares of pixels that the threads share.
constexpr int TILE = 32;

class Input {
public:
    explicit Input(const char *path) {
        std::ifstream file(path, std::ios::binary | std::ios::ate);
        numbers.resize(static_cast<size_t>(file.tellg()) / sizeof(float));
        file.seekg(0);
        file.read(reinterpret_cast<char *>(numbers.data()), numbers.size() * sizeof(float));
    }
    float number() { return numbers.at(next++); }
    int count() { return static_cast<int>(number()); }
    Vec vec() {
        float x = number(), y = number();
        return {x, y, number()};
    }

private:
    std::vector<float> numbers;
    size_t next = 0;
};

struct Scene {
    int width, height, mirrors, threads, repeats;
    Vec origin, right, up, forward, background;
    std::vector<Material> materials;
    std::vector<Light> lights;
    float intensity = 0;
    // By the number of the geometry, and in it of the primitive.
    std::vector<int> of_balls, of_triangles;
    std::vector<float> balls;
    RTCScene tree;

    explicit Scene(Input in);
    bool is_ball(unsigned geometry) const { return geometry == 0 && !of_balls.empty(); }
};

Scene::Scene(Input in) {
    width = in.count(), height = in.count(), mirrors = std::min(in.count(), MAX_MIRRORS);
    threads = in.count(), repeats = in.count();
    origin = in.vec(), right = in.vec(), up = in.vec(), forward = in.vec(), background = in.vec();
    materials.resize(in.count());
    for (Material &it : materials) {
        it.ambient = in.vec(), it.diffuse = in.vec(), it.specular = in.vec();
        it.exponent = in.number(), it.reflective = in.number() != 0;
    }
    lights.resize(in.count());
    for (Light &it : lights) {
        it.position = in.vec(), it.intensity = in.number();
        intensity += it.intensity;
    }
    RTCDevice device = rtcNewDevice(nullptr);
    tree = rtcNewScene(device);
    of_balls.resize(in.count());
    if (!of_balls.empty()) {
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
        auto *points = static_cast<float *>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 16, of_balls.size()));
        for (size_t i = 0; i < of_balls.size(); i++) {
            for (int part = 0; part < 4; part++) points[4 * i + part] = in.number();
            of_balls[i] = in.count();
        }
        balls.assign(points, points + 4 * of_balls.size());
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(tree, geometry);
    }
    // Corners may be shared: first the points, then the faces with their materials.
    int points_count = in.count();
    of_triangles.resize(in.count());
    if (!of_triangles.empty()) {
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto *points = static_cast<float *>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, points_count));
        for (int i = 0; i < 3 * points_count; i++) points[i] = in.number();
        auto *corners = static_cast<unsigned *>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, of_triangles.size()));
        for (size_t i = 0; i < of_triangles.size(); i++) {
            for (int part = 0; part < 3; part++) corners[3 * i + part] = in.count();
            of_triangles[i] = in.count();
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(tree, geometry);
    }
    rtcCommitScene(tree);
}

// Packets of N, and what Embree calls them.
template <int N> struct Packet;
template <> struct Packet<8> {
    using RayHit = RTCRayHit8;
    using Ray = RTCRay8;
    static constexpr auto intersect = rtcIntersect8;
    static constexpr auto occluded = rtcOccluded8;
    static constexpr int width = 4;
};
template <> struct Packet<16> {
    using RayHit = RTCRayHit16;
    using Ray = RTCRay16;
    static constexpr auto intersect = rtcIntersect16;
    static constexpr auto occluded = rtcOccluded16;
    static constexpr int width = 4;
};

template <int N> struct alignas(64) Colors {
    float r[N], g[N], b[N];
};

// Rays that start at a place a little above a surface, seen from the side of the normal.
template <int N> struct alignas(64) Places {
    float x[N], y[N], z[N], nx[N], ny[N], nz[N], vx[N], vy[N], vz[N], off[N];
    float exponent[N];
    Colors<N> diffuse, specular;
};

// Places, normals and materials of what the rays have met; whether some of it mirrors.
template <int N>
void look_up(const Scene &scene, const typename Packet<N>::RayHit &rays, const int *valid,
             Places<N> &at, Colors<N> &light, int *mirrors) {
    for (int i = 0; i < N; i++) {
        mirrors[i] = 0;
        light.r[i] = scene.background.x, light.g[i] = scene.background.y,
        light.b[i] = scene.background.z;
        if (!valid[i] || rays.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
        unsigned primitive = rays.hit.primID[i];
        bool is_ball = scene.is_ball(rays.hit.geomID[i]);
        const Material &it =
            scene.materials[is_ball ? scene.of_balls[primitive] : scene.of_triangles[primitive]];
        light.r[i] = it.ambient.x, light.g[i] = it.ambient.y, light.b[i] = it.ambient.z;
        at.diffuse.r[i] = it.diffuse.x, at.diffuse.g[i] = it.diffuse.y,
        at.diffuse.b[i] = it.diffuse.z;
        at.specular.r[i] = it.specular.x, at.specular.g[i] = it.specular.y,
        at.specular.b[i] = it.specular.z;
        at.exponent[i] = it.exponent;
        mirrors[i] = it.reflective ? -1 : 0;
    }
#pragma omp simd
    for (int i = 0; i < N; i++) {
        float t = rays.ray.tfar[i];
        float dx = rays.ray.dir_x[i], dy = rays.ray.dir_y[i], dz = rays.ray.dir_z[i];
        float nx = rays.hit.Ng_x[i], ny = rays.hit.Ng_y[i], nz = rays.hit.Ng_z[i];
        float scale = 1 / std::sqrt(nx * nx + ny * ny + nz * nz);
        scale = nx * dx + ny * dy + nz * dz > 0 ? -scale : scale;
        at.nx[i] = nx * scale, at.ny[i] = ny * scale, at.nz[i] = nz * scale;
        at.vx[i] = -dx, at.vy[i] = -dy, at.vz[i] = -dz;
        float x = rays.ray.org_x[i] + t * dx, y = rays.ray.org_y[i] + t * dy,
              z = rays.ray.org_z[i] + t * dz;
        float off = LITTLE * (std::max({std::fabs(x), std::fabs(y), std::fabs(z)}) + t) * 8;
        at.x[i] = x, at.y[i] = y, at.z[i] = z, at.off[i] = off;
    }
}

// Adds what a light gives where nothing is between.
template <int N>
void add_light(const Scene &scene, const Light &light, const int *met, const Places<N> &at,
               RTCIntersectContext &context, Colors<N> &sum) {
    alignas(64) typename Packet<N>::Ray shadow;
    alignas(64) int valid[N];
    alignas(64) float facing[N], highlight[N];
    int any = 0;
#pragma omp simd
    for (int i = 0; i < N; i++) {
        float x = light.position.x - at.x[i], y = light.position.y - at.y[i],
              z = light.position.z - at.z[i];
        float distance = std::sqrt(x * x + y * y + z * z), scale = 1 / distance;
        x *= scale, y *= scale, z *= scale;
        facing[i] = at.nx[i] * x + at.ny[i] * y + at.nz[i] * z;
        float hx = x + at.vx[i], hy = y + at.vy[i], hz = z + at.vz[i];
        float along = at.nx[i] * hx + at.ny[i] * hy + at.nz[i] * hz;
        highlight[i] = std::max(along / std::sqrt(hx * hx + hy * hy + hz * hz), 0.0f);
        shadow.org_x[i] = at.x[i] + at.nx[i] * at.off[i];
        shadow.org_y[i] = at.y[i] + at.ny[i] * at.off[i];
        shadow.org_z[i] = at.z[i] + at.nz[i] * at.off[i];
        shadow.dir_x[i] = x, shadow.dir_y[i] = y, shadow.dir_z[i] = z;
        shadow.tnear[i] = 0, shadow.tfar[i] = distance * (1 - 1e-5f), shadow.time[i] = 0;
        shadow.mask[i] = ~0u, shadow.flags[i] = 0;
        valid[i] = met[i] && facing[i] > 0 ? -1 : 0;
        any |= valid[i];
    }
    if (!any) return;
    Packet<N>::occluded(valid, scene.tree, &context, &shadow);
    alignas(64) float exponent[N], power[N];
    std::copy_n(at.exponent, N, exponent);
#pragma omp simd
    for (int i = 0; i < N; i++) power[i] = std::pow(highlight[i], exponent[i]);
#pragma omp simd
    for (int i = 0; i < N; i++) {
        float lit = valid[i] && shadow.tfar[i] >= 0 ? light.intensity : 0;
        float matte = facing[i] * lit, shine = power[i] * lit;
        sum.r[i] += lit > 0 ? at.diffuse.r[i] * matte + at.specular.r[i] * shine : 0;
        sum.g[i] += lit > 0 ? at.diffuse.g[i] * matte + at.specular.g[i] * shine : 0;
        sum.b[i] += lit > 0 ? at.diffuse.b[i] * matte + at.specular.b[i] * shine : 0;
    }
}

// Traces one packet of pixels from a corner on.
template <int N>
void trace(const Scene &scene, int left, int top, uint8_t *pixels) {
    constexpr int WIDE = Packet<N>::width;
    alignas(64) typename Packet<N>::RayHit rays;
    alignas(64) int valid[N], met[N], mirrors[N];
    Places<N> at;
    Colors<N> seen[MAX_MIRRORS + 1], kept[MAX_MIRRORS + 1];
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    float middle_x = scene.width / 2.0f, middle_y = scene.height / 2.0f, one = 1.0f / scene.height;
#pragma omp simd
    for (int i = 0; i < N; i++) {
        int column = left + i % WIDE, row = top + i / WIDE;
        valid[i] = column < scene.width && row < scene.height ? -1 : 0;
        float x = (column + 0.5f - middle_x) * one, y = (middle_y - row - 0.5f) * one;
        float dx = scene.right.x * x + scene.up.x * y + scene.forward.x;
        float dy = scene.right.y * x + scene.up.y * y + scene.forward.y;
        float dz = scene.right.z * x + scene.up.z * y + scene.forward.z;
        float scale = 1 / std::sqrt(dx * dx + dy * dy + dz * dz);
        rays.ray.org_x[i] = scene.origin.x, rays.ray.org_y[i] = scene.origin.y,
        rays.ray.org_z[i] = scene.origin.z;
        rays.ray.dir_x[i] = dx * scale, rays.ray.dir_y[i] = dy * scale,
        rays.ray.dir_z[i] = dz * scale;
    }
    int depth = 0;
    for (;; depth++) {
#pragma omp simd
        for (int i = 0; i < N; i++) {
            rays.ray.tnear[i] = 0, rays.ray.tfar[i] = std::numeric_limits<float>::infinity();
            rays.ray.time[i] = 0, rays.ray.mask[i] = ~0u, rays.ray.flags[i] = 0;
            rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        }
        Packet<N>::intersect(valid, scene.tree, &context, &rays);
        look_up<N>(scene, rays, valid, at, seen[depth], mirrors);
#pragma omp simd
        for (int i = 0; i < N; i++)
            met[i] = valid[i] && rays.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID ? -1 : 0;
        for (const Light &light : scene.lights)
            add_light<N>(scene, light, met, at, context, seen[depth]);
        int any = 0;
#pragma omp simd
        for (int i = 0; i < N; i++) {
            valid[i] = mirrors[i];
            any |= valid[i];
            float times = mirrors[i] ? scene.intensity : 0;
            kept[depth].r[i] = mirrors[i] ? at.specular.r[i] * times : 0;
            kept[depth].g[i] = mirrors[i] ? at.specular.g[i] * times : 0;
            kept[depth].b[i] = mirrors[i] ? at.specular.b[i] * times : 0;
        }
        if (!any || depth == scene.mirrors) break;
#pragma omp simd
        for (int i = 0; i < N; i++) {
            float twice = 2 * (at.nx[i] * at.vx[i] + at.ny[i] * at.vy[i] + at.nz[i] * at.vz[i]);
            rays.ray.org_x[i] = at.x[i] + at.nx[i] * at.off[i];
            rays.ray.org_y[i] = at.y[i] + at.ny[i] * at.off[i];
            rays.ray.org_z[i] = at.z[i] + at.nz[i] * at.off[i];
            rays.ray.dir_x[i] = twice * at.nx[i] - at.vx[i];
            rays.ray.dir_y[i] = twice * at.ny[i] - at.vy[i];
            rays.ray.dir_z[i] = twice * at.nz[i] - at.vz[i];
        }
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    }
    // From the last mirror image back to the eye: none is brighter than white.
    Colors<N> sum;
    auto to_white = [](float value) { return std::min(value / 255, 1.0f); };
#pragma omp simd
    for (int i = 0; i < N; i++)
        sum.r[i] = to_white(seen[depth].r[i]), sum.g[i] = to_white(seen[depth].g[i]),
        sum.b[i] = to_white(seen[depth].b[i]);
    while (depth-- > 0)
#pragma omp simd
        for (int i = 0; i < N; i++) {
            sum.r[i] = to_white(seen[depth].r[i] + kept[depth].r[i] * sum.r[i]);
            sum.g[i] = to_white(seen[depth].g[i] + kept[depth].g[i] * sum.g[i]);
            sum.b[i] = to_white(seen[depth].b[i] + kept[depth].b[i] * sum.b[i]);
        }
    for (int i = 0; i < N; i++) {
        int column = left + i % WIDE, row = top + i / WIDE;
        if (column >= scene.width || row >= scene.height) continue;
        uint8_t *pixel = pixels + 3 * (static_cast<size_t>(row) * scene.width + column);
        pixel[0] = static_cast<uint8_t>(sum.r[i] * 255 + 0.5f);
        pixel[1] = static_cast<uint8_t>(sum.g[i] * 255 + 0.5f);
        pixel[2] = static_cast<uint8_t>(sum.b[i] * 255 + 0.5f);
    }
}

template <int N> double picture(const Scene &scene, uint8_t *pixels) {
    constexpr int WIDE = Packet<N>::width, HIGH = N / Packet<N>::width;
    int columns = (scene.width + TILE - 1) / TILE, rows = (scene.height + TILE - 1) / TILE;
    std::atomic<int> next{0};
    auto work = [&] {
        for (int tile; (tile = next++) < columns * rows;) {
            int left = tile % columns * TILE, top = tile / columns * TILE;
            for (int y = top; y < std::min(top + TILE, scene.height); y += HIGH)
                for (int x = left; x < std::min(left + TILE, scene.width); x += WIDE)
                    trace<N>(scene, x, y, pixels);
        }
    };
    auto start = std::chrono::steady_clock::now();
    std::vector<std::thread> others;
    for (int i = 1; i < scene.threads; i++) others.emplace_back(work);
    work();
    for (std::thread &other : others) other.join();
    std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
    return taken.count();
}

} // namespace

int main(int, char **words) {
    Scene scene{Input(words[1])};
    std::vector<uint8_t> pixels(3 * static_cast<size_t>(scene.width) * scene.height);
    double by_8 = std::numeric_limits<double>::infinity(), by_16 = by_8;
    for (int i = 0; i < scene.repeats; i++) {
        by_8 = std::min(by_8, picture<8>(scene, pixels.data()));
        by_16 = std::min(by_16, picture<16>(scene, pixels.data()));
    }
    std::ofstream file(words[2], std::ios::binary);
    file.write(reinterpret_cast<char *>(pixels.data()), pixels.size());
    std::printf("%f %f\n", by_8, by_16);
    return file.good() ? 0 : 1;
}

// Rays against triangles, beside Embree: docs/reference/measures.md.
//
// The mesh is a closed ball with bumps (tests/trace/mesh_sets.hpp). Half of
// the rays begin at random places inside of it, the others on a sphere around it, in random directions. Each searcher
// finds the closest hits of all, then whether anything is hit; medians of the repeats, which take turns, as the builds
// of the trees do. The stream is Embree's call for many rays at once. Exits 3 where more than one hit in 10,000 is
// another triangle than Embree's.
#include "stopwatch.hpp"
#include "verbs.hpp"

#include "../tests/trace/mesh_sets.hpp"

#include <photongrid/backends/cpu/cpu.hpp>
#include <photongrid/backends/serial/serial.hpp>
#include <photongrid/trace/ray_search.hpp>

#include <embree3/rtcore.h>

#include <cstdio>
#include <cstring>
#include <limits>

namespace {

using namespace photongrid;
using namespace photongrid::bench;
using std::size_t;

struct arguments {
    uint triangles = 100000;
    size_t rays = 100000;
    int repeats = 5;
    uint threads = 1; // that build the trees
};

/// The mesh in Embree.
class embree_mesh {
public:
    embree_mesh(const mesh& m, RTCSceneFlags flags, uint threads)
        : device_(rtcNewDevice(("threads=" + std::to_string(threads)).c_str())), scene_(rtcNewScene(device_))
    {
        rtcSetDeviceMemoryMonitorFunction(
            device_,
            [](void* bytes, ssize_t change, bool) {
                *static_cast<ssize_t*>(bytes) += change;
                return true;
            },
            &bytes_);
        rtcSetSceneFlags(scene_, flags);
        rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_MEDIUM);
        RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetGeometryBuildQuality(g, RTC_BUILD_QUALITY_MEDIUM);
        std::memcpy(rtcSetNewGeometryBuffer(
                        g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), m.positions.size()),
            m.positions.data(), m.positions.size() * sizeof(glm::vec3));
        std::memcpy(rtcSetNewGeometryBuffer(
                        g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), m.triangles.size()),
            m.triangles.data(), m.triangles.size() * sizeof(glm::uvec3));
        rtcCommitGeometry(g);
        rtcAttachGeometry(scene_, g);
        rtcReleaseGeometry(g);
        build_seconds_ = seconds_of([&] { rtcCommitScene(scene_); });
    }
    embree_mesh(const embree_mesh&) = delete;
    embree_mesh& operator=(const embree_mesh&) = delete;
    ~embree_mesh()
    {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }

    double build_seconds() const { return build_seconds_; }
    /// Of the tree and the mesh.
    double bytes() const { return static_cast<double>(bytes_); }

    ray_hit closest(const glm::vec4& o, const glm::vec4& d) const
    {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRayHit r;
        r.ray = {o.x, o.y, o.z, 0, d.x, d.y, d.z, 0, o.w, ~0u, 0, 0};
        r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_, &context, &r);
        return {r.ray.tfar, r.hit.geomID == RTC_INVALID_GEOMETRY_ID ? no_id : r.hit.primID};
    }
    /// All at once, by Embree's streams of incoherent rays.
    std::vector<ray_hit> closest(const testing::ray_set& rays) const
    {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context); // incoherent
        std::vector<RTCRayHit> stream(rays.origins.size());
        for (size_t i = 0; i < stream.size(); ++i) {
            const auto &o = rays.origins[i], &d = rays.directions[i];
            stream[i].ray = {o.x, o.y, o.z, 0, d.x, d.y, d.z, 0, o.w, ~0u, 0, 0};
            stream[i].hit.geomID = RTC_INVALID_GEOMETRY_ID;
        }
        rtcIntersect1M(scene_, &context, stream.data(), static_cast<unsigned>(stream.size()), sizeof(RTCRayHit));
        std::vector<ray_hit> hits;
        for (const auto& r : stream)
            hits.push_back({r.ray.tfar, r.hit.geomID == RTC_INVALID_GEOMETRY_ID ? no_id : r.hit.primID});
        return hits;
    }
    bool any(const glm::vec4& o, const glm::vec4& d) const
    {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRay r{o.x, o.y, o.z, 0, d.x, d.y, d.z, 0, o.w, ~0u, 0, 0};
        rtcOccluded1(scene_, &context, &r);
        return r.tfar < 0;
    }

private:
    RTCDevice device_;
    RTCScene scene_;
    ssize_t bytes_ = 0;
    double build_seconds_ = 0;
};

testing::ray_set random_rays(size_t n)
{
    std::mt19937 bits(1);
    std::normal_distribution<float> normal;
    const auto direction = [&] { return glm::normalize(glm::vec3(normal(bits), normal(bits), normal(bits))); };
    testing::ray_set rays;
    for (size_t i = 0; i < n; ++i) {
        const glm::vec3 o
            = i % 2 == 0 ? 0.7f * static_cast<float>(bits() >> 8) * 0x1p-24f * direction() : 2.0f * direction();
        rays.origins.emplace_back(o, std::numeric_limits<float>::infinity());
        rays.directions.emplace_back(i % 2 == 0 ? direction() : glm::normalize(0.9f * direction() - o), 0.0f);
    }
    return rays;
}

template <backend B>
struct ours {
    B device;
    device_triangles<B> triangles;
    buffer_of<B, glm::vec4> origins, directions;

    ours(B b, const triangle_tree& tree, const testing::ray_set& rays)
        : device(std::move(b)), triangles(upload_triangles(device, tree)), origins(upload(device, rays.origins)),
          directions(upload(device, rays.directions))
    {
    }
    std::vector<ray_hit> trace(hit_kind kind)
    {
        return trace_rays(device, triangles, origins, directions, {.kind = kind});
    }
};

int run_rays(const arguments& a)
{
    constexpr size_t all_searchers = 5; // the last one only of closest hits
    const mesh m = testing::bumpy_ball(testing::rings_of(a.triangles), 1, 0.2f);
    const auto rays = random_rays(a.rays);
    const auto n = static_cast<double>(m.triangles.size());

    std::printf("%zu triangles, %zu rays; trees by %u threads, rays by one\n", m.triangles.size(), a.rays, a.threads);
    std::vector<double> build, uploading, embree_build;
    for (int r = 0; r < a.repeats; ++r) {
        cpu_backend builder(a.threads); // a new one each time, which holds no memory yet
        triangle_tree built;
        build.push_back(seconds_of([&] { built = build_triangle_tree(builder, m); }));
        uploading.push_back(seconds_of([&] { (void)upload_triangles(builder, built); }));
        embree_build.push_back(embree_mesh(m, RTC_SCENE_FLAG_NONE, a.threads).build_seconds());
    }
    std::printf("build: photongrid %.3f s, for cpu %.3f s more, Embree %.3f s; %.2f of Embree's\n", median(build),
        median(uploading), median(embree_build), (median(build) + median(uploading)) / median(embree_build));
    const embree_mesh fast(m, RTC_SCENE_FLAG_NONE, a.threads), robust(m, RTC_SCENE_FLAG_ROBUST, a.threads);
    const double mesh_bytes = 12.0 * static_cast<double>(m.positions.size() + m.triangles.size());
    const auto tree = build_triangle_tree(m);
    ours<serial_backend> serial(serial_backend{}, tree, rays);
    ours<cpu_backend> cpu(cpu_backend(1), tree, rays);
    std::printf(
        "bytes a triangle, vertices and indices included: photongrid %.0f, cpu %.0f, Embree %.0f; pairs deep: %u\n",
        (16.0 * static_cast<double>(tree.pairs.size() + tree.corners.size()) + mesh_bytes) / n,
        (static_cast<double>(cpu.triangles.bytes()) + mesh_bytes) / n, fast.bytes() / n, tree.depth);

    std::vector<ray_hit> hits[all_searchers];
    const char* names[] = {"photongrid serial", "photongrid cpu", "Embree", "Embree, robust", "Embree, stream"};
    const auto peer = [&](const embree_mesh& e, hit_kind kind) {
        std::vector<ray_hit> found;
        for (size_t i = 0; i < a.rays; ++i)
            found.push_back(kind == hit_kind::closest
                    ? e.closest(rays.origins[i], rays.directions[i])
                    : ray_hit{0, e.any(rays.origins[i], rays.directions[i]) ? 0 : no_id});
        return found;
    };
    const std::function<std::vector<ray_hit>(hit_kind)> searchers[] = {[&](hit_kind k) { return serial.trace(k); },
        [&](hit_kind k) { return cpu.trace(k); }, [&](hit_kind k) { return peer(fast, k); },
        [&](hit_kind k) { return peer(robust, k); }, [&](hit_kind) { return fast.closest(rays); }};
    int status = 0;
    for (const auto kind : {hit_kind::closest, hit_kind::any}) {
        const size_t searchers_now = kind == hit_kind::closest ? all_searchers : all_searchers - 1;
        std::vector<double> seconds[all_searchers];
        for (int r = 0; r < a.repeats; ++r)
            for (size_t s = 0; s < searchers_now; ++s)
                seconds[s].push_back(seconds_of([&] { hits[s] = searchers[s](kind); }));
        for (size_t s = 0; s < searchers_now; ++s) {
            size_t other = 0, escaped = 0;
            for (size_t i = 0; i < a.rays; ++i) {
                other += (kind == hit_kind::closest ? hits[s][i].triangle != hits[2][i].triangle
                                                    : (hits[s][i].triangle == no_id) != (hits[2][i].triangle == no_id))
                    ? 1
                    : 0;
                escaped += i % 2 == 0 && hits[s][i].triangle == no_id ? 1 : 0;
            }
            std::printf(
                "%s, %s: %.0f k rays/s, %.2f of Embree's; %zu hits that are not Embree's; %zu of %zu left the ball\n",
                kind == hit_kind::closest ? "closest" : "any", names[s],
                static_cast<double>(a.rays) / median(seconds[s]) / 1000, median(seconds[2]) / median(seconds[s]), other,
                escaped, a.rays / 2);
            if (kind == hit_kind::closest && other > a.rays / 10000)
                status = 3;
        }
    }
    return status;
}

} // namespace

photongrid::bench::verb_run photongrid::bench::add_rays(CLI::App& verb)
{
    const auto a = std::make_shared<arguments>();
    verb.add_option("--triangles", a->triangles, "about")->check(CLI::PositiveNumber);
    verb.add_option("--rays", a->rays)->check(CLI::PositiveNumber);
    verb.add_option("--repeats", a->repeats)->check(CLI::PositiveNumber);
    verb.add_option("--threads", a->threads, "that build the trees; one searches")->check(CLI::PositiveNumber);
    return [a] { return run_rays(*a); };
}

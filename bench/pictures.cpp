// A room with a mesh, drawn at 512 x 512: docs/reference/measures.md.
//
// The mesh is a closed ball with bumps and normals (tests/trace/mesh_sets.hpp). Medians of three: the time until the
// first preview is there and until the picture is, the tree and everything else included; what each stage takes; and
// the bytes of the mesh on the device.
#include "backends.hpp"
#include "stopwatch.hpp"
#include "verbs.hpp"

#include "../tests/trace/mesh_sets.hpp"

#include <photongrid/render/render.hpp>

#include <chrono>
#include <cmath>
#include <cstdio>

#include <sys/resource.h>

namespace {

using namespace photongrid;
using namespace photongrid::bench;

struct arguments {
    uint triangles = 1'000'000, places = 1;
    bool apart = false;
    std::string backend = "cpu";
};

scene room_with_balls(const arguments& a)
{
    auto ball = testing::bumpy_ball(testing::rings_of(a.triangles), 0.7f, 0.2f);
    ball.normals = ball.positions; // not quite those of the bumps; the time is the same
    scene s;
    s.name = "room_with_ball";
    s.materials
        = {{"white", material_kind::lambertian, dvec3(0.7)}, {"clay", material_kind::lambertian, {0.7, 0.45, 0.3}}};
    s.polygons = {{{{-2, 0, -2}, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2}}, 0},
        {{{-2, 0, 2}, {-2, 3, 2}, {2, 3, 2}, {2, 0, 2}}, 0}, {{{-2, 0, -2}, {-2, 3, -2}, {-2, 3, 2}, {-2, 0, 2}}, 0}};
    auto surface = std::make_shared<const mesh>(std::move(ball));
    s.meshes = {{"", surface, glm::dmat3(1), {0, 0.85, 0}, 1}};
    if (a.places > 1) {
        // Turned balls in rows on the floor.
        const auto rows = static_cast<uint>(std::ceil(std::sqrt(a.places)));
        const double apart_by = 3.6 / rows, size = 0.6 * apart_by;
        s.meshes.clear();
        for (uint i = 0; i < a.places; ++i) {
            const double turn = 0.7 * i, c = size * std::cos(turn), d = size * std::sin(turn);
            if (a.apart)
                surface = std::make_shared<const mesh>(*surface);
            s.meshes.push_back({"", surface, glm::dmat3(c, 0, -d, 0, size, 0, d, 0, c),
                {-1.8 + apart_by * (i % rows + 0.5), 0.85 * size, -1.8 + apart_by * (i / rows + 0.5)}, 1});
        }
    }
    s.rectangle_lights = {{"lamp", {-0.5, 2.9, -0.5}, {1, 0, 0}, {0, 0, 1}, dvec3(40)}};
    s.camera = {{0, 1.6, -4.2}, {0, 0.75, 0}, {0, 1, 0}, 45};
    s.render = {.map = {.photons = 200000, .builder = map_builder::automatic, .grid = glm::uvec3(0)},
        .estimate = {.k = 100, .max_radius = 0.3},
        .view = {.spp = 1, .light_samples = 4},
        .output = {.width = 512, .height = 512}};
    return s;
}

template <class B>
void measure(B& device, const scene& s)
{
    std::vector<double> first, whole, upload, photons, map, rays, estimate;
    std::uint64_t bytes = 0;
    for (int run = 0; run < 3; ++run) {
        upload.push_back(seconds_of([&] {
            const auto before = device.bytes();
            const auto on_device = upload_scene(device, s);
            device.finish();
            bytes = device.bytes() - before;
        }));
        double until_first = 0;
        const auto start = std::chrono::steady_clock::now();
        render_observer watch;
        watch.intermediate = [&](const image&) {
            if (until_first == 0)
                until_first = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        };
        const auto stats = render(device, s, s.render, watch).stats;
        whole.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        first.push_back(until_first);
        photons.push_back(stats.trace_photons.ms / 1000);
        map.push_back(stats.build_map.ms / 1000);
        rays.push_back(stats.trace_rays.ms / 1000);
        estimate.push_back(stats.radiance_estimate.ms / 1000);
    }
    const double triangles = static_cast<double>(s.meshes.size() * s.meshes[0].surface->triangles.size());
    std::printf("%s, %.0f triangles in %zu places: first preview %.2f s, picture %.2f s; upload with the tree %.2f s, "
                "trace_photons %.2f, "
                "build_map %.2f, trace_rays %.2f, radiance_estimate %.2f\n",
        device.caps().backend.c_str(), triangles, s.meshes.size(), median(first), median(whole), median(upload),
        median(photons), median(map), median(rays), median(estimate));
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    std::printf(
        "%.1f bytes a triangle on the device, vertices and normals included; at most %.2f GiB of memory in all\n",
        static_cast<double>(bytes) / triangles, static_cast<double>(used.ru_maxrss) / (1024.0 * 1024));
}

} // namespace

photongrid::bench::verb_run photongrid::bench::add_pictures(CLI::App& verb)
{
    const auto a = std::make_shared<arguments>();
    verb.add_option("--triangles", a->triangles, "of the mesh, about")->check(CLI::PositiveNumber);
    verb.add_option("--places", a->places, "in which it stands")->check(CLI::PositiveNumber);
    verb.add_flag("--apart", a->apart, "its surface is stored for each place");
    verb.add_option("--backend", a->backend)->check(CLI::IsMember(backend_names));
    return [a] {
        const auto s = room_with_balls(*a);
        on_backend(a->backend, [&](auto&& device) { measure(device, s); });
        return 0;
    };
}

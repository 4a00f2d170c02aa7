// A room with a mesh, drawn at 512 x 512: docs/reference/measures.md.
//
//   mesh_pictures [--triangles N] [--places M] [--stored once|apart] [--backend serial|cpu|gl|vulkan]
//
// The mesh is a closed ball with bumps and normals (tests/trace/mesh_sets.hpp) of about N triangles, 1,000,000 unless
// given; it stands in M places, 1 unless given, and its surface is stored once, or for each place; on cpu unless a
// backend is given. Medians of three: the time until the first preview is there and until the
// picture is, the tree and everything else included; what each stage takes; and the bytes of the mesh on the device.
#include "median.hpp"
#include "stopwatch.hpp"

#include "../tests/trace/mesh_sets.hpp"

#include <photongrid/backends/cpu/cpu.hpp>
#include <photongrid/backends/gl/gl.hpp>
#include <photongrid/backends/serial/serial.hpp>
#include <photongrid/backends/vulkan/vulkan.hpp>
#include <photongrid/render/render.hpp>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <sys/resource.h>

namespace {

using namespace photongrid;
using namespace photongrid::bench;

scene room_with_balls(uint triangles, uint places, bool apart)
{
    auto ball = testing::bumpy_ball(testing::rings_of(triangles), 0.7f, 0.2f);
    ball.normals = ball.positions; // not quite those of the bumps; the time is the same
    scene s;
    s.name = "room_with_ball";
    s.materials
        = {{"white", material_kind::lambertian, dvec3(0.7)}, {"clay", material_kind::lambertian, {0.7, 0.45, 0.3}}};
    s.polygons = {{{{-2, 0, -2}, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2}}, 0},
        {{{-2, 0, 2}, {-2, 3, 2}, {2, 3, 2}, {2, 0, 2}}, 0}, {{{-2, 0, -2}, {-2, 3, -2}, {-2, 3, 2}, {-2, 0, 2}}, 0}};
    auto surface = std::make_shared<const mesh>(std::move(ball));
    s.meshes = {{"", surface, glm::dmat3(1), {0, 0.85, 0}, 1}};
    if (places > 1) {
        // Turned balls in rows on the floor.
        const auto rows = static_cast<uint>(std::ceil(std::sqrt(places)));
        const double apart_by = 3.6 / rows, size = 0.6 * apart_by;
        s.meshes.clear();
        for (uint i = 0; i < places; ++i) {
            const double turn = 0.7 * i, c = size * std::cos(turn), d = size * std::sin(turn);
            if (apart)
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

int main(int argc, char** argv)
{
    uint triangles = 1'000'000, places = 1;
    bool apart = false;
    std::string backend = "cpu";
    for (int i = 1; i < argc; ++i) {
        const std::string name = argv[i], value = i + 1 < argc ? argv[i + 1] : "";
        if (name == "--triangles" && std::atoi(value.c_str()) > 0) {
            triangles = static_cast<uint>(std::atoi(value.c_str()));
        } else if (name == "--places" && std::atoi(value.c_str()) > 0) {
            places = static_cast<uint>(std::atoi(value.c_str()));
        } else if (name == "--stored" && (value == "once" || value == "apart")) {
            apart = value == "apart";
        } else if (name == "--backend" && (value == "serial" || value == "cpu" || value == "gl" || value == "vulkan")) {
            backend = value;
        } else {
            std::fprintf(stderr, "mesh_pictures: \"%s %s\" is no argument of it; the source's first lines list them\n",
                name.c_str(), value.c_str());
            return 2;
        }
        ++i;
    }
    const auto s = room_with_balls(triangles, places, apart);
    const auto on = [&](auto&& device) { measure(device, s); };
    if (backend == "serial")
        on(serial_backend());
    else if (backend == "cpu")
        on(cpu_backend());
    else if (backend == "gl")
        on(gl_backend());
    else
        on(vulkan_backend());
}

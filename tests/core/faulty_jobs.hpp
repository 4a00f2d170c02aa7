// What a device that fails is asked to do: every algorithm, and the renderer.
#pragma once

#include "../map/photon_sets.hpp"
#include "../scene/test_scenes.hpp"
#include "faulty_backend.hpp"

#include <photongrid/backends/serial/serial.hpp>
#include <photongrid/estimate/knn_neighbours.hpp>
#include <photongrid/map/hashed_route.hpp>
#include <photongrid/map/map_file.hpp>
#include <photongrid/render/progressive_render.hpp>
#include <photongrid/render/render.hpp>

#include <chrono>
#include <filesystem>
#include <ostream>

#include <unistd.h>

namespace photongrid {
namespace {

    using testing::fault;
    static_assert(backend<testing::faulty_backend<serial_backend>>);

    template <class T>
    void append(std::string& bits, const std::vector<T>& data)
    {
        bits.append(reinterpret_cast<const char*>(data.data()), data.size() * sizeof(T));
    }

    /// Something to do on a backend; the bits of its answer.
    template <class B>
    struct job {
        const char* name;
        std::string (*run)(B&);
    };
    template <class B>
    std::ostream& operator<<(std::ostream& out, const job<B>& j)
    {
        return out << j.name;
    }

    template <class B>
    std::string sort(B& b, std::uint32_t n)
    {
        testing::random_source u(n);
        std::vector<glm::uvec2> pairs(n);
        for (std::uint32_t i = 0; i < n; ++i)
            pairs[i] = {u.below(50), i};
        auto buffer = b.upload(std::span<const glm::uvec2>(pairs));
        bitonic_sort(b, buffer);
        const auto index = grid_index(b, buffer, 50);
        std::string bits;
        append(bits, b.download(buffer));
        append(bits, b.download(index));
        return bits;
    }

    template <class B>
    std::string estimate(B& b, bool routed)
    {
        const auto set = testing::make_photons(testing::distribution::clustered, 300, {5, 4, 3}, 7);
        auto p = testing::upload_photons(b, set);
        const auto map = routed ? routed_map(b, std::move(p), set.g, 2) : sorted_map(b, std::move(p), set.g);
        const auto points = b.upload(std::span<const glm::vec4>(testing::make_points(set, 40, 8)));
        const auto e = knn_grid_estimate(b, map, points, {.k = 12, .max_radius = 0.4f});
        std::string bits;
        append(bits, b.download(e.irradiance));
        append(bits, b.download(e.used));
        append(bits, std::vector<double>{redistributed_power(b, map)});
        return bits;
    }

    template <class B>
    std::string route(B& b)
    {
        const auto set = testing::make_photons(testing::distribution::clustered, 300, {5, 4, 3}, 7);
        const auto p = testing::upload_photons(b, set);
        const auto r = stencil_route(b, p, set.g, 2);
        std::string bits;
        append(bits, b.download(r.list));
        append(bits, b.download(r.powers));
        append(bits, std::vector<std::uint64_t>{r.overflowing_cells});
        return bits;
    }

    template <class B>
    std::string hashed(B& b, bucket_kind kind)
    {
        const auto set = testing::make_photons(testing::distribution::clustered, 300, {5, 4, 3}, 7);
        const auto r = hashed_route(b, testing::upload_photons(b, set),
            make_virtual_grid(glm::vec3(0), glm::vec3(1), glm::uvec3(1000)), {.kind = kind, .m = 2});
        std::string bits;
        append(bits, b.download(r.list));
        append(bits, b.download(r.photons.powers));
        append(bits, std::vector<uint>{r.overflowing_buckets, r.dropped, r.invalid, r.left_out, r.occupied_cells});
        return bits;
    }

    template <class B>
    rendered picture(B& b, map_builder builder, const render_observer& observer = {})
    {
        auto s = testing::small_cornell(); // glass, a mirror, a lamp
        s.render.output.width = 6;
        s.render.output.height = 5;
        s.render.map.photons = 300;
        s.render.estimate.k = 8;
        s.render.map.photon_depth = 9; // asks once whether any path goes on
        s.render.view.light_samples = 1;
        s.render.map.builder = builder;
        return render(b, s, s.render, observer);
    }

    template <class B>
    std::string render_bits(B& b, map_builder builder, const render_observer& observer = {})
    {
        const auto [p, stats] = picture(b, builder, observer);
        std::string bits;
        append(bits, p.pixels);
        append(bits,
            std::vector<std::uint64_t>{stats.photons.emitted, stats.photons.stored, stats.photons.absorbed,
                stats.photons.dropped, stats.map.overflowing_cells});
        return bits;
    }

    template <class B>
    std::string lists(B& b)
    {
        const auto set = testing::make_photons(testing::distribution::clustered, 300, {5, 4, 3}, 7);
        const auto map = sorted_map(b, testing::upload_photons(b, set), set.g);
        const auto points = b.upload(std::span<const glm::vec4>(testing::make_points(set, 40, 8)));
        const auto found = knn_neighbours(b, map, points, {.k = 20, .max_radius = 0.4f});
        std::string bits;
        append(bits, b.download(found.ids));
        append(bits, b.download(found.distances2));
        return bits;
    }

    /// Saves a map and loads it again.
    template <class B>
    std::string map_in_a_file(B& b)
    {
        namespace fs = std::filesystem;
        const auto path = fs::temp_directory_path() / ("photongrid_faulty_map_" + std::to_string(::getpid()));
        const struct removed {
            const fs::path& path;
            ~removed() { fs::remove(path); }
        } at_the_end{path};
        const auto set = testing::make_photons(testing::distribution::clustered, 300, {5, 4, 3}, 7);
        save_map(b, sorted_map(b, testing::upload_photons(b, set), set.g), path);
        const auto map = load_map(b, path);
        std::string bits;
        append(bits, b.download(map.cells));
        append(bits, b.download(map.list));
        append(bits, b.download(map.photons.positions));
        return bits;
    }

    /// The program's and the window's loop: a drawing that is changed and begins again, with the previews in between.
    template <class B>
    std::string progressive(B& b)
    {
        auto s = testing::small_cornell();
        s.render.output.width = 16;
        s.render.output.height = 12;
        s.render.map.photons = 300;
        s.render.estimate.k = 8;
        s.render.map.photon_depth = 5;
        s.render.view.light_samples = 1;
        progressive_render<B> loop(b);
        std::string bits;
        for (const double x : {0.0, 0.1}) {
            s.camera.position.x += x;
            loop.start(s, s.render, {.target_ms = 1e-6, .running_estimates = true}); // always out of time
            while (!loop.step(std::chrono::milliseconds(0)))
                if (loop.pictures() > 0)
                    (void)loop.picture();
            append(bits, loop.picture().pixels);
        }
        return bits;
    }

    template <class B>
    constexpr job<B> jobs[] = {
        {"sort", [](B& b) { return sort(b, 128); }},
        {"sort_padded", [](B& b) { return sort(b, 100); }},
        {"stencil_route", [](B& b) { return route(b); }},
        {"hashed_route_by_rank", [](B& b) { return hashed(b, bucket_kind::rank); }},
        {"hashed_route", [](B& b) { return hashed(b, bucket_kind::hash); }},
        {"sorted_map_and_estimate", [](B& b) { return estimate(b, false); }},
        {"routed_map_and_estimate", [](B& b) { return estimate(b, true); }},
        {"neighbour_lists", [](B& b) { return lists(b); }},
        {"map_in_a_file", [](B& b) { return map_in_a_file(b); }},
        {"render_sorted", [](B& b) { return render_bits(b, map_builder::sort); }},
        {"render_routed", [](B& b) { return render_bits(b, map_builder::route); }},
        {"render_watched",
            [](B& b) {
                render_observer observer;
                observer.intermediate = [](const image&) {};
                return render_bits(b, map_builder::sort, observer);
            }},
        {"progressive", [](B& b) { return progressive(b); }},
    };

} // namespace
} // namespace photongrid

// What a device that fails is asked to do: every algorithm, and the renderer.
#pragma once

#include "../backends/serial_pictures.hpp"
#include "../map/photon_sets.hpp"
#include "../scene/test_scenes.hpp"
#include "faulty_backend.hpp"

#include <photongrid/render/render.hpp>

#include <ostream>

namespace photongrid {
namespace {

    using testing::fault;
    using faulty = testing::faulty_backend<serial_backend>;
    static_assert(backend<faulty>);

    template <class T>
    void append(std::string& bits, const std::vector<T>& data)
    {
        bits.append(reinterpret_cast<const char*>(data.data()), data.size() * sizeof(T));
    }

    /// Something to do on a backend; the bits of its answer.
    struct job {
        const char* name;
        std::string (*run)(faulty&);
    };
    std::ostream& operator<<(std::ostream& out, const job& j) { return out << j.name; }

    std::string sort(faulty& b, std::uint32_t n)
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

    std::string estimate(faulty& b, bool routed)
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

    std::string route(faulty& b)
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

    rendered picture(faulty& b, map_builder builder, const render_observer& observer = {})
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

    std::string render_bits(faulty& b, map_builder builder, const render_observer& observer = {})
    {
        const auto [p, stats] = picture(b, builder, observer);
        std::string bits;
        append(bits, p.pixels);
        append(bits,
            std::vector<std::uint64_t>{stats.photons.emitted, stats.photons.stored, stats.photons.absorbed,
                stats.photons.dropped, stats.map.overflowing_cells});
        return bits;
    }

    const job jobs[] = {
        {"sort", [](faulty& b) { return sort(b, 128); }},
        {"sort_padded", [](faulty& b) { return sort(b, 100); }},
        {"stencil_route", route},
        {"sorted_map_and_estimate", [](faulty& b) { return estimate(b, false); }},
        {"routed_map_and_estimate", [](faulty& b) { return estimate(b, true); }},
        {"render_sorted", [](faulty& b) { return render_bits(b, map_builder::sort); }},
        {"render_routed", [](faulty& b) { return render_bits(b, map_builder::route); }},
        {"render_watched",
            [](faulty& b) {
                render_observer observer;
                observer.intermediate = [](const image&) {};
                return render_bits(b, map_builder::sort, observer);
            }},
    };

} // namespace
} // namespace photongrid

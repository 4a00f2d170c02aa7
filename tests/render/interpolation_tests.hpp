// Estimates that are interpolated between those of near pixels: which are, their values, and pictures with them.
#pragma once

#include "shrinking_radii_tests.hpp"

#include <array>

namespace photongrid::testing {

/// A picture of points that lie in rows, each a step to the side or down from the next.
struct rows_of_points {
    glm::uvec2 size;
    std::vector<glm::vec4> points, normals;

    rows_of_points(glm::uvec2 pixels, glm::vec2 step, glm::vec2 first)
        : size(pixels), normals(pixels.x * pixels.y, glm::vec4(0, 1, 0, 0))
    {
        for (uint y = 0; y < size.y; ++y)
            for (uint x = 0; x < size.x; ++x)
                points.emplace_back(
                    first.x + step.x * static_cast<float>(x), 0, first.y + step.y * static_cast<float>(y), 1);
    }
};

/// Estimates as the host reads them.
struct read_estimates {
    std::vector<glm::vec4> irradiance;
    std::vector<glm::uvec2> used;

    /// An interpolated estimate visits no photon.
    bool is_interpolated(std::size_t i) const { return used[i].y == 0; }
    std::size_t interpolated() const
    {
        std::size_t n = 0;
        for (std::size_t i = 0; i < used.size(); ++i)
            n += is_interpolated(i) ? 1 : 0;
        return n;
    }
};

template <backend B>
read_estimates estimates_at(
    B& b, const map_buffers<B>& map, const rows_of_points& rows, const knn_settings& search, double spacing)
{
    const auto points = b.upload(std::span<const glm::vec4>(rows.points));
    const auto normals = b.upload(std::span<const glm::vec4>(rows.normals));
    const estimate_sources<B> from{.map = &map, .search = search};
    interpolated_estimates<B> estimates(
        b, from, {rows.size, spacing}, points, normals, running_estimate_kind::none, step_size::largest);
    while (!estimates.advance()) {}
    const auto found = estimates.take();
    return {b.download(found.irradiance), b.download(found.used)};
}

/// Whether the estimate of pixel i is interpolated among the corners of its tile of these sides, which are near enough,
/// and has their least radius.
inline bool is_bilinear(
    const read_estimates& all, const rows_of_points& rows, std::size_t i, glm::uvec2 sides, double spacing)
{
    const std::size_t x = i % rows.size.x, y = i / rows.size.x;
    const std::size_t left = x / sides.x * sides.x, top = y / sides.y * sides.y;
    const std::size_t right = std::min<std::size_t>(left + sides.x, rows.size.x) - 1;
    const std::size_t bottom = std::min<std::size_t>(top + sides.y, rows.size.y) - 1;
    const auto share = [](std::size_t at, std::size_t first, std::size_t last) {
        return last > first ? static_cast<double>(at - first) / static_cast<double>(last - first) : 0;
    };
    const double u = share(x, left, right), v = share(y, top, bottom);
    double value = 0;
    float least = std::numeric_limits<float>::infinity();
    for (const auto& [column, row, weight] :
        {std::tuple{left, top, (1 - u) * (1 - v)}, std::tuple{right, top, u * (1 - v)},
            std::tuple{left, bottom, (1 - u) * v}, std::tuple{right, bottom, u * v}}) {
        const std::size_t corner = row * rows.size.x + column;
        const auto& e = all.irradiance[corner];
        const double away = glm::distance(dvec3(rows.points[corner]), dvec3(rows.points[i]));
        if (away > spacing * std::sqrt(static_cast<double>(e.w)) * (1 + 1e-5))
            return false;
        value += weight * static_cast<double>(e.x);
        least = std::min(least, e.w);
    }
    return all.irradiance[i].w == least && std::abs(value - static_cast<double>(all.irradiance[i].x)) <= 1e-5 * value;
}

/// On a floor that is seen from above, or at a flat angle across or along its rows.
TYPED_TEST_P(pictures, estimates_are_searched_for_or_interpolated_between_near_ones)
{
    auto& b = this->b();
    const even_light set(4000, 0.001f, 3);
    const auto map = fitted_map(b, set.on(b), 50, every_part);
    const knn_settings search{.k = 50};
    const double spacing = 0.5; // the radius is about 0.063
    for (const auto step :
        {glm::vec2(0.003f), glm::vec2(0.002f, 0.02f), glm::vec2(0.02f, 0.002f), glm::vec2(0.007f), glm::vec2(0.05f)}) {
        const rows_of_points rows({19, 13}, step, {0.03f, 0.03f});
        const auto plain = estimates_at(b, map, rows, search, 0);
        const auto found = estimates_at(b, map, rows, search, spacing);
        EXPECT_EQ(plain.interpolated(), 0u);
        if (step == glm::vec2(0.05f)) // no two points are near
            EXPECT_EQ(found.interpolated(), 0u);
        else
            EXPECT_GT(found.interpolated(), rows.points.size() / 3) << step.x << ", " << step.y;
        for (std::size_t i = 0; i < rows.points.size(); ++i) {
            if (!found.is_interpolated(i)) {
                ASSERT_NEAR(found.irradiance[i].x, plain.irradiance[i].x, 1e-5f * plain.irradiance[i].x) << i;
                ASSERT_EQ(found.irradiance[i].w, plain.irradiance[i].w) << i;
                ASSERT_EQ(found.used[i].x, plain.used[i].x) << i;
                continue;
            }
            bool explained = false;
            for (const auto sides : {glm::uvec2(8, 8), glm::uvec2(4, 4), glm::uvec2(8, 1), glm::uvec2(1, 8)})
                explained = explained || is_bilinear(found, rows, i, sides, spacing);
            EXPECT_TRUE(explained) << "pixel " << i << " at steps of " << step.x << ", " << step.y;
            // The radius there changes by at most the way to the corners.
            ASSERT_GE(plain.irradiance[i].w, found.irradiance[i].w * 0.25f * 0.99f) << i;
            ASSERT_EQ(found.used[i].x, 50u) << i;
        }
    }
}

/// Photons crowd within a pixel in the middle of a tile: the estimate there is that of a search.
TYPED_TEST_P(pictures, photons_that_crowd_between_estimates_are_not_missed)
{
    auto& b = this->b();
    even_light set(2000, 0.001f, 4);
    const rows_of_points rows({16, 16}, glm::vec2(0.004f), {0.4f, 0.4f});
    const std::size_t crowded = 3 * 16 + 3;
    for (std::size_t i = 0; i < 100; ++i)
        set.positions[i]
            = rows.points[crowded] + 1e-5f * glm::vec4(static_cast<float>(i % 10), 0, static_cast<float>(i / 10), 0);
    const auto map = fitted_map(b, set.on(b), 20, every_part);
    const knn_settings search{.k = 20};
    const auto plain = estimates_at(b, map, rows, search, 0);
    const auto found = estimates_at(b, map, rows, search, 0.5);
    EXPECT_GT(found.interpolated(), 0u);
    EXPECT_GT(plain.irradiance[crowded].x, 1000 * plain.irradiance[0].x);
    EXPECT_FALSE(found.is_interpolated(crowded));
    EXPECT_NEAR(found.irradiance[crowded].x, plain.irradiance[crowded].x, 1e-5f * plain.irradiance[crowded].x);
}

/// Not over a step, around an edge, over what has no estimate, nor with the paper's search.
TYPED_TEST_P(pictures, estimates_are_not_interpolated_over_edges)
{
    auto& b = this->b();
    const even_light set(4000, 0.001f, 5);
    const auto map = fitted_map(b, set.on(b), 50, every_part);
    const knn_settings search{.k = 50};
    const rows_of_points flat({16, 8}, glm::vec2(0.003f), {0.4f, 0.4f});
    const auto in_left_tile = [&](const rows_of_points& rows, const knn_settings& s) {
        const auto found = estimates_at(b, map, rows, s, 0.5);
        std::size_t n = 0;
        for (std::size_t i = 0; i < rows.points.size(); ++i)
            n += i % 16 < 8 && found.is_interpolated(i) ? 1 : 0;
        return n;
    };
    EXPECT_EQ(in_left_tile(flat, search), 60u); // all but the corners
    auto paper = as_paper(search);
    EXPECT_EQ(in_left_tile(flat, paper), 0u);
    const glm::vec4 tilted(std::sin(0.2f), std::cos(0.2f), 0, 0);
    for (const int fault : {0, 1, 2, 3}) {
        auto rows = flat;
        for (std::size_t i = 0; i < rows.points.size(); ++i) {
            if (i % 16 != 2 && i % 16 != 5) // of the columns of small tiles, those between the corners of the large one
                continue;
            switch (fault) {
            case 0: rows.points[i].y = 0.004f; break;
            case 1: rows.normals[i] = tilted; break;
            case 2: rows.points[i].w = -1; break;
            default: break;
            }
        }
        if (fault == 3) // the corners of all tiles
            for (std::size_t i = 0; i < rows.points.size(); ++i)
                if (i % 4 == 0 || i % 4 == 3)
                    rows.normals[i] = tilted;
        const auto found = estimates_at(b, map, rows, search, 0.5);
        for (std::size_t i = 0; i < rows.points.size(); ++i) {
            if (i % 16 != 2 && i % 16 != 5)
                continue;
            if (fault == 2)
                EXPECT_EQ(found.irradiance[i], glm::vec4(0)) << i;
            else
                EXPECT_FALSE(found.is_interpolated(i)) << "fault " << fault << ", pixel " << i;
        }
    }
}

/// Fewer photons are visited, and the picture differs far less than by its noise; with all that estimates may have, by
/// bands, and on serial it is the same.
TYPED_TEST_P(pictures, interpolated_pictures_are_close_and_equal_serials)
{
    auto& b = this->b();
    serial_backend serial;
    auto s = small_cornell();
    s.camera.vertical_fov = 15; // the back wall, and a part of a ball
    auto settings = shrinking(with_caustic_map(s.render, 2000), 2);
    settings.map.photons = 4000;
    settings.estimate.k = 200;
    settings.estimate.max_radius = 1;
    settings.output.width = 48;
    settings.output.height = 40;
    settings.output.aov = true;
    settings.output.report_bias = bias_report::yes;
    render_stats few, all;
    const auto picture = this->picture(s, settings, &few);
    auto without = settings;
    without.estimate.interpolation = 0;
    const auto plain = this->picture(s, without, &all);
    EXPECT_LT(few.estimate.mean_visited, 0.8 * all.estimate.mean_visited);
    EXPECT_GT(relative_mse(picture, plain), 0);
    auto other = without;
    other.seed = 7;
    EXPECT_LT(relative_mse(picture, plain), 0.02 * relative_mse(plain, this->picture(s, other)));
    double error = 0, error_of_plain = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        error += static_cast<double>(picture.layers.relative_error[i]);
        error_of_plain += static_cast<double>(plain.layers.relative_error[i]);
    }
    EXPECT_NEAR(error / error_of_plain, 1, 0.02);
    auto in_bands = settings;
    in_bands.output.band = 48 * 8;
    EXPECT_LE(relative_mse(this->picture(s, in_bands), picture), 1e-9);
    if (b.caps().exact_division && b.caps().exact_sqrt) {
        const auto expected = render(serial, s, settings).picture;
        EXPECT_LE(relative_mse(picture, expected), 1e-9);
        EXPECT_EQ(picture.layers.count, expected.layers.count);
    }
}

} // namespace photongrid::testing

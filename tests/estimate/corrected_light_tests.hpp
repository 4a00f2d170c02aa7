// Estimates corrected at edges, on any backend.
#pragma once

#include "edges.hpp"

#include <array>

namespace photongrid::testing {

TYPED_TEST_P(edges, uniform_squares_read_one_up_to_their_corners)
{
    auto& b = this->b();
    const squares all;
    const auto scene = upload_scene(b, all.s);
    const uint n = all.rows * all.rows, photons_each = 200;
    random_source u(5);
    photon_set set;
    set.g = make_grid(scene.layout.low, scene.layout.high, {96, 1, 96});
    for (uint i = 0; i < n * photons_each; ++i) { // so many on the average: a Poisson process
        const dvec3 p = all.corner(u.below(n)) + dvec3(u(), 0, u()) - scene.layout.center;
        set.positions.emplace_back(glm::vec3(p), 0.0f);
        set.powers.emplace_back(1.0f / photons_each);
    }
    const auto map = sorted_map(b, upload_photons(b, set), set.g);
    std::vector<glm::vec4> points, normals;
    for (uint i = 0; i < n; ++i)
        for (const auto& at : {dvec3(0.5, 0, 0.5), dvec3(0.5, 0, 0), dvec3(0.5, 0, 1), dvec3(0, 0, 0.5),
                 dvec3(1, 0, 0.5), dvec3(0, 0, 0), dvec3(1, 0, 0), dvec3(0, 0, 1), dvec3(1, 0, 1)}) {
            points.emplace_back(glm::vec3(all.corner(i) + at - scene.layout.center), 1.0f);
            normals.emplace_back(0.0f, 1.0f, 0.0f, 0.0f);
        }
    const auto p = b.upload(std::span<const glm::vec4>(points)), np = b.upload(std::span<const glm::vec4>(normals));
    for (const auto search : {search_kind::exact_k, search_kind::fixed_radius})
        for (const auto& f : filters) {
            knn_settings k{.k = 16, .max_radius = search == search_kind::exact_k ? 0.5f : 0.3f, .min_radius = 1e-6f};
            k.search = search;
            k.filter = f.kind;
            k.errors = true;
            auto e = knn_grid_estimate(b, map, p, np, k);
            const auto plain = b.download(e.irradiance), plain_errors = b.download(e.standard_error);
            correct_edges(b, scene, p, np, e, {f.kind, k.min_radius});
            const auto whole = b.download(e.irradiance), errors = b.download(e.standard_error);
            const char* places[] = {"middle", "edge", "corner"};
            for (int place = 0; place < 3; ++place) {
                double sum = 0, squared = 0, error = 0, without = 0, m = 0;
                for (std::size_t i = 0; i < points.size(); ++i)
                    if ((i % 9 == 0 ? 0 : i % 9 < 5 ? 1 : 2) == place) {
                        const double v = static_cast<double>(whole[i].x);
                        sum += v, squared += v * v, m += 1;
                        error += static_cast<double>(errors[i].x);
                        without += static_cast<double>(plain[i].x);
                        EXPECT_EQ(whole[i].w, plain[i].w) << "the radius stays";
                        if (plain[i].x > 0) {
                            EXPECT_NEAR(errors[i].w / whole[i].x, plain_errors[i].w / plain[i].x, 1e-5f)
                                << "the relative error stays";
                        }
                    }
                const double mean = sum / m, spread = std::sqrt(squared / m - mean * mean),
                             known = place == 0 ? 1
                    : place == 1                ? 0.5
                                                : 0.25;
                const auto where
                    = std::string(places[place]) + ", filter " + f.name + ", search " + std::to_string(int(search));
                EXPECT_NEAR(mean, 1, 4 * spread / std::sqrt(m)) << where;
                EXPECT_NEAR(without / m, known, 4 * known * spread / std::sqrt(m)) << where;
                EXPECT_NEAR(error / m, spread, 0.15 * spread) << where << ": standard error reported";
                EXPECT_LE(4 * spread / std::sqrt(m), place == 0 ? 0.12 : 0.06) << "the test sees enough";
            }
        }
}

/// Where a disc lies partly off its surface, both estimates whose difference tells the bias are corrected, each by its
/// own share: even light has none. Uncorrected, the difference and the moments see the edge.
TYPED_TEST_P(edges, even_light_has_no_bias_beside_an_edge)
{
    auto& b = this->b();
    const squares all;
    const auto scene = upload_scene(b, all.s);
    const uint n = all.rows * all.rows, photons_each = 400;
    random_source u(6);
    photon_set set;
    set.g = make_grid(scene.layout.low, scene.layout.high, {96, 1, 96});
    for (uint i = 0; i < n * photons_each; ++i) {
        const dvec3 p = all.corner(u.below(n)) + dvec3(u(), 0, u()) - scene.layout.center;
        set.positions.emplace_back(glm::vec3(p), 0.0f);
        set.powers.emplace_back(1.0f / photons_each);
    }
    const auto map = sorted_map(b, upload_photons(b, set), set.g);
    std::vector<glm::vec4> points, normals;
    for (uint i = 0; i < n; ++i)
        for (const double at : {0.1, 0.5, 0.9}) {
            points.emplace_back(glm::vec3(all.corner(i) + dvec3(at, 0, 0.5) - scene.layout.center), 1.0f);
            normals.emplace_back(0.0f, 1.0f, 0.0f, 0.0f);
        }
    const auto p = b.upload(std::span<const glm::vec4>(points)), np = b.upload(std::span<const glm::vec4>(normals));
    const knn_settings k{
        .max_radius = 0.3f, .search = search_kind::fixed_radius, .filter = filter_kind::silverman, .biases = true};
    auto e = knn_grid_estimate(b, map, p, np, k);
    const auto uncorrected = b.download(e.biases.bias), tilted = b.download(e.biases.tilt);
    correct_edges(b, scene, p, np, e, k.filter);
    const auto corrected = b.download(e.biases.bias), tilt = b.download(e.biases.tilt),
               jump = b.download(e.biases.jump);
    double sum = 0, squares = 0, before = 0, m = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (i % 3 == 1) { // in the middle
            EXPECT_EQ(corrected[i], uncorrected[i]);
            EXPECT_EQ(tilt[i], tilted[i]);
            continue;
        }
        const double bias = static_cast<double>(corrected[i].x);
        sum += bias, squares += bias * bias, m += 1;
        before += static_cast<double>(uncorrected[i].x);
        EXPECT_EQ(tilt[i], glm::vec4(0)) << i;
        EXPECT_EQ(jump[i], glm::vec4(0)) << i;
    }
    const double spread = std::sqrt(squares / m - sum * sum / (m * m));
    EXPECT_NEAR(sum / m, 0, 4 * spread / std::sqrt(m));
    EXPECT_GT(std::abs(before / m), 8 * spread / std::sqrt(m)) << "the test sees enough";
}

// A bulb below a mirror: caustic light falls onto the floor as from a bulb as far above the mirror.
inline constexpr double bulb_height = 1.5, bulb_power = 100; ///< m above the floor, in the mirror; W
inline scene floor_lit_by_a_mirror()
{
    scene s;
    s.materials = {{"white", material_kind::lambertian, dvec3(0.5)}, {"mirror", material_kind::mirror, dvec3(1)}};
    s.polygons
        = {{{{-0.5, 0, -0.5}, {-0.5, 0, 0.5}, {0.5, 0, 0.5}}, 0}, {{{-0.5, 0, -0.5}, {0.5, 0, 0.5}, {0.5, 0, -0.5}}, 0},
            {{{-3, 1.25, -3}, {3, 1.25, -3}, {3, 1.25, 3}, {-3, 1.25, 3}}, 1}};
    s.point_lights = {{"bulb", {0, 1, 0}, dvec3(bulb_power)}};
    s.camera = {{0, 1.2, 0}, {0, 0, 0}, {0, 0, -1}, glm::degrees(2 * std::atan(0.5 / 1.2)) - 0.01};
    s.render = {.map = {.photons = 15000, .grid = {40, 1, 40}},
        .estimate = {.k = 100, .max_radius = 0.2},
        .output = {.width = 48, .height = 48}};
    s.render.output.only = light_part::caustic;
    s.render.estimate.leaks = {.side = true, .min_cosine = 0.5f};
    s.render.output.aov = true;
    return s;
}

/// The radiance of its pixel.
inline double known_radiance(uint x, uint y)
{
    const double fx = (x + 0.5) / 48 - 0.5, fz = (y + 0.5) / 48 - 0.5,
                 d2 = bulb_height * bulb_height + fx * fx + fz * fz;
    return 0.5 / M_PI * bulb_power / (4 * M_PI) * bulb_height / (d2 * std::sqrt(d2));
}

/// Means of radiance over the known: inside, along the rim without its corners, in the corners.
inline std::array<double, 3> light_over_known(const image& picture)
{
    std::array<double, 3> sums{}, counts{};
    for (uint y = 0; y < 48; ++y)
        for (uint x = 0; x < 48; ++x) {
            const uint across = std::min(x, 47 - x), down = std::min(y, 47 - y);
            const int zone = across < 1 && down < 1                    ? 2
                : (across < 1 && down > 5) || (down < 1 && across > 5) ? 1
                : across > 6 && down > 6                               ? 0
                                                                       : -1;
            if (zone >= 0) {
                const auto place = static_cast<std::size_t>(zone);
                sums[place] += static_cast<double>(picture.pixels[y * 48 + x].x) / known_radiance(x, y);
                counts[place] += 1;
            }
        }
    for (std::size_t place = 0; place < 3; ++place)
        sums[place] /= counts[place];
    return sums;
}

TYPED_TEST_P(edges, a_floor_lit_by_a_mirror_is_right_up_to_its_rim)
{
    const scene s = floor_lit_by_a_mirror();
    image pictures[2];
    render_stats stats[2];
    const auto built = build_map(this->b(), s, s.render);
    for (const bool corrected : {false, true}) {
        auto settings = s.render;
        settings.estimate.edges = corrected ? edge_correction::polygons : edge_correction::none;
        auto drawn = draw(this->b(), built, s.camera, settings);
        pictures[corrected] = std::move(drawn.picture);
        stats[corrected] = drawn.stats;
        const auto sums = light_over_known(pictures[corrected]);
        std::printf("edges: light over the known, %s: inside %.3f, rim %.3f, corners %.3f\n",
            corrected ? "corrected" : "as it is", sums[0], sums[1], sums[2]);
        // Discs have some 0.045 m radius, pixels of the rim lie 0.01 m inside.
        EXPECT_NEAR(sums[0], 1, 0.05);
        if (corrected) {
            EXPECT_NEAR(
                sums[1], 1, 0.09); // four standard errors: a disc sees to 14 %, and some fifty lie along the rim
            EXPECT_NEAR(sums[2], 1, 0.28);
        } else {
            EXPECT_LT(sums[1], 0.8);
            EXPECT_LT(sums[2], 0.65);
        }
    }
    // What estimates say of themselves stays.
    EXPECT_EQ(stats[0].estimate.mean_count, stats[1].estimate.mean_count);
    EXPECT_EQ(stats[0].estimate.mean_radius, stats[1].estimate.mean_radius);
    EXPECT_EQ(count_different_bits(pictures[0].layers.radius, pictures[1].layers.radius), 0u);
    for (std::size_t i = 0; i < pictures[0].pixels.size(); ++i)
        ASSERT_NEAR(pictures[0].layers.relative_error[i], pictures[1].layers.relative_error[i], 1e-5f);
}

/// A black plate lies on the floor: photons are missing behind it, but the floor beside it is as bright as without it.
TYPED_TEST_P(edges, a_floor_is_right_up_to_a_plate_on_it)
{
    scene s = floor_lit_by_a_mirror();
    s.materials.push_back({"black", material_kind::mirror, dvec3(0)});
    constexpr double half = 0.125, height = 1e-4; // m; the plate's rim is the rim of pixels
    s.polygons.push_back(
        {{{-half, height, -half}, {-half, height, half}, {half, height, half}, {half, height, -half}}, 2});
    const auto built = build_map(this->b(), s, s.render);
    for (const bool corrected : {false, true}) {
        auto settings = s.render;
        settings.estimate.edges = corrected ? edge_correction::polygons : edge_correction::none;
        const auto picture = draw(this->b(), built, s.camera, settings).picture;
        double sum = 0, n = 0;
        for (uint y = 0; y < 48; ++y)
            for (uint x = 0; x < 48; ++x) {
                const auto value = static_cast<double>(picture.pixels[y * 48 + x].x);
                const bool in_columns = x >= 18 && x < 30, in_rows = y >= 18 && y < 30;
                if (in_columns && in_rows) {
                    EXPECT_EQ(value, 0);
                } else if ((in_columns && (y == 17 || y == 30)) || (in_rows && (x == 17 || x == 30))) {
                    sum += value / known_radiance(x, y), n += 1;
                }
            }
        std::printf(
            "edges: light over the known beside a plate, %s: %.3f\n", corrected ? "corrected" : "as it is", sum / n);
        EXPECT_EQ(n, 48);
        if (corrected) {
            EXPECT_NEAR(sum / n, 1, 0.09); // as along the rim of the floor, above
        } else {
            EXPECT_LT(sum / n, 0.8);
        }
    }
}

TYPED_TEST_P(edges, pictures_equal_the_serial_backends)
{
    auto& b = this->b();
    for (auto s : {small_cornell(), all_shapes()})
        for (const auto search : {search_kind::at_least_k, search_kind::exact_k}) {
            s.render.output.width = s.render.output.height = 32;
            s.render.map.photons = 2000;
            s.render.estimate.edges = edge_correction::polygons;
            s.render.estimate.leaks.min_cosine = 0.5f;
            s.render.estimate.search = search;
            serial_backend serial;
            const auto [mine, stats] = render(b, s);
            EXPECT_EQ(stats.invalid_pixels, 0u);
            if (b.caps().exact_division && b.caps().exact_sqrt) {
                EXPECT_LE(relative_mse(mine, render(serial, s).picture), 1e-9);
            }
            s.render.estimate.edges = edge_correction::none;
            EXPECT_GT(relative_mse(mine, render(b, s).picture), 1e-4);
        }
}

TYPED_TEST_P(edges, correction_needs_the_normals_policy)
{
    const auto s = small_cornell();
    for (const leak_policy& leaks :
        {leak_policy{}, leak_policy{.side = true}, leak_policy{.side = true, .flattening = 4},
            leak_policy{.min_cosine = 0}, leak_policy{.min_cosine = -0.5f}}) {
        auto settings = s.render;
        settings.estimate.leaks = leaks;
        EXPECT_NO_THROW(check(settings));
        settings.estimate.edges = edge_correction::polygons;
        try {
            (void)render(this->b(), s, settings);
            FAIL() << "corrected with the light of adjoining walls";
        } catch (const std::invalid_argument& e) {
            EXPECT_EQ(std::string(e.what()).find("edge_correction: "), 0u) << e.what();
            EXPECT_NE(std::string(e.what()).find("needs the leak policy min_cosine"), std::string::npos) << e.what();
        }
        settings.estimate.leaks.min_cosine = 0.25f;
        EXPECT_NO_THROW(check(settings));
        EXPECT_EQ(as_paper(settings).estimate.edges, edge_correction::none);
        EXPECT_NO_THROW(check(as_paper(settings)));
    }
}

} // namespace photongrid::testing

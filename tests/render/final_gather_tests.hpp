// The final gather: the irradiance at photons, known light, parts of the light, and bytes that do not depend on how the
// work is divided.
#pragma once

#include "known_energy_tests.hpp"

#include <photongrid/render/final_gather.hpp>

namespace photongrid::testing {

inline render_settings gathering(render_settings s, std::uint32_t rays)
{
    s.estimate.indirect = indirect_kind::gather;
    s.estimate.gather_rays = rays;
    return s;
}

inline dvec3 mean_of(const image& im)
{
    dvec3 mean(0);
    for (const auto& p : im.pixels)
        mean += dvec3(p) / static_cast<double>(im.pixels.size());
    return mean;
}

/// All or the indirect light of integrating_sphere(): at each point direct light is 1 / (1 - reflectance) times less
/// than all light.
inline void expect_radiance_in_a_sphere(const image& drawn, const dvec3& reflectance, light_part part)
{
    const auto mean = mean_of(drawn);
    for (int c = 0; c < 3; ++c) {
        const double direct = reflectance[c], all = reflectance[c] / (1 - reflectance[c]);
        const double known = part == light_part::all ? all : all - direct;
        EXPECT_NEAR(mean[c], known, 0.02 * known) << "channel " << c;
    }
}

/// Photons of equal power at random places of the unit square in the plane y = 0, which come from above: even light.
struct even_light {
    std::vector<glm::vec4> positions, powers, directions, normals;

    even_light(std::size_t photons, float power, std::uint64_t seed)
        : powers(photons, glm::vec4(power, 2 * power, 4 * power, 0)), directions(photons, glm::vec4(0, -1, 0, 0)),
          normals(photons, glm::vec4(0, 1, 0, 0))
    {
        random_source random(seed);
        for (std::size_t i = 0; i < photons; ++i) {
            const float x = random(), z = random();
            positions.emplace_back(x, 0, z, 0);
        }
    }
    template <backend B>
    photons<B> on(B& b) const
    {
        const auto up = [&](const std::vector<glm::vec4>& v) { return b.upload(std::span<const glm::vec4>(v)); };
        return {up(positions), up(powers), up(directions), up(normals)};
    }
};

template <backend B>
gather_map<B> gather_map_of(B& b, const device_scene<B>& s, photons<B> p, const render_settings& settings)
{
    gather_map_building<B> building(b, s, std::move(p), settings);
    while (!building.advance()) {}
    return building.take();
}

/// At random points, not at photons: there the photon itself would make estimates too high.
TYPED_TEST_P(pictures, the_irradiance_at_the_nearest_photon_has_the_right_mean)
{
    auto& b = this->b();
    const auto s = small_cornell();
    const auto device = upload_scene(b, s);
    const std::size_t n = 20000, points = 20000;
    const even_light set(n, 1.0f / static_cast<float>(n), 5);
    random_source random(8);
    std::vector<glm::vec4> places, up(points, glm::vec4(0, 1, 0, 0));
    for (std::size_t i = 0; i < points; ++i) {
        const float x = 0.1f + 0.8f * random(), z = 0.1f + 0.8f * random(); // no disc reaches the edge
        places.emplace_back(x, 0, z, 1);
    }
    for (const uint k : {8u, 50u}) {
        auto settings = gathering(s.render, 1);
        settings.estimate.k = k;
        settings.estimate.max_radius = 1;
        settings.estimate.edges = edge_correction::none;
        const auto map = gather_map_of(b, device, set.on(b), settings);
        const auto nearest = b.download(knn_neighbours(b, map.nearest, b.upload(std::span<const glm::vec4>(places)),
            b.upload(std::span<const glm::vec4>(up)), {.k = 1, .leaks = {.min_cosine = 0.7f}})
                                            .ids);
        const auto found = b.download(map.irradiance);
        double mean = 0;
        for (const uint id : nearest)
            mean += static_cast<double>(found[id].x) / static_cast<double>(points);
        // Of 20,000 estimates some k share photons: about 20,000 / k are independent, of variance 1 / k each. Without
        // the photon itself the mean would be 1 / k too low.
        EXPECT_NEAR(mean, 1, 3 / std::sqrt(static_cast<double>(points))) << "k " << k;
    }
}

TYPED_TEST_P(pictures, irradiance_at_photons_equals_brute_force)
{
    auto& b = this->b();
    const auto s = small_cornell();
    const auto device = upload_scene(b, s);
    const even_light set(600, 0.002f, 9);
    auto settings = gathering(s.render, 1);
    settings.estimate.k = 20;
    settings.estimate.max_radius = 10;
    settings.estimate.bias = bias_kind::unbiased;
    settings.estimate.edges = edge_correction::none;
    const auto found = b.download(gather_map_of(b, device, set.on(b), settings).irradiance);
    for (std::size_t i = 0; i < set.positions.size(); ++i) {
        std::vector<double> distances2;
        for (std::size_t j = 0; j < set.positions.size(); ++j)
            distances2.push_back(std::pow(glm::distance(dvec3(set.positions[i]), dvec3(set.positions[j])), 2));
        std::nth_element(distances2.begin(), distances2.begin() + 19, distances2.end());
        const double r2 = distances2[19]; // that photon is left out of the sum
        ASSERT_NEAR(found[i].x, 19 * 0.002 / (M_PI * r2), 1e-4 * 19 * 0.002 / (M_PI * r2)) << i;
        ASSERT_NEAR(found[i].w, r2, 1e-4 * r2) << i;
    }
}

TYPED_TEST_P(pictures, a_final_gather_in_a_closed_sphere_has_the_known_radiance)
{
    const dvec3 reflectance(0.5, 0.25, 0.75);
    auto s = integrating_sphere(reflectance);
    auto settings = gathering(s.render, 8);
    settings.map.photons = 10000;
    settings.estimate.k = 50;
    settings.output.width = 16;
    settings.output.height = 12;
    for (const auto part : {light_part::all, light_part::indirect}) {
        settings.output.only = part;
        render_stats stats;
        expect_radiance_in_a_sphere(this->picture(s, settings, &stats), reflectance, part);
        expect_an_exact_account(stats.photons, settings.map.photons);
        EXPECT_EQ(stats.photons.direct, 0u); // first hits are stored
        EXPECT_EQ(stats.photons.escaped, 0u);
    }
}

/// Plastic reflects, and lets light pass, by the cosine; what a gather brings below the coat is weighted so.
TYPED_TEST_P(pictures, a_final_gather_below_a_coat_has_the_known_radiance)
{
    // A ball of plastic in a diffuse sphere, so small that it does not change the even light there.
    const double rho = 0.5;
    auto s = integrating_sphere(dvec3(rho));
    const dvec3 base(0.6, 0.3, 0.9);
    s.materials.push_back({"plastic", material_kind::plastic, base, 1.5});
    s.spheres.push_back({dvec3(0, 0.5, 0), 0.01, 1});
    s.camera = {{0.05, 0.5, 0}, {0, 0.5, 0}, {0, 1, 0}, 12};
    auto settings = gathering(s.render, 16);
    settings.map.photons = 10000;
    settings.estimate.k = 50;
    settings.output.width = 16;
    settings.output.height = 12;
    settings.view.depth = 0; // what the coat reflects is left out
    settings.output.only = light_part::indirect;
    const auto drawn = this->picture(s, settings);
    const dvec3 left = known_coat{1.5, 0}.left(base);
    const double radiance = rho / (1 - rho); // of the sphere: the bulb's power is 4 pi^2
    const auto seen
        = static_cast<std::size_t>(settings.output.height / 2) * settings.output.width + settings.output.width / 2;
    dvec3 mean(0);
    for (std::size_t i = seen - 2; i < seen + 3; ++i)
        mean += dvec3(drawn.pixels[i]) / 5.0;
    const double straight = 1 - unpolarised_reflectance(1, 1.5);
    for (int c = 0; c < 3; ++c) {
        const double known = straight * left[c] * radiance;
        EXPECT_NEAR(mean[c], known, 0.05 * known) << "channel " << c;
    }
}

/// A floor before a wall that the sun lights from the front, and which alone lights the floor; seen from above.
inline scene sunlit_corner(double wall, double floor, double height, double sun)
{
    scene s;
    s.name = "corner";
    s.materials
        = {{"wall", material_kind::lambertian, dvec3(wall)}, {"floor", material_kind::lambertian, dvec3(floor)}};
    s.polygons = {{{{0, 0, -3}, {0, height, -3}, {0, height, 3}, {0, 0, 3}}, 0},
        {{{0, 0, -3}, {0, 0, 3}, {2, 0, 3}, {2, 0, -3}}, 1}};
    s.directional_lights = {{"sun", {-1, 0, 0}, dvec3(sun)}};
    s.camera = {{0.1, 1, 0}, {0.1, 0, 0}, {0, 0, 1}, 9};
    s.render = {.map = {.photons = 2000, .grid = {4, 4, 12}},
        .estimate = {.k = 50, .max_radius = 1},
        .view = {.spp = 1, .light_samples = 1},
        .output = {.width = 8, .height = 8}};
    return s;
}

/// The rays of 16 passes are spread over the hemisphere as those of one would be: they find the wall with far less
/// noise than rays that know nothing of each other.
TYPED_TEST_P(pictures, gather_rays_are_stratified_over_passes)
{
    auto& b = this->b();
    const auto s = sunlit_corner(0.8, 0.02, 1, 3);
    auto settings = gathering(s.render, 1);
    settings.output.only = light_part::indirect;
    const auto map = build_map(b, s, settings);
    const auto drawn = [&](std::uint32_t rays, std::uint32_t pass) { // each eye ray through the middle of its pixel
        auto with = settings;
        with.estimate.gather_rays = rays;
        with.pass.number = pass;
        return draw(b, map, s.camera, with).picture;
    };
    const auto known = drawn(1024, 0);
    constexpr std::uint32_t passes = 16;
    std::vector<double> mean(known.pixels.size());
    double alone = 0, together = 0;
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        const auto one = drawn(1, pass);
        for (std::size_t i = 0; i < mean.size(); ++i) {
            const double e = static_cast<double>(one.pixels[i].x - known.pixels[i].x);
            mean[i] += e / passes;
            alone += e * e / passes;
        }
    }
    for (const double e : mean)
        together += e * e;
    EXPECT_GT(alone, 0);
    EXPECT_LT(together, 0.5 * alone / passes);
}

/// The floor before a wall that the sun lights from the front, and which alone lights the floor. At a distance x from a
/// wall of height h, its form factor is (1 - x / sqrt(x^2 + h^2)) / 2. The floor seen is nearer to the wall than the
/// radius of estimates there, which are half too dark at its lower edge.
TYPED_TEST_P(pictures, a_final_gather_has_the_known_radiance_in_a_corner)
{
    const double wall = 0.8, floor = 0.02, height = 1, sun = 3;
    const auto s = sunlit_corner(wall, floor, height, sun);
    auto settings = gathering(s.render, 256);
    settings.output.only = light_part::indirect;
    const auto drawn = this->picture(s, settings);
    double seen = 0, known = 0;
    for (std::uint32_t y = 0; y < 8; ++y)
        for (std::uint32_t x = 0; x < 8; ++x) {
            const dvec3 d = through_pixel(s.camera, settings.output, x, y);
            const double from_wall = (s.camera.position - d * (s.camera.position.y / d.y)).x;
            ASSERT_GT(from_wall, 0.01);
            ASSERT_LT(from_wall, 0.2);
            const double form_factor = (1 - from_wall / std::hypot(from_wall, height)) / 2;
            known += floor / M_PI * form_factor * wall * sun;
            seen += static_cast<double>(drawn.pixels[y * 8 + x].x);
        }
    EXPECT_NEAR(seen / known, 1, 0.03);
}

TYPED_TEST_P(pictures, the_parts_of_a_gathered_picture_add_up)
{
    const auto s = small_cornell();
    auto settings = gathering(s.render, 4);
    settings.output.width = settings.output.height = 24;
    const auto all = this->picture(s, settings);
    std::vector<dvec3> sum(all.pixels.size(), dvec3(0));
    for (const auto part : {light_part::direct, light_part::caustic, light_part::indirect}) {
        settings.output.only = part;
        const auto drawn = this->picture(s, settings);
        // Caustics alone need no first hits: those photons are others.
        if (part != light_part::caustic)
            for (std::size_t i = 0; i < sum.size(); ++i)
                sum[i] += dvec3(drawn.pixels[i]);
    }
    // What is left are the caustics of the whole picture: nowhere below 0, and somewhere above.
    double least = 0, most = 0, brightest = 0;
    for (std::size_t i = 0; i < sum.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const auto value = static_cast<double>(all.pixels[i][c]);
            least = std::min(least, value - sum[i][c]);
            most = std::max(most, value - sum[i][c]);
            brightest = std::max(brightest, value);
        }
    EXPECT_GT(least, -1e-5 * brightest);
    EXPECT_GT(most, 1e-2 * brightest);
}

TYPED_TEST_P(pictures, a_final_gather_equals_serials)
{
    auto& b = this->b();
    if (!b.caps().exact_division || !b.caps().exact_sqrt)
        GTEST_SKIP() << "this device rounds division or square root loosely";
    serial_backend serial;
    for (auto s : {small_cornell(), all_shapes()}) {
        auto settings = gathering(s.render, 4);
        settings.map.photons /= 4;
        settings.output.width = 24;
        settings.output.height = 18;
        const auto mine = render(b, s, settings), theirs = render(serial, s, settings);
        EXPECT_LE(relative_mse(mine.picture, theirs.picture), 1e-9) << s.name;
        EXPECT_EQ(mine.stats.photons.emitted, theirs.stats.photons.emitted);
        EXPECT_EQ(mine.stats.photons.stored, theirs.stats.photons.stored);
    }
}

TYPED_TEST_P(pictures, a_gathered_picture_does_not_depend_on_bands)
{
    const auto s = small_cornell();
    auto settings = gathering(s.render, 3);
    settings.output.width = 20;
    settings.output.height = 16;
    const auto whole = this->picture(s, settings);
    settings.output.band = 20 * 5;
    EXPECT_LE(relative_mse(this->picture(s, settings), whole), 1e-9);
}

TYPED_TEST_P(pictures, the_rays_of_a_gather_are_progress)
{
    const auto s = small_cornell();
    auto settings = gathering(s.render, 5);
    settings.output.width = settings.output.height = 8;
    std::vector<double> fractions;
    render_observer watch;
    watch.cancelled = [] { return false; }; // small steps
    watch.progress = [&](std::string_view stage, double fraction) {
        if (stage == "radiance_estimate")
            fractions.push_back(fraction);
    };
    (void)render(this->b(), s, settings, watch);
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
    EXPECT_GE(std::count_if(fractions.begin(), fractions.end(), [](double f) { return f > 0 && f < 0.2; }), 4);
    EXPECT_EQ(fractions.back(), 1);
}

TYPED_TEST_P(pictures, a_view_of_a_map_without_a_gather_is_refused)
{
    auto& b = this->b();
    const auto s = small_cornell();
    const auto gathered = gathering(s.render, 2);
    const auto plain = build_map(b, s, s.render), with = build_map(b, s, gathered);
    EXPECT_FALSE(same_map(s.render, gathered));
    EXPECT_THROW((void)draw(b, plain, s.camera, gathered), std::invalid_argument);
    EXPECT_THROW((void)draw(b, with, s.camera, s.render), std::invalid_argument);
    auto more = gathered;
    more.estimate.gather_rays = 5;
    EXPECT_TRUE(same_map(gathered, more));
    EXPECT_NO_THROW((void)draw(b, with, s.camera, more));
    more.estimate.k += 1;
    EXPECT_FALSE(same_map(gathered, more));
}

} // namespace photongrid::testing

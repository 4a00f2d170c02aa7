// Guarantees of the renderer, on any backend: scenes with known answers, the balance of photons, and the serial
// backend's picture. Included by each on_<backend>.cpp.
#pragma once

#include "../backend/under_test.hpp"
#include "../backends/serial_pictures.hpp"
#include "../map/photon_sets.hpp"
#include "../scene/test_scenes.hpp"

#include <photongrid/render/render.hpp>
#include <photongrid/trace/photon_event.kernel.hpp>

#include <cstring>

namespace photongrid::testing {

/// Mean over pixels and channels of (a - b)^2 / (b + 0.01)^2: pbrt's relative mean square error.
inline double relative_mse(const image& a, const image& b)
{
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double d = static_cast<double>(a.pixels[i][c]) - static_cast<double>(b.pixels[i][c]);
            const double r = static_cast<double>(b.pixels[i][c]) + 0.01;
            sum += d * d / (r * r);
        }
    return sum / static_cast<double>(3 * a.pixels.size());
}

/// What all lights send out, W.
inline dvec3 power_of_lights(const scene& s)
{
    dvec3 total(0);
    for (const auto& l : s.rectangle_lights)
        total += l.power;
    for (const auto& l : s.point_lights)
        total += l.power;
    return total;
}

inline void expect_an_exact_account(const photon_stats& p, std::uint64_t photons)
{
    EXPECT_EQ(p.emitted, p.absorbed + p.escaped + p.cut_off + p.invalid);
    EXPECT_EQ(p.diffuse_hits, p.stored + p.direct + p.dropped);
    EXPECT_EQ(p.stored, photons);
    EXPECT_EQ(p.invalid, 0u);
}

template <class Tag>
class pictures : public on_backend<Tag> {
protected:
    using B = typename Tag::type;

    image picture(const scene& s, render_settings settings, render_stats* out = nullptr)
    {
        auto drawn = render(this->b(), s, settings);
        if (out != nullptr)
            *out = drawn.stats;
        return std::move(drawn.picture);
    }
    image picture(const scene& s) { return picture(s, s.render); }

    /// Traced photons and the picture made of them, equal to serial's: bit for bit where arithmetic rounds correctly.
    void expect_serial(const scene& s, const render_settings& settings)
    {
        serial_backend serial;
        const auto photons_of = [&](auto& b) {
            const auto device = upload_scene(b, s);
            const auto t = trace_photons(b, s, device, settings);
            return std::tuple{b.download(t.photons.positions), b.download(t.photons.powers),
                b.download(t.photons.directions), t.emitted};
        };
        const auto mine = photons_of(this->b());
        const auto theirs = photons_of(serial);
        if (!this->b().caps().exact_division || !this->b().caps().exact_sqrt)
            GTEST_SKIP() << "this device rounds division or square root loosely; pictures are compared statistically "
                            "(long_statistics)";
        EXPECT_EQ(std::get<3>(mine), std::get<3>(theirs));
        EXPECT_EQ(count_different_bits(std::get<0>(mine), std::get<0>(theirs)), 0u)
            << "positions of " << settings.map.photons;
        EXPECT_EQ(count_different_bits(std::get<1>(mine), std::get<1>(theirs)), 0u)
            << "powers of " << settings.map.photons;
        EXPECT_EQ(count_different_bits(std::get<2>(mine), std::get<2>(theirs)), 0u)
            << "directions of " << settings.map.photons;

        for (const auto builder : {map_builder::sort, map_builder::route}) {
            auto with = settings;
            with.map.builder = builder;
            const auto [picture, a] = render(this->b(), s, with);
            const auto [reference, b] = render(serial, s, with);
            EXPECT_LE(relative_mse(picture, reference), 1e-9);
            EXPECT_EQ(a.photons.absorbed, b.photons.absorbed);
            EXPECT_EQ(a.photons.escaped, b.photons.escaped);
            EXPECT_EQ(a.photons.direct, b.photons.direct);
            EXPECT_EQ(a.map.overflowing_cells, b.map.overflowing_cells);
            EXPECT_EQ(a.estimate.points, b.estimate.points);
            EXPECT_EQ(a.invalid_pixels, 0u);
        }
    }
};
TYPED_TEST_SUITE_P(pictures);

TYPED_TEST_P(pictures, a_closed_diffuse_sphere_has_the_known_radiance)
{
    const dvec3 reflectance(0.5, 0.25, 0.75);
    const auto s = integrating_sphere(reflectance);
    for (const auto builder : {map_builder::sort, map_builder::route}) {
        auto settings = s.render;
        settings.map.builder = builder;
        settings.map.slots = 8;
        render_stats stats;
        const auto im = this->picture(s, settings, &stats);
        glm::dvec3 mean(0);
        for (const auto& p : im.pixels)
            mean += glm::dvec3(p) / static_cast<double>(im.pixels.size());
        for (int c = 0; c < 3; ++c) {
            const double known = reflectance[c] / (1 - reflectance[c]);
            EXPECT_NEAR(mean[c], known, 0.02 * known)
                << "channel " << c; // noise of 40,000 photons, the paper's N/A bias
        }
        expect_an_exact_account(stats.photons, settings.map.photons);
        EXPECT_EQ(stats.photons.escaped, 0u); // closed: no ray slips out
    }
}

TYPED_TEST_P(pictures, direct_light_of_a_rectangle_equals_the_form_factor)
{
    // Lambert's formula for the irradiance of a diffuse polygon, in double.
    auto s = small_cornell();
    s.spheres.clear();
    const auto& lamp = s.rectangle_lights[0];
    const dvec3 corners[4]
        = {lamp.corner, lamp.corner + lamp.edge_u, lamp.corner + lamp.edge_u + lamp.edge_v, lamp.corner + lamp.edge_v};
    const double area = glm::length(glm::cross(lamp.edge_u, lamp.edge_v));
    struct place {
        dvec3 point, normal;
    };
    const place places[] = {{{0.5, 0, 0.5}, {0, 1, 0}}, {{0.1, 0, 0.9}, {0, 1, 0}}, {{0.0, 0.3, 0.5}, {1, 0, 0}},
        {{1.0, 0.8, 0.2}, {-1, 0, 0}}, {{0.5, 0.1, 1.0}, {0, 0, -1}}};

    auto& b = this->b();
    const auto device = upload_scene(b, s);
    auto settings = s.render;
    settings.view.light_samples = 1024;
    std::vector<glm::vec4> points, normals;
    for (const auto& p : places) {
        points.emplace_back(glm::vec3(p.point - device.layout.center), 1.0f);
        normals.emplace_back(glm::vec3(p.normal), 0.0f);
    }
    detail::eye_hits<typename TestFixture::B> hits(b, points.size());
    hits.points = b.upload(std::span<const glm::vec4>(points));
    hits.surfaces = b.upload(std::span<const glm::vec4>(normals));
    auto irradiance = b.template make<glm::vec4>(points.size());
    detail::direct_light(b, device, hits, settings, 0, points.size(), irradiance);
    const auto light = b.download(irradiance);
    for (std::size_t i = 0; i < points.size(); ++i) {
        dvec3 sum(0);
        for (int e = 0; e < 4; ++e) {
            const dvec3 a = glm::normalize(corners[e] - places[i].point),
                        c = glm::normalize(corners[(e + 1) % 4] - places[i].point);
            sum += std::acos(glm::dot(a, c)) * glm::normalize(glm::cross(a, c));
        }
        const double factor
            = std::abs(glm::dot(sum, places[i].normal)) / (2 * M_PI); // of the hemisphere, cosine-weighted
        for (int c = 0; c < 3; ++c) {
            const double irradiance = lamp.power[c] / area * factor;
            EXPECT_NEAR(light[i][c], irradiance, 0.01 * irradiance) << "place " << i;
        }
    }
}

TYPED_TEST_P(pictures, a_glass_ball_focuses_the_flux_it_should)
{
    // A point light above a glass ball above a nearly black floor. What two refractions bring to the floor's middle is
    // a one-dimensional integral over the angle at the light, done here in double.
    scene s;
    s.name = "caustic";
    const double index = 1.5, radius = 0.3, height = 0.4, light_height = 1.6, floor_half = 3;
    s.materials
        = {{"floor", material_kind::lambertian, dvec3(0.001)}, {"glass", material_kind::glass, dvec3(1), index}};
    s.polygons = {{{{-floor_half, 0, -floor_half}, {-floor_half, 0, floor_half}, {floor_half, 0, floor_half},
                       {floor_half, 0, -floor_half}},
        0}};
    s.spheres = {{{0, height, 0}, radius, 1}};
    s.point_lights = {{"bulb", {0, light_height, 0}, dvec3(10)}};
    s.camera = {{0, 1, -3}, {0, 0, 0}, {0, 1, 0}, 45};
    s.render = {.map = {.photons = 20000, .grid = {100, 1, 100}},
        .estimate = {.k = 50, .max_radius = 0.1},
        .output = {.width = 8, .height = 8}};

    const double within = 0.12; // m from the axis on the floor
    const auto fresnel = [](double cos_i, double eta) {
        const double sin2 = eta * eta * (1 - cos_i * cos_i);
        if (sin2 >= 1)
            return 1.0;
        const double cos_t = std::sqrt(1 - sin2);
        const double a = (cos_i - eta * cos_t) / (cos_i + eta * cos_t),
                     p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
        return 0.5 * (a * a + p * p);
    };
    double expected = 0;
    const int steps = 200000;
    const double largest = std::asin(radius / (light_height - height));
    for (int i = 0; i < steps; ++i) {
        const double theta = (i + 0.5) / steps * largest;
        glm::dvec2 o(0, light_height - height),
            d(std::sin(theta), -std::cos(theta)); // about the ball's middle, in the plane
        const double bb = glm::dot(o, d), disc = bb * bb - glm::dot(o, o) + radius * radius;
        const glm::dvec2 p = o + d * (-bb - std::sqrt(std::max(0.0, disc)));
        const glm::dvec2 n = p / radius;
        const double cos_i = -glm::dot(d, n), eta = 1 / index, cos_t = std::sqrt(1 - eta * eta * (1 - cos_i * cos_i));
        const glm::dvec2 in = eta * d + (eta * cos_i - cos_t) * n;
        const glm::dvec2 q = p - 2 * glm::dot(p, in) * in;
        const glm::dvec2 m = -q / radius; // inward normal
        const double cos_j = -glm::dot(in, m),
                     cos_u = std::sqrt(std::max(0.0, 1 - index * index * (1 - cos_j * cos_j)));
        const glm::dvec2 out = index * in + (index * cos_j - cos_u) * m;
        const double t = (-height - q.y) / out.y;
        if (out.y < 0 && std::abs(q.x + t * out.x) <= within)
            expected += 10 * (1 - fresnel(cos_i, eta)) * (1 - fresnel(cos_j, index)) * 0.5 * std::sin(theta) * largest
                / steps;
    }

    auto& b = this->b();
    const auto device = upload_scene(b, s);
    const auto t = trace_photons(b, s, device, s.render);
    const auto positions = b.download(t.photons.positions);
    const auto powers = b.download(t.photons.powers);
    double flux = 0, squares = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const dvec3 p = dvec3(positions[i]) + device.layout.center;
        if (std::hypot(p.x, p.z) > within)
            continue;
        flux += static_cast<double>(powers[i].x);
        squares += static_cast<double>(powers[i].x) * static_cast<double>(powers[i].x);
    }
    // Light reflected twice and more inside the ball adds a little.
    EXPECT_GT(flux, expected - 4 * std::sqrt(squares));
    EXPECT_LT(flux, expected * 1.02 + 4 * std::sqrt(squares));
    EXPECT_GT(expected, 0.01);
}

TYPED_TEST_P(pictures, every_photon_and_every_watt_is_accounted_for)
{
    for (const auto& s : {small_cornell(), all_shapes()}) {
        auto& b = this->b();
        const auto device = upload_scene(b, s);
        const auto t = trace_photons(b, s, device, s.render);
        const auto stats = count_photons(b, t, t.photons.size());
        expect_an_exact_account(stats, s.render.map.photons);
        EXPECT_GT(stats.absorbed, 0u);
        EXPECT_GT(stats.escaped, 0u);
        EXPECT_GT(stats.direct, 0u);
        EXPECT_LT(stats.dropped, s.render.map.photon_depth);
        // No photon carries more than its light's power over the paths: roulette only takes colour.
        const dvec3 total = power_of_lights(s);
        for (const auto& p : b.download(t.photons.powers))
            ASSERT_LE(p.x + p.y + p.z, 3.01 * (total.x + total.y + total.z) / static_cast<double>(stats.emitted));
    }
}

TYPED_TEST_P(pictures, flux_balances_per_channel)
{
    // A light's power is absorbed at surfaces, escapes, or is cut off; per path and channel, on average.
    for (auto s : {small_cornell(), all_shapes()}) {
        auto& b = this->b();
        s.render.map.photon_depth = 6; // so that some is cut off
        const auto device = upload_scene(b, s);
        const uint paths = 16384;
        detail::photon_frames<typename TestFixture::B> f(b, std::size_t{paths} * 7);
        const uint frames = trace_batch(b, device, f, paths, 0, s.render);
        const auto positions = b.download(f.positions), powers = b.download(f.powers),
                   directions = b.download(f.directions);
        dvec3 mean(0), squares(0);
        for (uint p = 0; p < paths; ++p) {
            dvec3 balance(0);
            for (uint frame = 1; frame < frames; ++frame) {
                const std::size_t i = std::size_t{frame} * paths + p;
                const uint end = kernels::event_end(positions[i]);
                if (end == kernels::ENDED_BEFORE)
                    break;
                const dvec3 arriving(powers[i]);
                if (kernels::event_kind(positions[i]) == kernels::NO_SURFACE) { // escaped, or on a lamp
                    balance += arriving;
                    continue;
                }
                const dvec3 reflectance = s.materials[static_cast<std::size_t>(directions[i].w)].reflectance;
                balance += arriving * (dvec3(1) - reflectance);
                if (frame == 6) // whether cut off or absorbed here: what would have gone on, on average
                    balance += arriving * reflectance;
            }
            mean += balance;
            squares += balance * balance;
        }
        mean /= paths;
        const dvec3 error = glm::sqrt(glm::max(dvec3(0), squares / double(paths) - mean * mean) / double(paths));
        const dvec3 power = power_of_lights(s);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(mean[c], power[c], 4 * error[c]) << s.name << " channel " << c;
    }
}

TYPED_TEST_P(pictures, a_photon_takes_at_most_64_bytes)
{
    // Positions, powers, directions, and the pairs twice while they are sorted; grid apart.
    auto& b = this->b();
    auto s = integrating_sphere(dvec3(0.5));
    s.render.map.photons = 65536;
    const auto device = upload_scene(b, s);
    auto t = trace_photons(b, s, device, s.render);
    b.finish();
    const auto traced = b.bytes();
    EXPECT_LE(traced, 48u * 65536u + 100000u);
    const auto g = make_grid(device.layout.low, device.layout.high, {8, 8, 8});
    const auto map = sorted_map(b, std::move(t.photons), g);
    b.finish();
    EXPECT_LE(b.bytes(), 64u * 65536u + 100000u);
}

TYPED_TEST_P(pictures, long_statistics_of_a_picture_equal_serials)
{
    // For devices that round loosely, and a check of all others: over 8 seeds a side, at least 99.75 % of the means
    // over 8 x 8 pixels agree in a z-test (0.01, Sidak over the blocks).
    serial_backend serial;
    for (const auto& s : {small_cornell(), all_shapes()}) {
        const uint bx = s.render.output.width / 8, by = s.render.output.height / 8;
        const auto sample = [&](auto& device, uint first_seed) {
            std::vector<std::vector<double>> blocks(std::size_t{bx} * by * 3);
            for (uint seed = first_seed; seed < first_seed + 8; ++seed) {
                auto settings = s.render;
                settings.seed = seed;
                const auto im = render(device, s, settings).picture;
                for (uint y = 0; y < by; ++y)
                    for (uint x = 0; x < bx; ++x)
                        for (int c = 0; c < 3; ++c) {
                            double mean = 0;
                            for (uint j = 0; j < 64; ++j)
                                mean += static_cast<double>(im.pixels[(y * 8 + j / 8) * im.width + x * 8 + j % 8][c])
                                    / 64;
                            blocks[(std::size_t{y} * bx + x) * 3 + static_cast<std::size_t>(c)].push_back(mean);
                        }
            }
            return blocks;
        };
        const auto mine = sample(this->b(), 100), theirs = sample(serial, 200);
        const auto moments = [](const std::vector<double>& v) {
            double mean = 0, variance = 0;
            for (const double x : v)
                mean += x / static_cast<double>(v.size());
            for (const double x : v)
                variance += (x - mean) * (x - mean) / static_cast<double>(v.size() - 1);
            return std::pair{mean, variance / static_cast<double>(v.size())};
        };
        // Two-sided z for 1 - (1 - 0.01)^(1/n), widened by the 14 degrees of freedom of a t-test; bisection on the tail
        // of Student's distribution, since 8 seeds are few for a normal one.
        const double alpha = 1 - std::pow(1 - 0.01, 1.0 / static_cast<double>(mine.size()));
        const auto tail = [](double t) { // P(|T| > t), 14 degrees of freedom, by Simpson's rule
            const int n = 2000;
            const double top = 200, h = (top - t) / n;
            const auto density = [](double x) {
                return std::tgamma(7.5) / (std::sqrt(14 * M_PI) * std::tgamma(7)) * std::pow(1 + x * x / 14, -7.5);
            };
            double sum = density(t) + density(top);
            for (int i = 1; i < n; ++i)
                sum += density(t + i * h) * (i % 2 == 1 ? 4 : 2);
            return 2 * sum * h / 3;
        };
        double low = 0, high = 100;
        for (int i = 0; i < 60; ++i)
            (tail(0.5 * (low + high)) > alpha ? low : high) = 0.5 * (low + high);
        std::size_t accepted = 0;
        for (std::size_t i = 0; i < mine.size(); ++i) {
            const auto [a, va] = moments(mine[i]);
            const auto [c, vc] = moments(theirs[i]);
            accepted += std::abs(a - c) <= high * std::sqrt(va + vc + 1e-14) ? 1u : 0u;
        }
        EXPECT_GE(static_cast<double>(accepted), 0.9975 * static_cast<double>(mine.size()))
            << s.name << ", limit " << high;
    }
}

TYPED_TEST_P(pictures, cut_off_paths_are_counted)
{
    auto s = integrating_sphere(dvec3(0.9));
    s.render.map.photon_depth = 3;
    s.render.map.photons = 2000;
    render_stats stats;
    this->picture(s, s.render, &stats);
    expect_an_exact_account(stats.photons, 2000);
    const double share = static_cast<double>(stats.photons.cut_off) / static_cast<double>(stats.photons.emitted);
    EXPECT_NEAR(share, 0.9 * 0.9 * 0.9, 4 * std::sqrt(0.2 / static_cast<double>(stats.photons.emitted)));
}

TYPED_TEST_P(pictures, equal_the_serial_backends)
{
    const auto a = small_cornell();
    this->expect_serial(a, a.render);
    const auto c = all_shapes();
    this->expect_serial(c, c.render);
    auto several = c.render;
    several.view.spp = 3;
    several.output.width = 24;
    several.output.height = 16;
    this->expect_serial(c, several);
}

TYPED_TEST_P(pictures, sorting_and_routing_agree)
{
    const auto s = small_cornell();
    auto settings = s.render;
    const auto sorted = this->picture(s, settings);
    settings.map.builder = map_builder::route;
    settings.map.slots = 16; // no cell overflows: the same photons in another order
    render_stats stats;
    const auto all_kept = this->picture(s, settings, &stats);
    EXPECT_EQ(stats.map.overflowing_cells, 0u);
    EXPECT_LE(
        relative_mse(all_kept, sorted), 1e-3); // at least k: which photon is the k-th depends on the order of visits
    settings.map.slots = 3;
    const auto some_kept = this->picture(s, settings, &stats);
    EXPECT_GT(stats.map.overflowing_cells, 0u);
    EXPECT_GT(stats.map.redistributed_power, 0.0);
    EXPECT_LE(relative_mse(some_kept, sorted), 0.03);
}

TYPED_TEST_P(pictures, a_moved_camera_runs_no_photon_pass)
{
    auto& b = this->b();
    const auto s = small_cornell();
    const auto built = build_map(b, s, s.render);
    const auto passes = [&](const char* kernel) {
        const auto at = b.costs().find(kernel);
        return at == b.costs().end() ? std::uint64_t{0} : at->second.passes;
    };
    const auto bounces = passes("bounce_photon"), sorts = passes("bitonic_step"), rays = passes("eye_ray");
    auto view = s.camera;
    const auto first = draw(b, built, view, s.render).picture;
    view.position.x += 0.2;
    const auto second = draw(b, built, view, s.render).picture;
    EXPECT_EQ(passes("bounce_photon"), bounces);
    EXPECT_EQ(passes("bitonic_step"), sorts);
    EXPECT_GT(passes("eye_ray"), rays);
    EXPECT_GT(relative_mse(first, second), 1e-3);
}

TYPED_TEST_P(pictures, the_same_seed_gives_the_same_bytes)
{
    const auto s = small_cornell();
    const auto a = this->picture(s), c = this->picture(s);
    EXPECT_EQ(std::memcmp(a.pixels.data(), c.pixels.data(), a.pixels.size() * sizeof(glm::vec3)), 0);
    auto other = s.render;
    other.seed = 99;
    EXPECT_GT(relative_mse(this->picture(s, other), a), 1e-5);
}

TYPED_TEST_P(pictures, running_estimates_are_shown_and_a_render_can_be_cancelled)
{
    auto& b = this->b();
    const auto s = small_cornell();
    auto settings = s.render;
    settings.estimate.k = 4000; // some passes
    settings.estimate.max_radius = 1;
    std::vector<image> shown;
    render_observer watch;
    watch.intermediate = [&](const image& im) { shown.push_back(im); };
    const auto watched = render(b, s, settings, watch).picture;
    const auto unwatched = this->picture(s, settings);
    EXPECT_EQ(
        std::memcmp(watched.pixels.data(), unwatched.pixels.data(), watched.pixels.size() * sizeof(glm::vec3)), 0);
    ASSERT_GE(shown.size(), 1u);
    EXPECT_EQ(shown[0].pixels.size(), watched.pixels.size());

    render_observer impatient;
    int asked = 0;
    impatient.cancelled = [&] { return ++asked > 2; };
    EXPECT_THROW((void)render(b, s, settings, impatient), render_cancelled);
    EXPECT_NO_THROW(this->picture(s));
}

TYPED_TEST_P(pictures, a_light_that_stores_no_photon_is_named)
{
    scene s;
    s.materials = {{"floor", material_kind::lambertian, dvec3(0.5)}};
    s.polygons = {{{{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}}, 0}};
    s.point_lights = {{"the bulb", {0, 1, 0}, dvec3(1)}};
    s.camera = {{0, 1, -3}, {0, 0, 0}, {0, 1, 0}, 45};
    s.render.map.photons = 50000; // long batches
    s.render.map.photon_depth = 2;
    try {
        (void)render(this->b(), s);
        FAIL() << "a scene that stores no photon was rendered";
    } catch (const std::runtime_error& e) {
        EXPECT_NE(std::string(e.what()).find("'the bulb'"), std::string::npos) << e.what();
    }
}

REGISTER_TYPED_TEST_SUITE_P(pictures, a_closed_diffuse_sphere_has_the_known_radiance,
    direct_light_of_a_rectangle_equals_the_form_factor, a_glass_ball_focuses_the_flux_it_should,
    every_photon_and_every_watt_is_accounted_for, flux_balances_per_channel, a_photon_takes_at_most_64_bytes,
    long_statistics_of_a_picture_equal_serials, cut_off_paths_are_counted, equal_the_serial_backends,
    sorting_and_routing_agree, a_moved_camera_runs_no_photon_pass, the_same_seed_gives_the_same_bytes,
    running_estimates_are_shown_and_a_render_can_be_cancelled, a_light_that_stores_no_photon_is_named);

} // namespace photongrid::testing

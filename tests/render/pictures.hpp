// The fixture of tests of the renderer, and what they compare pictures and photons with.
#pragma once

#include "../backends/serial_pictures.hpp"
#include "../core/under_test.hpp"
#include "../map/photon_sets.hpp"
#include "../scene/test_scenes.hpp"
#include "ball_over_floor.hpp"

#include <photongrid/render/render.hpp>

#include <cstring>

namespace photongrid::testing {

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

inline bool same_bytes(const image& a, const image& b)
{
    return a.width == b.width && a.height == b.height && a.pixels.size() == b.pixels.size()
        && std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(glm::vec3)) == 0;
}

/// What all lights send out, W.
inline dvec3 power_of_lights(const scene& s)
{
    dvec3 total(0);
    for (const auto& l : s.rectangle_lights)
        total += l.power;
    for (const auto& l : s.point_lights)
        total += l.power;
    for (const auto& l : s.mesh_lights)
        total += l.power;
    return total;
}

inline void expect_an_exact_account(const photon_stats& p, std::uint64_t photons)
{
    EXPECT_EQ(p.emitted, p.absorbed + p.escaped + p.cut_off + p.invalid);
    EXPECT_EQ(p.diffuse_hits, p.stored + p.direct + p.left_to_caustics + p.dropped);
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

    /// The photons within a circle on the floor have the power that two refractions bring there.
    void expect_focus(const scene& s, const ball_over_floor& ball)
    {
        auto& b = this->b();
        const auto device = upload_scene(b, s);
        expect_focus(trace_photons(b, device, s.render).photons, device.layout.center, ball);
    }
    void expect_focus(const photons<B>& found, const dvec3& center, const ball_over_floor& ball)
    {
        const double within = 0.12; // m from the axis on the floor
        const double expected = ball.power_on_floor(within);
        auto& b = this->b();
        const auto positions = b.download(found.positions);
        const auto powers = b.download(found.powers);
        double power = 0, squares = 0;
        for (std::size_t i = 0; i < positions.size(); ++i) {
            const dvec3 p = dvec3(positions[i]) + center;
            if (std::hypot(p.x, p.z) > within)
                continue;
            power += static_cast<double>(powers[i].x);
            squares += static_cast<double>(powers[i].x) * static_cast<double>(powers[i].x);
        }
        // Light reflected twice and more inside the ball adds a little.
        EXPECT_GT(power, expected - 4 * std::sqrt(squares));
        EXPECT_LT(power, expected * 1.02 + 4 * std::sqrt(squares));
        EXPECT_GT(expected, 0.01);
    }

    /// The picture of `settings`, which has the same bytes step by step, and resumed from a pass in the middle on.
    image expect_the_same_however_it_is_run(
        const scene& s, const render_settings& settings, const preview_settings& previews = {})
    {
        const auto whole = picture(s, settings);
        progressive_render<B> steps(this->b());
        steps.start(s, settings, previews);
        while (!steps.step(renderer::milliseconds(0)) && steps.progress().passes < 1) {}
        const auto state = steps.state();
        steps.start(s, settings);
        steps.resume(state);
        steps.step();
        EXPECT_TRUE(same_bytes(steps.picture(), whole));
        return whole;
    }

    /// Traced photons and the picture made of them, equal to serial's: bit for bit where arithmetic rounds correctly.
    void expect_serial(const scene& s, const render_settings& settings)
    {
        serial_backend serial;
        const auto photons_of = [&](auto& b) {
            const auto device = upload_scene(b, s);
            const auto t = trace_photons(b, device, settings);
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

} // namespace photongrid::testing

// The boxes of emission guides, and the light of guided photons.
#include "../map/photon_sets.hpp"
#include "../scene/test_scenes.hpp"

#include <photongrid/backends/serial/serial.hpp>
#include <photongrid/trace/trace_photons.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace photongrid::testing {
namespace {

    template <class Useful>
    std::vector<pilot_path> pilot_paths(std::size_t n, const Useful& useful)
    {
        random_source random(n);
        std::vector<pilot_path> paths(n);
        for (auto& p : paths) {
            for (auto& number : p.numbers)
                number = random();
            p.useful = useful(p.numbers);
        }
        return paths;
    }
    bool holds(const emission_box& b, const emission_numbers& u)
    {
        for (std::size_t i = 0; i < u.size(); ++i)
            if (u[i] < b.low[i] || u[i] >= b.low[i] + b.size[i])
                return false;
        return true;
    }
    /// In a slab of one number and, within it, below a slope: boxes can only come near.
    bool in_slab(const emission_numbers& u) { return u[2] > 0.3f && u[2] < 0.36f && u[5] < 0.5f + 0.5f * u[7]; }

    TEST(emission_guides, boxes_are_the_whole_cube_without_overlap)
    {
        const auto guide = guide_by(pilot_paths(30000, in_slab));
        ASSERT_GT(guide.boxes.size(), 10u);
        double volume = 0;
        std::uint64_t shares = 0;
        for (const auto& b : guide.boxes) {
            volume += b.volume();
            shares += b.share;
            EXPECT_GE(b.share, 1u);
            EXPECT_LE(b.weight(), 10.01); // the floor
        }
        EXPECT_EQ(volume, 1.0); // exact: sizes are powers of two
        EXPECT_EQ(shares, 1u << 24);
        random_source random(7);
        for (int n = 0; n < 2000; ++n) {
            emission_numbers u{};
            for (auto& number : u)
                number = random();
            EXPECT_EQ(std::count_if(
                          guide.boxes.begin(), guide.boxes.end(), [&](const emission_box& b) { return holds(b, u); }),
                1);
        }
    }

    TEST(emission_guides, the_gain_is_that_of_the_useful_paths)
    {
        // The slab's volume is 0.06 x 0.75. A guide that were exact would gain nearly its inverse, but for the floor:
        // its second moment of 0.045 / 0.9 gives 20.
        const auto guide = guide_by(pilot_paths(60000, in_slab));
        const double inside = 0.045, exact = 0.9 / inside;
        EXPECT_GT(guide.gain, 0.6 * exact);
        EXPECT_LE(guide.gain, 1.1 * exact); // the rate is counted, too
        // The second moment of the weights, counted with new numbers, not with those that made the boxes.
        random_source random(3);
        double moment = 0;
        const int n = 200000;
        for (int i = 0; i < n; ++i) {
            emission_numbers u{};
            for (auto& number : u)
                number = random();
            if (!in_slab(u))
                continue;
            const auto at = std::find_if(
                guide.boxes.begin(), guide.boxes.end(), [&](const emission_box& b) { return holds(b, u); });
            moment += at->weight() / n; // the mean over draws of weight^2 is the mean over even numbers of weight
        }
        EXPECT_NEAR(inside / moment, guide.gain, 0.15 * guide.gain);
    }

    TEST(emission_guides, paths_that_are_equally_useful_are_not_told_apart)
    {
        for (const float rate : {0.0f, 0.02f, 0.4f}) {
            random_source random(1);
            const auto guide = guide_by(pilot_paths(30000, [&](const emission_numbers&) { return random() < rate; }));
            EXPECT_LE(guide.boxes.size(), 3u) << rate; // one, but for chance
            EXPECT_LT(guide.gain, 1.05) << rate;
        }
        EXPECT_EQ(guide_by({}).boxes.size(), 1u);
    }

    TEST(emission_guides, light_that_is_useful_in_two_places_is_found)
    {
        // Each half of a number is as useful as the other.
        const auto useful
            = [](const emission_numbers& u) { return (u[0] > 0.2f && u[0] < 0.3f) || (u[0] > 0.7f && u[0] < 0.8f); };
        EXPECT_GT(guide_by(pilot_paths(30000, useful)).gain, 2.5); // of 4.5
    }

    /// The first frame of paths of a scene, guided.
    struct emission {
        std::vector<glm::vec4> powers, directions, positions;
    };
    emission emit(const scene& s, const emission_guide& guide, uint paths, uint first = 0)
    {
        serial_backend b;
        const auto device = upload_scene(b, s);
        const auto boxes = detail::upload_some(b, guide.records());
        detail::photon_frames<serial_backend> f(b, paths);
        detail::emit_photons(b, device, f, {paths, first, false, &boxes}, 5u);
        return {b.download(f.powers), b.download(f.directions), b.download(f.positions)};
    }
    scene scene_with_a_bulb()
    {
        auto s = small_cornell();
        s.rectangle_lights.clear();
        s.point_lights = {{"bulb", {0.5, 0.5, 0.2}, dvec3(3, 2, 1)}};
        return s;
    }

    TEST(emission_guides, guided_photons_bring_the_same_power_in_every_direction)
    {
        const auto s = scene_with_a_bulb();
        const auto guide = guide_by(
            pilot_paths(30000, [](const emission_numbers& u) { return u[0] > 0.3f && u[0] < 0.36f && u[1] < 0.4f; }));
        const uint n = 400000;
        const auto e = emit(s, guide, n);
        // Eight octants and their halves: 16 parts of the sphere of equal solid angle.
        std::array<double, 16> mean{}, square{};
        double most = 0;
        for (uint i = 0; i < n; ++i) {
            const auto d = e.directions[i];
            const std::size_t part = (d.x > 0 ? 1u : 0u) + (d.y > 0 ? 2u : 0u) + (d.z > 0 ? 4u : 0u)
                + (std::abs(d.x) > std::abs(d.z) ? 8u : 0u);
            const double power = static_cast<double>(e.powers[i].x) / n;
            mean[part] += power;
            square[part] += power * power;
            most = std::max(most, power * n);
            ASSERT_NEAR(e.powers[i].y / e.powers[i].x, 2.0 / 3, 1e-6);
        }
        for (std::size_t part = 0; part < mean.size(); ++part)
            EXPECT_NEAR(mean[part], 3.0 / 16, 4 * std::sqrt(square[part])) << part;
        EXPECT_GT(most, 2 * 3.0); // weights differ, or nothing was tested
    }

    TEST(emission_guides, boxes_get_their_share_of_any_run_of_paths)
    {
        emission_guide guide;
        guide.boxes.resize(2);
        guide.boxes[0].size.fill(1);
        guide.boxes[1].size.fill(1);
        guide.boxes[0].size[0] = guide.boxes[1].size[0] = guide.boxes[1].low[0] = 0.5f;
        guide.boxes[0].share = 3u << 22;
        guide.boxes[1].share = 1u << 22;
        const auto s = scene_with_a_bulb();
        for (const uint first : {0u, 1000u, 77777u}) {
            const uint n = 1000;
            const auto e = emit(s, guide, n, first);
            const auto in_second
                = std::count_if(e.powers.begin(), e.powers.end(), [](const glm::vec4& p) { return p.x > 3; });
            EXPECT_NEAR(static_cast<double>(in_second), n / 4, 2) << first;
            for (const auto& p : e.powers)
                EXPECT_NEAR(p.x, p.x > 3 ? 3 * 2.0 : 3 * 2.0 / 3, 1e-5);
            // The boxes are half spheres, and photons of the second box leave into the second half.
            int axes = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const auto on_one_side = [&](float sign) {
                    for (uint i = 0; i < n; ++i)
                        if ((sign * e.directions[i][axis] > 0) != (e.powers[i].x > 3))
                            return false;
                    return true;
                };
                axes += on_one_side(1) || on_one_side(-1) ? 1 : 0;
            }
            EXPECT_EQ(axes, 1) << first;
        }
    }

} // namespace
} // namespace photongrid::testing

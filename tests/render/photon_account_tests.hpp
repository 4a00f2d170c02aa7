// What becomes of photons and of their power, and the memory that they take.
#pragma once

#include "pictures.hpp"

#include <photongrid/trace/photon_event.kernel.hpp>

namespace photongrid::testing {

TYPED_TEST_P(pictures, every_photon_and_every_watt_is_accounted_for)
{
    for (auto s : {small_cornell(), all_shapes()})
        for (const auto emission : {photon_emission::power, photon_emission::guided}) {
            s.render.map.emission = emission;
            auto& b = this->b();
            const auto device = upload_scene(b, s);
            const auto t = trace_photons(b, device, s.render);
            const auto stats = count_photons(b, t);
            expect_an_exact_account(stats, s.render.map.photons);
            EXPECT_GT(stats.absorbed, 0u);
            EXPECT_GT(stats.escaped, 0u);
            EXPECT_GT(stats.direct, 0u);
            EXPECT_LT(stats.dropped, s.render.map.photon_depth);
            // No photon carries more than its light's power over the paths, since roulette only takes colour; guided,
            // not more than ten times as much.
            const dvec3 total = power_of_lights(s);
            const double most = emission == photon_emission::guided ? 30.1 : 3.01;
            for (const auto& p : b.download(t.photons.powers))
                ASSERT_LE(p.x + p.y + p.z, most * (total.x + total.y + total.z) / static_cast<double>(stats.emitted));
        }
}

TYPED_TEST_P(pictures, paths_that_overflow_are_counted_as_invalid)
{
    // A light's paths carry the power of all lights in its own colour. Here that is 2e38 W in each channel for the
    // white lamp, and 6e38 W for the red bulb, more than a float holds.
    auto s = small_cornell();
    s.rectangle_lights[0].power = dvec3(2e38);
    s.point_lights = {{"bulb", {0.5, 0.5, 0.2}, {1e37, 0, 0}}};
    auto& b = this->b();
    const auto device = upload_scene(b, s);
    const auto t = trace_photons(b, device, s.render);
    const auto stats = count_photons(b, t);
    EXPECT_EQ(stats.emitted, stats.absorbed + stats.escaped + stats.cut_off + stats.invalid);
    EXPECT_EQ(stats.diffuse_hits, stats.stored + stats.direct + stats.dropped);
    const double paths = static_cast<double>(stats.emitted), share = 1e37 / 6.1e38;
    EXPECT_NEAR(static_cast<double>(stats.invalid), paths * share, 5 * std::sqrt(paths * share));
    for (const auto& p : b.download(t.photons.powers))
        ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
}

TYPED_TEST_P(pictures, power_balances_per_channel)
{
    // A light's power is absorbed at surfaces, escapes, or is cut off; per path and channel, on average.
    for (auto s : {small_cornell(), all_shapes()}) {
        auto& b = this->b();
        s.render.map.photon_depth = 6; // so that some is cut off
        const auto device = upload_scene(b, s);
        const uint paths = 16384;
        detail::photon_frames<typename TestFixture::B> f(b, std::size_t{paths} * 7);
        const uint frames = trace_batch(b, device, f, {paths}, s.render);
        const auto positions = b.download(f.positions), powers = b.download(f.powers),
                   directions = b.download(f.directions);
        dvec3 mean(0), squares(0);
        for (uint p = 0; p < paths; ++p) {
            dvec3 balance(0);
            uint end = kernels::GOES_ON;
            for (uint frame = 1; frame < frames && end == kernels::GOES_ON; ++frame) {
                const std::size_t i = std::size_t{frame} * paths + p;
                end = kernels::event_end(positions[i]);
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

/// The grid apart: 48 bytes when photons are traced, for positions, powers and directions; 52 in the map, with the
/// list; and more while it is built.
TYPED_TEST_P(pictures, a_photon_takes_the_memory_that_is_stated)
{
    auto& b = this->b();
    constexpr std::uint64_t n = 65536, rest = 100000;
    auto s = integrating_sphere(dvec3(0.5));
    s.render.map.photons = n;
    s.render.estimate.leaks = {.side = true}; // no normals
    const auto device = upload_scene(b, s);
    const auto before = b.bytes();
    const auto t = trace_photons(b, device, s.render);
    b.finish();
    EXPECT_LE(b.bytes() - before, 48 * n + rest);

    const auto fresh = TypeParam::make(); // its peak is that of the map alone
    const auto copy
        = [&](const auto& vectors) { return fresh->upload(std::span<const glm::vec4>(b.download(vectors))); };
    photons<typename TestFixture::B> p{
        copy(t.photons.positions), copy(t.photons.powers), copy(t.photons.directions), {}};
    const auto map = sorted_map(*fresh, std::move(p), make_grid(device.layout.low, device.layout.high, {8, 8, 8}));
    fresh->finish();
    EXPECT_LE(fresh->bytes(), 52 * n + rest);
    EXPECT_LE(fresh->peak_bytes(), peak_bytes_per_photon<TypeParam>() * n + rest);
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

/// A bulb over a bare floor: no light reaches a second surface.
inline scene bulb_over_a_floor()
{
    scene s;
    s.materials = {{"floor", material_kind::lambertian, dvec3(0.5)}};
    s.polygons = {{{{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}}, 0}};
    s.point_lights = {{"the bulb", {0, 1, 0}, dvec3(1)}};
    s.camera = {{0, 1, -3}, {0, 0, 0}, {0, 1, 0}, 45};
    s.render.map.photons = 50000; // long batches
    s.render.map.photon_depth = 2;
    s.render.output.width = s.render.output.height = 16;
    return s;
}

/// A flat mesh of two triangles under a light.
inline scene mesh_under(scene lights)
{
    lights.polygons.clear();
    mesh square;
    square.positions = {{-1, 0, -1}, {-1, 0.25f, 1}, {1, 0.75f, 1}, {1, 0.5f, -1}};
    square.triangles = {{0, 1, 2}, {0, 2, 3}};
    placed_mesh placed;
    placed.surface = std::make_shared<const mesh>(std::move(square));
    lights.meshes = {placed};
    return lights;
}

/// Nothing, or next to nothing, of what a lone flat or convex object reflects meets a second surface: tracing ends all
/// the same, with what it stored.
TYPED_TEST_P(pictures, a_lone_object_under_any_light_is_drawn)
{
    auto under_a_sun = bulb_over_a_floor(), under_a_sky = under_a_sun;
    under_a_sun.point_lights.clear();
    under_a_sun.directional_lights = {{"the sun", {0, -1, 0}, dvec3(3)}};
    under_a_sky.point_lights.clear();
    under_a_sky.environment_lights = {{.name = "the sky", .file = "", .map = nullptr, .radiance = dvec3(1)}};
    auto ball = under_a_sky;
    ball.polygons.clear();
    ball.spheres = {{{0, 0, 0}, 0.5, 0}};
    for (auto s : {bulb_over_a_floor(), mesh_under(bulb_over_a_floor()), under_a_sun, mesh_under(under_a_sun),
             under_a_sky, mesh_under(under_a_sky), ball})
        for (const auto emission : {photon_emission::power, photon_emission::guided}) {
            s.render.map.photons = 256;
            s.render.map.emission = emission;
            render_stats stats;
            const auto drawn = this->picture(s, s.render, &stats);
            EXPECT_LE(stats.photons.stored, 5u);
            EXPECT_EQ(stats.photons.asked, 256u);
            EXPECT_LE(stats.photons.emitted, 1u << 16);
            EXPECT_EQ(stats.photons.emitted,
                stats.photons.absorbed + stats.photons.escaped + stats.photons.cut_off + stats.photons.invalid);
            EXPECT_EQ(stats.photons.stored + stats.photons.direct + stats.photons.dropped, stats.photons.diffuse_hits);
            if (stats.photons.stored > 0)
                continue;
            auto direct = s.render;
            direct.output.only = light_part::direct;
            EXPECT_TRUE(same_bytes(this->picture(s, direct), drawn));
        }
}

TYPED_TEST_P(pictures, a_scene_without_indirect_light_is_drawn_by_every_map)
{
    const auto s = bulb_over_a_floor();
    for (const auto builder : {map_builder::sort, map_builder::route, map_builder::blocks, map_builder::automatic}) {
        auto settings = s.render;
        settings.map.builder = builder;
        render_stats stats;
        const auto drawn = this->picture(s, settings, &stats);
        EXPECT_EQ(stats.photons.stored, 0u);
        // The floor under the bulb: reflectance / pi times irradiance, 1 W / (4 pi m^2).
        const auto middle = drawn.pixels[16 * 8 + 8];
        EXPECT_GT(middle.x, 0.5 * 0.5 / M_PI / (4 * M_PI));
        EXPECT_LT(middle.x, 0.5 / M_PI / (4 * M_PI) * 1.01);
    }
}

/// Light that few paths find is dimmed by the paths, not by the photons asked for: a bulb over a floor, and a plate far
/// away that one path in a thousand meets after the floor.
TYPED_TEST_P(pictures, photons_of_tracing_that_ends_early_have_their_whole_power)
{
    auto s = bulb_over_a_floor();
    s.polygons.push_back({{{-0.2, 2, -0.2}, {0.2, 2, -0.2}, {0.2, 2, 0.2}, {-0.2, 2, 0.2}}, 0});
    s.render.map.emission = photon_emission::power;
    auto& b = this->b();
    const auto device = upload_scene(b, s);
    const auto power_of = [&](uint photons, std::uint64_t most_paths) {
        photon_tracing<typename TestFixture::B> tracing(
            b, device, s.render, {.photons = photons, .most_paths = most_paths}, {});
        while (!tracing.finished())
            tracing.advance();
        const auto t = tracing.take();
        EXPECT_LE(t.emitted, most_paths);
        double power = 0;
        for (const auto& p : b.download(t.photons.powers))
            power += static_cast<double>(p.x);
        return std::pair(power, t.stored);
    };
    const auto [all, stored] = power_of(1000, 1u << 22);
    ASSERT_EQ(stored, 1000u);
    const auto [few, stored_of_few] = power_of(1000, 40000);
    ASSERT_LT(stored_of_few, 900u);
    ASSERT_GT(stored_of_few, 50u);
    EXPECT_NEAR(few, all, 5 * all / std::sqrt(static_cast<double>(stored_of_few)));
}

/// Where a driver ends long loops silently, a scene with more shapes would lose hits: it is refused.
TYPED_TEST_P(pictures, scenes_beyond_the_loop_limit_are_refused)
{
    auto s = bulb_over_a_floor();
    const auto limit = this->b().caps().loop_limit;
    const auto floor = s.polygons[0];
    const auto steps = shape_kind<polygon>::steps(floor) + 2; // two nodes of the tree
    s.polygons.assign(15000, floor);
    if (limit == 0) {
        EXPECT_NO_THROW((void)upload_scene(this->b(), s));
    } else {
        ASSERT_LT(limit, 15000 * steps);
        EXPECT_THROW((void)upload_scene(this->b(), s), std::invalid_argument);
        s.polygons.assign((limit - 32) / steps, floor);
        EXPECT_NO_THROW((void)upload_scene(this->b(), s));
        s.point_lights.push_back(s.point_lights[0]);
        EXPECT_THROW((void)upload_scene(this->b(), s), std::invalid_argument) << "twice as many shadow rays";
    }
}

/// A picture of direct light traces no photon, and is the same as with a map.
TYPED_TEST_P(pictures, direct_light_alone_traces_no_photon)
{
    auto s = small_cornell();
    auto& b = this->b();
    const auto whole = build_map(b, s, s.render);
    s.render.output.only = light_part::direct;
    const auto expected = draw(b, whole, s.camera, s.render).picture;
    const auto emissions = [&] {
        const auto& costs = b.costs();
        const auto found = costs.find("emit_photon");
        return found == costs.end() ? 0 : found->second.passes;
    };
    const auto before = emissions();
    render_stats stats;
    EXPECT_TRUE(same_bytes(this->picture(s, s.render, &stats), expected));
    EXPECT_EQ(emissions(), before);
    EXPECT_EQ(stats.photons.emitted, 0u);
    auto all = s.render;
    all.output.only = light_part::all;
    EXPECT_FALSE(same_map(s.render, all)) << "a map without photons";
    EXPECT_TRUE(same_map(all, s.render));
}

} // namespace photongrid::testing

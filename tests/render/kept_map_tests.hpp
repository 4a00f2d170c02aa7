// The photon map of the interactive loop: kept while only the view changes, built again when the light does.
#pragma once

#include "progressive.hpp"

namespace photongrid::testing {

TYPED_TEST_P(progressive, a_map_serves_until_the_light_changes)
{
    auto s = this->small_scene();
    s.render.estimate.leaks = {.side = true}; // photons keep no normals
    typename TestFixture::loop drawing(this->b());
    drawing.start(s, s.render, {.enabled = false});
    drawing.step();
    const auto rays = this->passes("eye_ray");
    EXPECT_EQ(drawing.maps(), 1u);

    auto moved = s;
    moved.camera.position.x += 0.2;
    moved.name = "another";
    auto settings = s.render;
    settings.estimate.k = 50;
    settings.estimate.filter = filter_kind::cone;
    settings.output.exposure = 1;
    settings.output.width = 32;
    for (const auto& [scene, with] : {std::pair{moved, s.render}, {s, settings}, {moved, settings}}) {
        const auto bounces = this->passes("bounce_photon");
        drawing.start(scene, with, {.target_ms = 1e-6});
        EXPECT_FALSE(drawing.finished());
        EXPECT_EQ(drawing.pictures(), 0u);
        EXPECT_THROW(drawing.picture(), std::logic_error);
        drawing.step();
        EXPECT_TRUE(drawing.finished());
        EXPECT_EQ(drawing.maps(), 1u) << "the photon map was built again";
        EXPECT_EQ(this->passes("bounce_photon"), bounces) << "photons were traced again";
        EXPECT_TRUE(same_bytes(drawing.picture(), this->whole(scene, with)));
    }
    EXPECT_GT(this->passes("eye_ray"), rays);

    auto lit = s;
    lit.rectangle_lights[0].corner.x -= 0.3;
    auto grown = s;
    grown.spheres[0].radius *= 0.5;
    auto painted = s;
    painted.materials[0].reflectance *= 0.5;
    auto more = s.render, seeded = s.render, routed = s.render, finer = s.render, only = s.render, shallow = s.render,
         facing = s.render, blocks = s.render, chosen = s.render;
    more.map.photons += 1000;
    seeded.seed = 7;
    routed.map.builder = map_builder::route;
    blocks.map.builder = map_builder::blocks;
    chosen.map.builder = map_builder::automatic;
    finer.map.grid *= 2u;
    only.output.only = light_part::caustic;
    shallow.map.photon_depth = 4;
    facing.estimate.leaks.min_cosine = 0.5f;
    for (const auto& [scene, with] : {std::pair{lit, s.render}, {grown, s.render}, {painted, s.render}, {s, more},
             {s, seeded}, {s, routed}, {s, blocks}, {s, chosen}, {s, finer}, {s, only}, {s, shallow}, {s, facing}}) {
        drawing.start(s, s.render, {.enabled = false}); // each differs from this in one thing
        drawing.step();
        const auto maps = drawing.maps();
        drawing.start(scene, with, {.enabled = false});
        drawing.step();
        EXPECT_EQ(drawing.maps(), maps + 1) << "the photon map is another scene's";
        EXPECT_TRUE(same_bytes(drawing.picture(), this->whole(scene, with)));
    }
}

TYPED_TEST_P(progressive, a_camera_that_moves_while_photons_are_traced_does_not_begin_them_anew)
{
    using ms = typename TestFixture::ms;
    auto s = this->small_scene();
    s.render.map.photons = 60000; // two batches and more
    typename TestFixture::loop drawing(this->b());
    drawing.start(s, s.render, {.enabled = false});
    drawing.step(ms(0));
    drawing.step(ms(0));
    for (int i = 0; i < 40 && !drawing.finished(); ++i) {
        s.camera.position.y += 0.001;
        drawing.start(s, s.render, {.enabled = false});
        drawing.step(ms(0));
    }
    EXPECT_EQ(drawing.maps(), 1u);
    drawing.step();
    EXPECT_TRUE(same_bytes(drawing.picture(), this->whole(s, s.render)));
}

} // namespace photongrid::testing

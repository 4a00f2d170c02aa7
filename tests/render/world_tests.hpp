// A scene on the device that the passes of a picture share, and the parts that an edited scene takes from it.
#pragma once

#include "progressive.hpp"

namespace photongrid::testing {

/// A textured mesh under a sky and a bulb.
inline scene textured_mesh_under_a_sky()
{
    scene s;
    const auto wood = std::make_shared<texture>(texture{2, 1, {}});
    wood->texels = {glm::u16vec4(65535, 30000, 0, 65535), glm::u16vec4(0, 65535, 20000, 65535)};
    s.materials = {{"wood", material_kind::lambertian, dvec3(0.5)}, {"plain", material_kind::lambertian, dvec3(0.7)}};
    s.materials[0].texture.map = wood;
    mesh square;
    square.positions = {{-1, 0, -1}, {-1, 0.25f, 1}, {1, 0.75f, 1}, {1, 0.5f, -1}};
    square.texture_coordinates = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
    square.triangles = {{0, 1, 2}, {0, 2, 3}};
    placed_mesh placed;
    placed.surface = std::make_shared<const mesh>(std::move(square));
    s.meshes = {placed};
    s.spheres = {{{0, 1.5, 0}, 0.25, 1}};
    s.point_lights = {{"bulb", {0.5, 1, 0}, dvec3(1)}, {"dim bulb", {-0.5, 1, 0}, dvec3(0.1)}};
    const auto sky = std::make_shared<environment_map>();
    sky->width = 2;
    sky->height = 2;
    sky->radiance = {glm::vec3(1), glm::vec3(2), glm::vec3(3), glm::vec3(4)};
    s.environment_lights = {{.name = "sky", .file = "", .map = sky, .radiance = dvec3(0.1)}};
    s.camera = {{0, 3, -3}, {0, 0.5, 0}, {0, 1, 0}, 45};
    s.render.map.photons = 500;
    s.render.output.width = s.render.output.height = 16;
    return s;
}

TYPED_TEST_P(progressive, an_edited_scene_shares_what_is_the_same)
{
    auto& b = this->b();
    const auto s = textured_mesh_under_a_sky();
    const std::shared_ptr<const world<typename TestFixture::B>> first = prepare(b, s);
    struct edit {
        const char* what;
        std::function<void(scene&)> change;
        bool meshes, texels, environment;
    };
    const edit edits[] = {{"nothing", [](scene&) {}, true, true, true},
        {"a colour", [](scene& x) { x.materials[1].reflectance = dvec3(0.2); }, true, true, true},
        {"a power", [](scene& x) { x.point_lights[0].power = dvec3(3); }, true, true, true},
        {"a lamp's place", [](scene& x) { x.point_lights[1].position.y = 1.125; }, true, true, true},
        {"the whole scene's place", [](scene& x) { x = detail::moved_back(std::move(x), dvec3(64)); }, true, true,
            true},
        {"the place of the first lamp, to which all others are relative",
            [](scene& x) { x.point_lights[0].position.y = 1.125; }, false, true, true},
        {"a mesh's place", [](scene& x) { x.meshes[0].offset.y = 0.125; }, false, true, true},
        {"a mesh's material", [](scene& x) { x.meshes[0].material = 1; }, false, true, true},
        {"a shape that makes the scene larger", [](scene& x) { x.spheres[0].center.x = 7; }, false, true, true},
        {"the sky", [](scene& x) { x.environment_lights[0].radiance = dvec3(0.3); }, true, true, false},
        {"a texture",
            [](scene& x) {
                auto other = *x.materials[0].texture.map;
                other.texels[0] = glm::u16vec4(1, 2, 3, 65535);
                x.materials[0].texture.map = std::make_shared<const texture>(std::move(other));
            },
            true, false, true}};
    for (const auto& e : edits) {
        auto edited = s;
        e.change(edited);
        world_building<typename TestFixture::B> building(b, edited, first);
        while (!building.advance())
            continue;
        const auto after = building.take(), fresh = prepare(b, edited);
        EXPECT_EQ(after->scene.meshes == first->scene.meshes, e.meshes) << e.what;
        EXPECT_EQ(after->scene.texels == first->scene.texels, e.texels) << e.what;
        EXPECT_EQ(after->scene.environment == first->scene.environment, e.environment) << e.what;
        const auto expect_same
            = [&](const auto& x, const auto& y) { EXPECT_EQ(b.download(x), b.download(y)) << e.what; };
        expect_same(after->scene.records, fresh->scene.records);
        const auto &m = *after->scene.meshes, &f = *fresh->scene.meshes;
        if constexpr (requires { m.triangles.pairs; }) { // cpu has a tree of its own
            expect_same(m.triangles.pairs, f.triangles.pairs);
            expect_same(m.triangles.corners, f.triangles.corners);
        }
        expect_same(m.faces, f.faces);
        expect_same(m.planes, f.planes);
        expect_same(m.vertices, f.vertices);
        expect_same(m.attributes, f.attributes);
        expect_same(*after->scene.texels, *fresh->scene.texels);
        expect_same(after->scene.environment->texels, fresh->scene.environment->texels);
        expect_same(after->scene.environment->shares, fresh->scene.environment->shares);
    }
}

TYPED_TEST_P(progressive, an_edit_draws_the_picture_of_the_edited_scene)
{
    auto s = textured_mesh_under_a_sky();
    typename TestFixture::loop drawing(this->b());
    const auto draw = [&] {
        drawing.start(s, s.render, {.enabled = false});
        EXPECT_EQ(drawing.progress().stage == "prepare_scene", drawing.stats().prepare_scene.ms == 0.0);
        drawing.step();
        EXPECT_TRUE(same_bytes(drawing.picture(), this->whole(s, s.render)));
        return drawing.stats().prepare_scene.ms;
    };
    const double first = draw();
    EXPECT_GT(first, 0.0);
    s.camera.position.x += 0.25;
    EXPECT_EQ(draw(), first) << "the scene was prepared again";
    s.point_lights[0].power *= 2.0;
    EXPECT_NE(draw(), first);
    s.meshes[0].offset.y += 0.25;
    draw();
}

TYPED_TEST_P(progressive, all_passes_share_one_world)
{
    auto s = textured_mesh_under_a_sky();
    s.render.output.passes = 3;
    typename TestFixture::loop drawing(this->b());
    drawing.start(s, s.render, {.enabled = false});
    std::vector<std::string> stages;
    while (!drawing.step(typename TestFixture::ms(0)))
        if (const std::string now(drawing.progress().stage); stages.empty() || stages.back() != now)
            stages.push_back(now);
    EXPECT_EQ(std::count(stages.begin(), stages.end(), "prepare_scene"), 1);
    EXPECT_EQ(stages.front(), "prepare_scene");
    EXPECT_EQ(drawing.maps(), 3u);
}

/// A scene that is given up while it is prepared, for another or for another camera.
TYPED_TEST_P(progressive, a_pass_is_a_function_of_its_number)
{
    auto& b = this->b();
    auto s = textured_mesh_under_a_sky();
    s.render.output.passes = 3;
    for (const auto radii : {radius_kind::per_pass, radius_kind::shrinking}) {
        s.render.estimate.radii = radii;
        const auto whole = render(b, s);
        const auto world = prepare(b, s);
        auto sum = film_for(s, world->scene.layout, s.render);
        for (const uint number : {2u, 0u, 1u})
            sum.add(number, draw_pass(b, world, s.camera, s.render, number));
        EXPECT_EQ(sum.picture().picture.pixels, whole.picture.pixels);
    }
}

TYPED_TEST_P(progressive, a_preparation_can_be_interrupted)
{
    auto s = textured_mesh_under_a_sky(), other = s;
    other.meshes[0].offset.y = 0.125;
    typename TestFixture::loop drawing(this->b());
    drawing.start(other, other.render, {.enabled = false});
    drawing.step(typename TestFixture::ms(0));
    EXPECT_EQ(drawing.progress().stage, "prepare_scene");
    EXPECT_GT(drawing.progress().fraction, 0.0);
    drawing.start(s, s.render, {.enabled = false});
    drawing.step(typename TestFixture::ms(0));
    s.camera.position.x += 0.25;
    drawing.start(s, s.render, {.enabled = false});
    EXPECT_GT(drawing.progress().fraction, 0.0) << "it began anew for another camera";
    drawing.step();
    EXPECT_TRUE(same_bytes(drawing.picture(), this->whole(s, s.render)));

    render_observer impatient;
    impatient.cancelled = [] { return true; };
    EXPECT_THROW((void)prepare(this->b(), s, impatient), render_cancelled);
}

} // namespace photongrid::testing

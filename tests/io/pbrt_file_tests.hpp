// pbrt-v4 files: where the camera, shapes and lights are, what materials become, what is noted and what is refused. The
// expected values are computed from pbrt's own definitions.
#pragma once

#include "import_tests.hpp"

#include <photongrid/io/pbrt_file.hpp>

#include <glm/gtc/matrix_transform.hpp>

#include <complex>
#include <numbers>

namespace photongrid {
namespace {

    const std::string lamp = "LightSource \"point\" \"point3 from\" [ 0 5 0 ]\n";
    const std::string ball = "Shape \"sphere\" \"float radius\" 2\n";

    imported_scene pbrt_scene(const std::string& world, const std::string& options = "Camera \"perspective\"\n",
        const import_settings& settings = {})
    {
        return parse_pbrt("s.pbrt", options + "WorldBegin\n" + world + lamp, settings);
    }
    scene pbrt_world(const std::string& world) { return pbrt_scene(world).scene; }

    struct view_case {
        const char* name;
        std::string transformation;
        glm::dmat4 world_to_camera;
        bool mirrored; ///< pbrt's world is left-handed there; the scene has its z reversed
    };

    /// pbrt's camera looks along +z, with +x right and +y up; the field of view is that of the smaller side.
    TEST(pbrt_camera, sees_all_four_corners_where_pbrt_does)
    {
        const glm::dmat4 flip = glm::scale(glm::dmat4(1), dvec3(1, 1, -1));
        const auto turned = glm::rotate(glm::dmat4(1), glm::radians(40.0), dvec3(0.2, 1, 0.1));
        const auto moved = glm::translate(glm::dmat4(1), dvec3(1, -2, 7));
        // LookAt 3 2 1  0 1 0  0 1 0 by pbrt's definition: columns right, up, forward, place.
        const dvec3 eye(3, 2, 1), forward = glm::normalize(dvec3(0, 1, 0) - eye),
                                  right = glm::normalize(glm::cross(dvec3(0, 1, 0), forward));
        const glm::dmat4 placed(glm::dvec4(right, 0), glm::dvec4(glm::cross(forward, right), 0), glm::dvec4(forward, 0),
            glm::dvec4(eye, 1));
        const view_case cases[] = {{"nothing", "", glm::dmat4(1), true},
            {"LookAt", "LookAt 3 2 1 0 1 0 0 1 0\n", glm::inverse(placed), true},
            {"mirrored LookAt", "Scale -1 1 1\nLookAt 3 2 1 0 1 0 0 1 0\n",
                glm::scale(glm::dmat4(1), dvec3(-1, 1, 1)) * glm::inverse(placed), false},
            {"Transform", "Transform [1 0 0 0 0 1 0 0 0 0 -1 0 1 -2 7 1]\n", moved * flip, false},
            {"several", "Translate 1 -2 7\nRotate 40 0.2 1 0.1\nScale 1 1 -1\n", moved * turned * flip, false}};
        for (const auto& c : cases)
            for (const glm::dvec2 size : {glm::dvec2(40, 20), glm::dvec2(20, 50)}) {
                const auto film = "Film \"rgb\" \"integer xresolution\" " + std::to_string(static_cast<int>(size.x))
                    + " \"integer yresolution\" [ " + std::to_string(static_cast<int>(size.y)) + " ]\n";
                const auto made
                    = pbrt_scene(ball, film + c.transformation + "Camera \"perspective\" \"float fov\" [ 50 ]\n");
                EXPECT_TRUE(made.notes.empty()) << c.name;
                const auto& s = made.scene;
                EXPECT_EQ(s.render.output.width, size.x);
                EXPECT_EQ(s.render.output.height, size.y);
                const auto to_world = glm::inverse(c.world_to_camera);
                const dvec3 mirror(1, 1, c.mirrored ? -1 : 1);
                expect_near(s.camera.position, mirror * dvec3(to_world[3]));
                const double t = std::tan(glm::radians(25.0)), smaller = std::min(size.x, size.y);
                for (const double x : {-1.0, 1.0})
                    for (const double y : {-1.0, 1.0}) {
                        const dvec3 in_camera(x * t * size.x / smaller, y * t * size.y / smaller, 1);
                        expect_near(
                            view_direction(s, x, y), glm::normalize(mirror * (glm::dmat3(to_world) * in_camera)), 1e-9);
                    }
                expect_near(s.point_lights.at(0).position, mirror * dvec3(0, 5, 0));
            }
    }

    TEST(pbrt_file, places_shapes_by_the_graphics_state)
    {
        const auto s = pbrt_world("Translate 1 0 0\nAttributeBegin\nScale 2 2 2\n" + ball
            + "AttributeEnd\nTransformBegin\nTranslate 0 3 0\n" + ball + "TransformEnd\n" + ball
            + "CoordinateSystem \"here\"\nIdentity\nObjectBegin \"pair\"\nTranslate 0 0 4\n" + ball
            + "ObjectEnd\nTranslate 10 0 0\nObjectInstance \"pair\"\nRotate 90 0 1 0\nObjectInstance \"pair\"\n"
              "CoordSysTransform \"here\"\nConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 9 1]\n"
            + ball);
        ASSERT_EQ(s.spheres.size(), 6u);
        const auto at = [&](std::size_t n) { return s.spheres[n].center * dvec3(1, 1, -1); }; // z is reversed
        expect_near(at(0), {1, 0, 0});
        EXPECT_EQ(s.spheres[0].radius, 4);
        expect_near(at(1), {1, 3, 0});
        expect_near(at(2), {1, 0, 0});
        EXPECT_EQ(s.spheres[2].radius, 2);
        expect_near(at(3), {1, 0, 9}); // shapes come before the places of objects
        expect_near(at(4), {10, 0, 4});
        expect_near(at(5), {14, 0, 0}); // +z turned about +y is +x
    }

    /// The normal of a triangle in the scene, with its length.
    dvec3 normal_of_triangle(const placed_mesh& m)
    {
        const auto c = corners_of(m, 0);
        return glm::cross(c[1] - c[0], c[2] - c[0]);
    }

    // pbrt: the side of the vertices' normals; else that of the cross product, which ReverseOrientation and a
    // transformation that mirrors exchange, so that it goes along with the surface.
    TEST(pbrt_file, surfaces_face_as_in_pbrt)
    {
        const std::string positions = "\"point3 P\" [ 0 0 0  1 0 0  0 1 0 ]",
                          up = " \"normal N\" [ 0 0 1 0 0 1 0 0 1 ]", down = " \"normal N\" [ 0 0 -1 0 0 -1 0 0 -1 ]";
        const std::string right_handed = "Scale 1 1 -1\nCamera \"perspective\"\n";
        const auto z_of = [&](const std::string& before, const std::string& after, const std::string& camera) {
            const auto made = pbrt_scene(before + "Shape \"trianglemesh\" " + positions + after + "\n", camera);
            return normal_of_triangle(made.scene.meshes.at(0)).z;
        };
        for (const bool is_mirrored : {false, true}) {
            const auto camera = is_mirrored ? std::string("Camera \"perspective\"\n") : right_handed;
            const double sign = is_mirrored ? -1 : 1;
            EXPECT_EQ(z_of("", "", camera), sign);
            EXPECT_EQ(z_of("", up, camera), sign);
            EXPECT_EQ(z_of("", down, camera), -sign);
            EXPECT_EQ(z_of("ReverseOrientation\n", "", camera), -sign);
            EXPECT_EQ(z_of("ReverseOrientation\n", up, camera), -sign);
            EXPECT_EQ(z_of("ReverseOrientation\n", down, camera), sign);
            EXPECT_EQ(z_of("Scale -1 1 1\n", "", camera), sign);
            EXPECT_EQ(z_of("Scale 1 1 -1\n", "", camera), -sign);
            EXPECT_EQ(z_of("Scale 1 1 -1\n", down, camera), sign);
        }
    }

    TEST(pbrt_file, lamps_shine_with_their_radiance_on_their_side)
    {
        const std::string square = "Shape \"trianglemesh\" \"point3 P\" [ 1 3 1  1 3 2  3 3 2  3 3 1 ] "
                                   "\"integer indices\" [ 0 1 2 0 2 3 ]\n",
                          light = "AreaLightSource \"diffuse\" \"rgb L\" [ 5 6 7 ] \"float scale\" 2 ";
        const auto camera = "Scale 1 1 -1\nCamera \"perspective\"\n";
        const auto black = "Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n";
        const auto with = [&](const std::string& more, const std::string& shape) {
            return pbrt_scene(ball + black + light + more + "\n" + shape, camera);
        };
        const auto lit = with("", square);
        EXPECT_TRUE(lit.notes.empty());
        const auto& r = lit.scene.rectangle_lights.at(0);
        EXPECT_EQ(r.corner, dvec3(1, 3, 1));
        expect_near(glm::normalize(glm::cross(r.edge_u, r.edge_v)), {0, 1, 0}); // of the triangles
        expect_near(r.power, dvec3(10, 12, 14) * (std::numbers::pi * 2), 1e-9);
        const auto reversed = with("\nReverseOrientation", square).scene.rectangle_lights.at(0);
        expect_near(glm::normalize(glm::cross(reversed.edge_u, reversed.edge_v)), {0, -1, 0});
        EXPECT_EQ(reversed.corner, dvec3(1, 3, 1));

        const auto both = with("\"bool twosided\" true", square).scene;
        ASSERT_EQ(both.mesh_lights.size(), 1u);
        expect_near(both.mesh_lights[0].power, dvec3(10, 12, 14) * (std::numbers::pi * 4), 1e-6);
        expect_near(with("\"float power\" 30", square).scene.rectangle_lights.at(0).power, dvec3(300, 360, 420), 1e-9);

        const auto round = with("", ball).scene;
        expect_near(
            round.sphere_lights.at(0).power, dvec3(10, 12, 14) * (std::numbers::pi * 4 * std::numbers::pi * 4), 1e-9);
        const auto triangle = with("", "Shape \"trianglemesh\" \"point3 P\" [ 0 4 0  0 4 2  2 4 0 ]\n").scene;
        expect_near(triangle.mesh_lights.at(0).power, dvec3(10, 12, 14) * (std::numbers::pi * 2), 1e-9);
        // Its radiance does not depend on the unit of length.
        auto in_mm = pbrt_scene(ball + black + light + square, camera, {.unit = 0.001}).scene;
        expect_near(in_mm.rectangle_lights.at(0).power, dvec3(10, 12, 14) * (std::numbers::pi * 2e-6), 1e-15);
        expect_near(in_mm.point_lights.at(0).power, dvec3(4e-6 * std::numbers::pi), 1e-15);
        EXPECT_NEAR(in_mm.spheres.at(0).radius, 0.002, 1e-15);
    }

    TEST(pbrt_file, lights_have_their_intensity)
    {
        const double pi = std::numbers::pi;
        const auto s = pbrt_scene(ball
                + "LightSource \"point\" \"rgb I\" [ 1 2 3 ] \"float scale\" 2 \"point3 from\" [ 1 2 3 ]\n"
                  "LightSource \"point\" \"float power\" 7\n"
                  "LightSource \"spot\" \"rgb I\" [ 1 1 1 ] \"point3 from\" [ 0 9 0 ] \"point3 to\" [ 0 0 0 ] "
                  "\"float coneangle\" 40 \"float conedeltaangle\" 10\n"
                  "LightSource \"distant\" \"point3 from\" [ 0 2 0 ] \"point3 to\" [ 2 0 0 ] \"rgb L\" [ 3 2 1 ]\n"
                  "LightSource \"distant\" \"float illuminance\" 5\n"
                  "LightSource \"infinite\" \"rgb L\" [ 1 0 2 ]\nLightSource \"infinite\" \"float illuminance\" 3\n",
            "Scale 1 1 -1\nCamera \"perspective\"\n")
                           .scene;
        ASSERT_EQ(s.point_lights.size(), 3u);
        EXPECT_EQ(s.point_lights[0].position, dvec3(1, 2, 3));
        expect_near(s.point_lights[0].power, 8 * pi * dvec3(1, 2, 3));
        expect_near(s.point_lights[1].power, dvec3(7));
        const auto& spot = s.spot_lights.at(0);
        expect_near(spot.direction, {0, -9, 0});
        EXPECT_EQ(spot.inner_angle, 30);
        EXPECT_EQ(spot.outer_angle, 40);
        // The integral of pbrt's intensity, smoothstep in the cosine, over the sphere.
        double integral = 0;
        constexpr int steps = 100'000;
        for (int i = 0; i < steps; ++i) {
            const double cosine = (i + 0.5) / steps, low = std::cos(glm::radians(40.0)),
                         high = std::cos(glm::radians(30.0)), t = std::clamp((cosine - low) / (high - low), 0.0, 1.0);
            integral += 2 * pi / steps * (3 * t * t - 2 * t * t * t);
        }
        expect_near(spot.power, dvec3(integral), 1e-4);
        expect_near(s.directional_lights.at(0).direction, {2, -2, 0});
        expect_near(s.directional_lights.at(0).irradiance, {3, 2, 1});
        expect_near(s.directional_lights.at(1).direction, {0, 0, 1});
        expect_near(s.directional_lights.at(1).irradiance, dvec3(5));
        expect_near(s.environment_lights.at(0).radiance, dvec3(1, 0, 2) + 3 / pi);
    }

    TEST(pbrt_file, materials_become_photongrids)
    {
        struct material_case {
            const char *text, *name;
            material_kind kind;
            dvec3 reflectance;
            double index, roughness;
        };
        const auto aluminium = [](double eta, double k) { // Fresnel's reflectance of a conductor, head-on
            return std::norm((std::complex(eta, k) - 1.0) / (std::complex(eta, k) + 1.0));
        };
        const material_case cases[] = {
            {"\"diffuse\"", "grey", material_kind::lambertian, dvec3(0.5), 1.5, 0},
            {"\"diffuse\" \"rgb reflectance\" [ 0.1 0.2 0.3 ]", "rgb", material_kind::lambertian, {0.1, 0.2, 0.3}, 1.5,
                0},
            {"\"diffuse\" \"spectrum reflectance\" [ 300 0.3 800 0.3 ]", "spectrum", material_kind::lambertian,
                dvec3(0.3), 1.5, 0},
            {"\"dielectric\"", "glass", material_kind::glass, dvec3(1), 1.5, 0},
            {"\"dielectric\" \"float eta\" 1.8 \"float roughness\" 0.0625 \"bool remaproughness\" false", "rough",
                material_kind::glass, dvec3(1), 1.8, 0.25},
            {"\"dielectric\" \"float roughness\" 0.0625", "remapped", material_kind::glass, dvec3(1), 1.5, 0.5},
            {"\"thindielectric\" \"float eta\" 1.3", "pane", material_kind::thin_glass, dvec3(1), 1.3, 0},
            {"\"coateddiffuse\" \"float roughness\" 0 \"rgb reflectance\" [ 1 0 0 ]", "plastic", material_kind::plastic,
                {1, 0, 0}, 1.5, 0},
            {"\"conductor\" \"rgb eta\" [ 1.65746 0.880369 0.521229 ] \"rgb k\" [ 9.223869 6.269523 4.837001 ] "
             "\"float uroughness\" 0.25 \"float vroughness\" 0.25 \"bool remaproughness\" [ false ]",
                "metal", material_kind::metal,
                {aluminium(1.65746, 9.223869), aluminium(0.880369, 6.269523), aluminium(0.521229, 4.837001)}, 1.5, 0.5},
            {"\"conductor\" \"rgb reflectance\" [ 0.9 0.8 0.7 ]", "mirror", material_kind::metal, {0.9, 0.8, 0.7}, 1.5,
                0},
        };
        for (const auto& c : cases) {
            const auto made = pbrt_scene(
                "Material " + std::string(c.text) + "\n" + ball + "Material \"diffuse\"\nTranslate 9 0 0\n" + ball);
            const bool is_mesh = c.kind == material_kind::thin_glass; // smooth panes are
            const auto& m = made.scene.materials.at(
                is_mesh ? made.scene.meshes.at(0).material : made.scene.spheres.at(0).material);
            EXPECT_EQ(m.kind, c.kind) << c.name;
            expect_near(m.reflectance, c.reflectance, 1e-9);
            EXPECT_EQ(m.index_of_refraction, c.index) << c.name;
            EXPECT_NEAR(m.roughness, c.roughness, 1e-12) << c.name;
            EXPECT_FALSE(has_rebounds(m)) << c.name;
            EXPECT_EQ(made.notes.size(), is_mesh ? 1u : 0u) << c.name << ": " << text_of(made.notes.at(0));
        }
        const auto mixed = pbrt_world("MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\n"
                                      "MakeNamedMaterial \"b\" \"string type\" \"conductor\"\nMaterial \"mix\" "
                                      "\"string materials\" [ \"a\" \"b\" ] \"float amount\" 0.75\n"
            + ball);
        const auto& m = mixed.materials.at(mixed.spheres.at(0).material);
        EXPECT_EQ(m.kind, material_kind::mixture);
        EXPECT_EQ(m.share, 0.75);
        EXPECT_EQ(mixed.materials.at(m.parts[0]).name, "a");
        EXPECT_EQ(mixed.materials.at(m.parts[1]).kind, material_kind::metal);
    }

    TEST(pbrt_file, paths_are_as_deep_as_the_integrators)
    {
        const auto made
            = parse_pbrt("s.pbrt", "Integrator \"volpath\" \"integer maxdepth\" [ 13 ]\nWorldBegin\n" + ball);
        EXPECT_EQ(made.scene.render.view.depth, 13u);
        EXPECT_EQ(made.scene.render.map.photon_depth, 13u);
        const auto plain = parse_pbrt("s.pbrt", "Integrator \"path\"\nWorldBegin\n" + ball);
        EXPECT_EQ(plain.scene.render.view.depth, view_settings().depth);
    }

    TEST(pbrt_file, what_is_replaced_or_left_out_is_noted_with_its_place)
    {
        struct note_case {
            const char *text, *note;
        };
        const note_case cases[] = {
            {"Material \"hair\"\n", "s.pbrt:3:1: note: material \"hair\": drawn as diffuse 0.5"},
            {"Material \"diffuse\" \"float sigma\" 3\n",
                "s.pbrt:3:20: note: material \"diffuse\": \"float sigma\" is left out"},
            {"Shape \"curve\"\n", "s.pbrt:3:1: note: shape \"curve\": is left out"},
            {"Shape \"sphere\" \"float phimax\" 90\n", "s.pbrt:3:1: note: a part of a sphere: drawn as 4096 triangles"},
            {"Scale 1 2 1\nShape \"sphere\"\n",
                "s.pbrt:4:1: note: shape \"sphere\": drawn as 16384 triangles, since it is stretched, or has a texture "
                "or an alpha"},
            {"MakeNamedMedium \"fog\" \"string type\" \"cloud\"\nMediumInterface \"fog\" \"\"\n",
                "s.pbrt:3:1: note: medium \"fog\": is left out; light crosses it unchanged"},
            {"MakeNamedMedium \"milk\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [1 1 1]\n"
             "MediumInterface \"milk\" \"\"\n",
                "s.pbrt:3:1: note: medium \"milk\": absorbs light, but does not scatter it"},
            {"MakeNamedMedium \"fog\" \"string type\" \"cloud\"\nMediumInterface \"\" \"fog\"\n",
                "s.pbrt:5:1: note: the media outside of shapes are left out"},
            {"LightSource \"goniometric\"\n",
                "s.pbrt:3:1: note: light \"goniometric\": shines evenly in all directions"},
            {"Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"no.png\"\nMaterial \"diffuse\" \"texture "
             "reflectance\" \"t\"\n",
                "s.pbrt:3:35: note: 0.5 in the place of a texture: no.png: cannot be read: No such file or directory"},
            {"Texture \"t\" \"spectrum\" \"marble\"\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\n",
                "s.pbrt:3:1: note: texture \"marble\": drawn as 0.5 everywhere"},
            {"Material \"diffuse\" \"rgb reflectance\" [ 2 1 1 ]\n",
                "s.pbrt:3:20: note: a reflectance is limited to 0 to 1"},
            {"AreaLightSource \"diffuse\"\n",
                "s.pbrt:4:1: note: the surface of a lamp: black; its material is left out"},
        };
        for (const auto& c : cases) {
            const auto all = "Camera \"perspective\"\nWorldBegin Shape \"disk\"\n" + (c.text + ball) + lamp;
            const auto notes = notes_of(parse_pbrt("s.pbrt", all));
            EXPECT_TRUE(std::find(notes.begin(), notes.end(), c.note) != notes.end())
                << c.note << "\n"
                << (notes.empty() ? "(none)" : notes[0]);
            const auto refused = refusal_by([&] { return parse_pbrt("s.pbrt", all, {.strict = true}); });
            EXPECT_NE(refused, "") << c.text;
        }
        EXPECT_TRUE(pbrt_scene(ball, "Camera \"perspective\"\n", {.strict = true}).notes.empty());
        const auto no_camera = notes_of(parse_pbrt("s.pbrt", "WorldBegin\n" + ball, {.strict = true}));
        ASSERT_EQ(no_camera.size(), 2u); // neither replaced nor left out, so that it is not refused
        EXPECT_EQ(no_camera[0], "s.pbrt: note: the file has no light; a sky with a soft bright patch is added");
    }

    TEST(pbrt_file, media_inside_of_shapes_absorb)
    {
        const std::string ink = "MakeNamedMedium \"ink\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [1 2 4] "
                                "\"rgb sigma_s\" [0 0 0] \"float scale\" 0.5\nMediumInterface \"ink\" \"\"\n";
        const auto materials_of = [&](const std::string& material, const import_settings& how = {}) {
            return pbrt_scene(ink + material + ball + "MediumInterface \"\" \"\"\nTranslate 5 0 0\n" + ball,
                "Camera \"perspective\"\n", how)
                .scene.materials;
        };
        const auto glass = materials_of("Material \"dielectric\" \"float eta\" 1.5\n", {.strict = true, .unit = 0.01});
        ASSERT_EQ(glass.size(), 2u);
        EXPECT_EQ(glass[0].absorption, dvec3(0)) << "of the second ball";
        expect_near(glass[1].absorption, {50, 100, 200});
        EXPECT_EQ(glass[1].index_of_refraction, 1.5);
        const auto clear = materials_of("Material \"interface\"\n");
        ASSERT_EQ(clear.size(), 1u);
        expect_near(clear[0].absorption, {0.5, 1, 2});
        EXPECT_EQ(clear[0].index_of_refraction, 1);
        EXPECT_EQ(materials_of("Material \"diffuse\"\n").size(), 1u) << "it has no inside";
        EXPECT_NE(refusal_by([] {
            parse_pbrt("s.pbrt", "WorldBegin\nMediumInterface \"none\" \"\"\n" + ball);
        }).find("the medium \"none\" of this shape is not defined"),
            std::string::npos);
    }

    TEST(pbrt_file, refuses_with_the_place)
    {
        struct refusal_case {
            std::string text;
            const char* said;
        };
        const refusal_case cases[] = {
            {"", "s.pbrt: error: there is no WorldBegin, so that the file describes no scene"},
            {"WorldBegin\nShpae \"sphere\"\n",
                "s.pbrt:2:1: error: found \"Shpae\"; expected a directive of pbrt-v4, perhaps Shape"},
            {"Shape \"sphere\"\n", "s.pbrt:1:1: error: Shape stands before WorldBegin"},
            {"WorldBegin\nCamera \"perspective\"\n", "s.pbrt:2:1: error: Camera stands behind WorldBegin"},
            {"WorldBegin\nAttributeBegin\n", "s.pbrt:2:1: error: AttributeBegin has no end"},
            {"WorldBegin\n  AttributeEnd\n", "s.pbrt:2:3: error: AttributeEnd without its beginning"},
            {"WorldBegin\nAttributeBegin\nTransformEnd\n",
                "s.pbrt:3:1: error: TransformEnd without its beginning; here ends what AttributeBegin began"},
            {"Translate 1 2\nWorldBegin\n", "s.pbrt:2:1: error: found \"WorldBegin\"; expected a number"},
            {"Translate 1 2 1e999\n", "s.pbrt:1:15: error: found \"1e999\"; expected a number"},
            {"Scale nan 1 1\n", "s.pbrt:1:7: error: found \"nan\"; expected a number"},
            {"WorldBegin\nShape \"sphere", "s.pbrt:2:7: error: found a text without its second quote on the line"},
            {"WorldBegin\nShape \"sphere\" \"float radius\" [ 1 2 ]\n",
                "s.pbrt:2:16: error: found \"float radius\"; expected one float"},
            {"WorldBegin\nShape \"sphere\" \"string radius\" \"1\"\n",
                "s.pbrt:2:16: error: found \"string radius\"; expected one float"},
            {"WorldBegin\nShape \"sphere\" \"flaot radius\" 1\n",
                "s.pbrt:2:16: error: found the type \"flaot\"; expected one of pbrt-v4, such as float"},
            {"WorldBegin\nShape \"sphere\" \"float radius\" [ 1\n", "s.pbrt:2:31: error: found [ without its ]"},
            {"WorldBegin\nShape \"sphere\" \"float radius\" -1\n",
                "s.pbrt:2:1: error: the shape has no extent: a radius or an angle that is not above 0"},
            {"WorldBegin\nNamedMaterial \"x\"\n" + ball,
                "s.pbrt:3:1: error: the material \"x\" of this shape is not defined"},
            {"WorldBegin\nMaterial \"diffuse\" \"texture reflectance\" \"x\"\n" + ball,
                "s.pbrt:2:20: error: there is no texture \"x\" of spectrum in the file"},
            {"WorldBegin\nTexture \"x\" \"spectrum\" \"scale\" \"texture tex\" \"x\"\nMaterial \"diffuse\" \"texture "
             "reflectance\" \"x\"\n"
                    + ball,
                "s.pbrt:2:32: error: the texture \"x\" is made of itself, or of more than 100 within each other"},
            {"WorldBegin\nShape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 3 ]\n",
                "s.pbrt:2:55: error: found the index 3; there are 3 vertices"},
            {"WorldBegin\nShape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 ]\n",
                "s.pbrt:2:22: error: found \"point3 P\"; expected a multiple of 3 numbers"},
            {"WorldBegin\nShape \"plymesh\" \"string filename\" \"no.ply\"\n",
                "s.pbrt:2:17: error: no.ply: cannot be read: No such file or directory"},
            {"WorldBegin\nShape \"plymesh\" \"string filename\" \"/etc/passwd\"\n",
                "s.pbrt:2:17: error: /etc/passwd: lies outside of the scene's folder; --allow-outside lets scenes name "
                "such files"},
            {"WorldBegin\nInclude \"../x.pbrt\"\n",
                "s.pbrt:2:1: error: ../x.pbrt: lies outside of the scene's folder; --allow-outside lets scenes name "
                "such "
                "files"},
            {"WorldBegin\nObjectInstance \"x\"\n" + ball, "s.pbrt:2:1: error: the object \"x\" is not defined"},
            {"WorldBegin\nScale 0 1 1\nShape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]\n",
                "s.pbrt: error: the scene has no shape that can be drawn"},
            {"WorldBegin\nMaterial \"dielectric\"\n" + ball + "Translate 1 0 0\n" + ball
                    + "Material \"diffuse\"\nTranslate 9 0 0\n" + ball,
                "s.pbrt:5:1: error: this body overlaps another one of the same glass"},
            {"WorldBegin\n", "s.pbrt: error: the scene has no shape that can be drawn"},
            {"Scale 0 1 1\nCamera \"perspective\"\n",
                "s.pbrt:2:1: error: Camera: its transformation cannot be inverted"},
            {"Camera \"perspective\" \"float fov\" 200\nWorldBegin\n" + ball,
                "s.pbrt:1:1: error: camera: vertical_fov: must be between 0 and 179 degrees"},
        };
        for (const auto& c : cases)
            EXPECT_EQ(refusal_by([&] { return parse_pbrt("s.pbrt", c.text); }), c.said) << c.text;
        EXPECT_THROW(parse_pbrt("s.pbrt", "", {.unit = 0.0}), std::invalid_argument);
    }

    class pbrt_folder : public import_folder {
    protected:
        pbrt_folder()
        {
            write("below/square.ply",
                "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 "
                "2 3\n");
        }
        std::string refused(const std::string& text, const import_settings& settings = {})
        {
            write("s.pbrt", text);
            return refusal_by([&] { return import_scene((folder / "s.pbrt").string(), settings); });
        }
    };

    TEST_F(pbrt_folder, reads_files_that_it_names)
    {
        write("below/more.pbrt", "Translate 0 0 3\nShape \"plymesh\" \"string filename\" \"below/square.ply\"\n");
        write("s.pbrt",
            "# by hand\nScale 1 1 -1\nCamera \"perspective\"\nWorldBegin\nInclude \"below/more.pbrt\"\nImport "
            "\"below/more.pbrt\"\nShape \"plymesh\" \"string filename\" \"below\\\\square.ply\"\n"
                + lamp);
        const auto path = (folder / "s.pbrt").string();
        EXPECT_EQ(format_of_file(path), scene_format::pbrt);
        const auto s = import_scene(path).scene;
        ASSERT_EQ(s.meshes.size(), 3u);
        EXPECT_EQ(s.meshes[0].surface, s.meshes[1].surface); // read once
        EXPECT_EQ(s.meshes[0].file, "below/square.ply");
        EXPECT_EQ(s.meshes[0].offset, dvec3(0, 0, 3));
        EXPECT_EQ(s.meshes[1].offset, dvec3(0, 0, 6)); // Include goes on in the same state
        EXPECT_EQ(s.meshes[2].offset, dvec3(0, 0, 3)); // Import does not
    }

    TEST_F(pbrt_folder, keeps_to_its_folder)
    {
        const auto outside = folder.parent_path() / (folder.filename().string() + ".ply");
        std::filesystem::copy_file(
            folder / "below/square.ply", outside, std::filesystem::copy_options::overwrite_existing);
        std::filesystem::create_symlink(outside, folder / "link.ply");
        const auto shape = [](const std::string& file) {
            return "WorldBegin\nShape \"plymesh\" \"string filename\" \"" + file + "\"\n";
        };
        for (const auto& name : {"../" + outside.filename().string(), outside.string(), std::string("link.ply"),
                 "below/../../" + outside.filename().string()}) {
            EXPECT_NE(refused(shape(name)).find("lies outside of the scene's folder"), std::string::npos) << name;
            EXPECT_EQ(refused(shape(name), {.allow_outside = true}), "") << name;
        }
        EXPECT_EQ(refused(shape("below/../below/square.ply")), "");
        EXPECT_NE(refused(shape("below")).find("is a folder"), std::string::npos);
        std::filesystem::remove(outside);
        const auto again = refused("Include \"s.pbrt\"\n");
        EXPECT_NE(again.find("does one include itself?"), std::string::npos) << again;
    }

} // namespace
} // namespace photongrid

// Scenes of Mitsuba: where the camera, shapes and lights are, what materials become, what is noted and what is refused.
// The expected values are computed from Mitsuba's own definitions.
#pragma once

#include "pbrt_file_tests.hpp"

#include <photongrid/io/import/coat.hpp>
#include <photongrid/io/mitsuba_file.hpp>

namespace photongrid {
namespace {

    const std::string xml_lamp = "<emitter type=\"point\"><point name=\"position\" value=\"0, 5, 0\"/></emitter>\n";
    const std::string xml_ball = "<shape type=\"sphere\"><float name=\"radius\" value=\"2\"/></shape>\n";

    std::string xml_scene(const std::string& body, const std::string& version = "3.0.0")
    {
        return "<scene version=\"" + version + "\">\n" + body + "</scene>\n";
    }
    imported_scene mitsuba_scene(const std::string& body, const import_settings& settings = {})
    {
        return parse_mitsuba("s.xml", xml_scene(body + "<sensor type=\"perspective\"/>\n" + xml_lamp), settings);
    }
    scene mitsuba_world(const std::string& body) { return mitsuba_scene(body).scene; }

    std::string transform(const std::string& steps, const std::string& name = "to_world")
    {
        return "<transform name=\"" + name + "\">" + steps + "</transform>";
    }

    /// The matrix of Mitsuba's lookat: columns left, up, forward, place.
    glm::dmat4 looking(const dvec3& origin, const dvec3& target, const dvec3& up)
    {
        const dvec3 forward = glm::normalize(target - origin), left = glm::normalize(glm::cross(up, forward));
        return {glm::dvec4(left, 0), glm::dvec4(glm::cross(forward, left), 0), glm::dvec4(forward, 0),
            glm::dvec4(origin, 1)};
    }

    // Mitsuba's camera looks along +z with +y up; +x is on the left of its picture.
    TEST(mitsuba_camera, sees_all_four_corners_where_mitsuba_does)
    {
        struct place_case {
            const char* steps;
            glm::dmat4 to_world;
            bool mirrored; ///< the scene has its z reversed
        };
        const auto placed = looking({3, 2, 1}, {0, 1, 0}, {0.1, 1, 0});
        const std::string lookat = "<lookat origin=\"3, 2, 1\" target=\"0 1 0\" up=\"0.1, 1, 0\"/>";
        const auto flip = glm::scale(glm::dmat4(1), dvec3(-1, 1, 1));
        const std::string flipped = "<scale x=\"-1\"/>" + lookat;
        const auto turned = glm::rotate(glm::dmat4(1), glm::radians(40.0), dvec3(0.2, 1, 0.1));
        const place_case places[]
            = {{"", glm::dmat4(1), false}, {lookat.c_str(), placed, false}, {flipped.c_str(), placed * flip, true},
                {"<rotate x=\"0.2\" y=\"1\" z=\"0.1\" angle=\"40\"/><translate x=\"1\" y=\"-2\" z=\"7\"/>",
                    glm::translate(glm::dmat4(1), dvec3(1, -2, 7)) * turned, false},
                {"<matrix value=\"-1 0 0 4  0 1 0 5  0 0 -1 6  0 0 0 1\"/>",
                    glm::dmat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 4, 5, 6, 1), false}};
        struct view_case_of_fov {
            const char* properties;
            double (*horizontal)(double width, double height); ///< tangent of half the horizontal angle
        };
        static const double t = std::tan(glm::radians(25.0));
        const view_case_of_fov views[] = {{"<float name=\"fov\" value=\"50\"/>", [](double, double) { return t; }},
            {"<float name=\"fov\" value=\"50\"/><string name=\"fov_axis\" value=\"x\"/>",
                [](double, double) { return t; }},
            {"<float name=\"fov\" value=\"50\"/><string name=\"fovAxis\" value=\"y\"/>",
                [](double w, double h) { return t * w / h; }},
            {"<float name=\"fov\" value=\"50\"/><string name=\"fov_axis\" value=\"diagonal\"/>",
                [](double w, double h) { return t * w / std::sqrt(w * w + h * h); }},
            {"<float name=\"fov\" value=\"50\"/><string name=\"fov_axis\" value=\"smaller\"/>",
                [](double w, double h) { return w > h ? t * w / h : t; }},
            {"<float name=\"fov\" value=\"50\"/><string name=\"fov_axis\" value=\"larger\"/>",
                [](double w, double h) { return w > h ? t : t * w / h; }},
            {"<string name=\"focal_length\" value=\"35mm\"/>",
                [](double w, double h) { return 43.266615305567875 / 70 * w / std::sqrt(w * w + h * h); }},
            {"", [](double w, double h) { return 43.266615305567875 / 100 * w / std::sqrt(w * w + h * h); }}};
        for (const auto& c : places)
            for (const auto& v : views)
                for (const glm::dvec2 size : {glm::dvec2(40, 20), glm::dvec2(20, 50)}) {
                    const auto film = "<film type=\"hdrfilm\"><integer name=\"width\" value=\""
                        + std::to_string(static_cast<int>(size.x)) + "\"/><integer name=\"height\" value=\""
                        + std::to_string(static_cast<int>(size.y)) + "\"/></film>";
                    const auto made = parse_mitsuba("s.xml",
                        xml_scene("<sensor type=\"perspective\">" + transform(c.steps) + v.properties + film
                            + "</sensor>" + xml_ball + xml_lamp));
                    const std::string what = std::string(c.steps) + v.properties;
                    EXPECT_TRUE(made.notes.empty()) << what;
                    const auto& s = made.scene;
                    EXPECT_EQ(s.render.output.width, size.x);
                    EXPECT_EQ(s.render.output.height, size.y);
                    const dvec3 mirror(1, 1, c.mirrored ? -1 : 1);
                    expect_near(s.camera.position, mirror * dvec3(c.to_world[3]));
                    const double across = v.horizontal(size.x, size.y);
                    for (const double x : {-1.0, 1.0})
                        for (const double y : {-1.0, 1.0}) {
                            const dvec3 in_camera(-x * across, y * across * size.y / size.x, 1);
                            expect_near(view_direction(s, x, y),
                                glm::normalize(mirror * (glm::dmat3(c.to_world) * in_camera)), 1e-9);
                        }
                    expect_near(s.point_lights.at(0).position, mirror * dvec3(0, 5, 0));
                }
        const auto plain = mitsuba_world(xml_ball);
        EXPECT_EQ(plain.render.output.width, 768u);
        EXPECT_EQ(plain.render.output.height, 576u);
    }

    TEST(mitsuba_file, places_shapes)
    {
        const auto at = [](const std::string& steps) {
            return mitsuba_world("<shape type=\"sphere\"><point name=\"center\" x=\"1\" y=\"0\" z=\"0\"/>"
                + transform(steps) + "</shape>")
                .spheres.at(0);
        };
        // In their order: the second step acts on what the first one made.
        expect_near(at("<translate x=\"1\"/><scale value=\"2\"/>").center, {4, 0, 0});
        EXPECT_EQ(at("<translate x=\"1\"/><scale value=\"2\"/>").radius, 2);
        expect_near(at("<scale value=\"2\"/><translate value=\"1, 0, 3\"/>").center, {3, 0, 3});
        expect_near(at("<rotate y=\"1\" angle=\"90\"/>").center, {0, 0, -1});
        expect_near(at("<rotate value=\"0, 0, 1\" angle=\"90\"/>").center, {0, 1, 0});
        expect_near(at("<matrix value=\"0 -1 0 5  1 0 0 6  0 0 1 7  0 0 0 1\"/>").center, {5, 7, 7});
        expect_near(at("<matrix value=\"0 -1 0  1 0 0  0 0 1\"/>").center, {0, 1, 0});
        // lookat takes +z to where it looks and +x to its left.
        expect_near(at("<lookAt origin=\"0,0,0\" target=\"1,0,0\" up=\"0,1,0\"/>").center, {0, 0, -1});

        const auto round = mitsuba_world("<shape type=\"cylinder\"><point name=\"p0\" value=\"1, 2, 3\"/>"
                                         "<point name=\"p1\" value=\"1, 6, 6\"/><float name=\"radius\" value=\".5\"/>"
            + transform("<scale value=\"2\"/>") + "</shape><shape type=\"disk\">"
            + transform("<scale value=\"3\"/><rotate x=\"1\" angle=\"90\"/><translate y=\"4\"/>") + "</shape>");
        expect_near(round.cylinders.at(0).base, {2, 4, 6});
        expect_near(round.cylinders.at(0).top, {2, 12, 12});
        EXPECT_DOUBLE_EQ(round.cylinders.at(0).radius, 1);
        expect_near(round.disks.at(0).center, {0, 4, 0});
        expect_near(round.disks.at(0).normal, {0, -1, 0}); // +z turned about x
        EXPECT_DOUBLE_EQ(round.disks.at(0).radius, 3);

        const auto groups = mitsuba_world("<shape type=\"shapegroup\" id=\"pair\"><shape type=\"sphere\">"
            + transform("<translate z=\"4\"/>")
            + "</shape><shape type=\"sphere\"><float name=\"radius\" value=\"2\"/></shape></shape>"
              "<shape type=\"instance\"><ref id=\"pair\"/>"
            + transform("<translate x=\"10\"/>") + "</shape><alias id=\"pair\" as=\"two\"/><shape type=\"instance\">"
            + transform("<rotate y=\"1\" angle=\"90\"/><translate x=\"10\"/>") + "<ref id=\"two\"/></shape>");
        ASSERT_EQ(groups.spheres.size(), 4u);
        expect_near(groups.spheres[0].center, {10, 0, 4});
        expect_near(groups.spheres[1].center, {10, 0, 0});
        EXPECT_EQ(groups.spheres[1].radius, 2);
        expect_near(groups.spheres[2].center, {14, 0, 0});
    }

    TEST(mitsuba_file, replaces_parameters)
    {
        const auto s = mitsuba_world("<default name=\"r\" value=\"2\"/><default name=\"r\" value=\"9\"/>"
                                     "<default name=\"rest\" value=\"4\"/><default name=\"both\" value=\"$r, $rest\"/>"
                                     "<shape type=\"sphere\"><float name=\"radius\" value=\"1$r\"/><point "
                                     "name=\"center\" value=\"$both,$r5\"/></shape>");
        EXPECT_EQ(s.spheres.at(0).radius, 12);              // the first value of a name is valid
        EXPECT_EQ(s.spheres.at(0).center, dvec3(2, 4, 25)); // the longest name that is defined
    }

    TEST(mitsuba_file, old_spelling_means_the_same)
    {
        const std::string old
            = xml_scene("<sensor type=\"perspective\"><float name=\"fov\" value=\"30\"/><string name=\"fovAxis\" "
                        "value=\"smaller\"/><float name=\"nearClip\" value=\"1\"/><transform name=\"toWorld\"><lookAt "
                        "origin=\"1,2,3\" target=\"0,0,0\" up=\"0,1,0\"/></transform></sensor><shape type=\"sphere\">"
                        "<transform name=\"toWorld\"><translate x=\"1\"/></transform><bsdf type=\"roughdielectric\">"
                        "<float name=\"intIOR\" value=\"1.6\"/><string name=\"extIOR\" value=\"vacuum\"/><string "
                        "name=\"distribution\" value=\"ggx\"/></bsdf></shape><shape type=\"rectangle\"><boolean "
                        "name=\"flipNormals\" value=\"true\"/></shape>"
                    + xml_lamp,
                "0.6.0"),
            now = xml_scene("<sensor type=\"perspective\"><float name=\"fov\" value=\"30\"/><string "
                            "name=\"fov_axis\" value=\"smaller\"/><float name=\"near_clip\" value=\"1\"/>"
                            "<transform name=\"to_world\"><lookat origin=\"1,2,3\" target=\"0,0,0\" up=\"0,1,0\"/>"
                            "</transform></sensor><shape type=\"sphere\"><transform name=\"to_world\"><translate "
                            "x=\"1\"/></transform><bsdf type=\"roughdielectric\"><float name=\"int_ior\" "
                            "value=\"1.6\"/><string name=\"ext_ior\" value=\"vacuum\"/><string "
                            "name=\"distribution\" value=\"ggx\"/></bsdf></shape><shape type=\"rectangle\">"
                            "<boolean name=\"flip_normals\" value=\"true\"/></shape>"
                    + xml_lamp,
                "3.5.0");
        const auto a = parse_mitsuba("s.xml", old), b = parse_mitsuba("s.xml", now);
        EXPECT_TRUE(a.scene == b.scene);
        EXPECT_TRUE(a.notes.empty() && b.notes.empty());
        EXPECT_EQ(a.scene.materials.at(0).index_of_refraction, 1.6);
        EXPECT_NEAR(a.scene.camera.vertical_fov, 30, 1e-12); // 576 is the smaller side
        // Mitsuba 0.6 takes copper where a conductor says nothing, 3 a perfect mirror.
        const auto conductor = [](const char* version) {
            const auto world = xml_ball + "<shape type=\"disk\"><bsdf type=\"conductor\"/></shape>" + xml_lamp;
            const auto s = parse_mitsuba("s.xml", xml_scene(world, version)).scene;
            return s.materials.at(s.disks.at(0).material).reflectance;
        };
        EXPECT_EQ(conductor("3.0.0"), dvec3(1));
        EXPECT_LT(conductor("0.5.0").z, 0.7);
    }

    TEST(mitsuba_file, surfaces_face_as_in_mitsuba)
    {
        const auto normal = [](const std::string& properties) {
            return normal_of_triangle(
                mitsuba_world("<shape type=\"rectangle\">" + properties + "</shape>").meshes.at(0));
        };
        const std::string flip = "<boolean name=\"flip_normals\" value=\"true\"/>";
        EXPECT_EQ(normal(""), dvec3(0, 0, 4));
        EXPECT_EQ(normal(flip), dvec3(0, 0, -4));
        EXPECT_EQ(normal(transform("<scale x=\"-1\"/>")), dvec3(0, 0, 4));
        EXPECT_EQ(normal(transform("<scale z=\"-1\"/>")), dvec3(0, 0, -4));
        EXPECT_EQ(normal(transform("<scale z=\"-1\"/>") + flip), dvec3(0, 0, 4));

        const auto cube = mitsuba_world("<shape type=\"cube\"/>").meshes.at(0);
        ASSERT_EQ(cube.surface->positions.size(), 24u);
        ASSERT_EQ(cube.surface->triangles.size(), 12u);
        double area = 0;
        for (std::size_t t = 0; t < 12; ++t) {
            const auto c = corners_of(cube, t);
            const auto n = glm::cross(c[1] - c[0], c[2] - c[0]);
            EXPECT_GT(glm::dot(n, c[0] + c[1] + c[2]), 0) << t; // outwards
            area += glm::length(n) / 2;
        }
        EXPECT_DOUBLE_EQ(area, 24);
        for (std::size_t v = 0; v < 24; ++v) {
            EXPECT_EQ(glm::abs(cube.surface->positions[v]), glm::vec3(1));
            EXPECT_EQ(glm::dot(cube.surface->positions[v], cube.surface->normals[v]), 1);
        }
        const auto inverted = mitsuba_world("<shape type=\"cube\">" + flip + "</shape>").meshes.at(0);
        const auto c = corners_of(inverted, 0);
        EXPECT_LT(glm::dot(normal_of_triangle(inverted), c[0] + c[1] + c[2]), 0);
    }

    TEST(mitsuba_file, lamps_shine_with_their_radiance_on_their_side)
    {
        const double pi = std::numbers::pi;
        const std::string light = "<emitter type=\"area\"><rgb name=\"radiance\" value=\"5, 6, 7\"/></emitter>",
                          flip = "<boolean name=\"flip_normals\" value=\"true\"/>",
                          above = transform("<scale x=\"2\"/><rotate x=\"1\" angle=\"90\"/><translate y=\"3\"/>");
        const auto with = [&](const std::string& shape, const std::string& more) {
            return mitsuba_scene(xml_ball + "<shape type=\"" + shape + "\">" + light + more + "</shape>");
        };
        const auto lit = with("rectangle", above);
        EXPECT_TRUE(lit.notes.empty());
        const auto& r = lit.scene.rectangle_lights.at(0);
        expect_near(glm::cross(r.edge_u, r.edge_v), {0, -8, 0}); // +z turned about x
        expect_near(r.power, dvec3(5, 6, 7) * (pi * 8), 1e-9);
        const auto reversed = with("rectangle", above + flip).scene.rectangle_lights.at(0);
        expect_near(glm::cross(reversed.edge_u, reversed.edge_v), {0, 8, 0});
        const auto shining = with("sphere", "<point name=\"center\" value=\"0, 9, 0\"/>").scene;
        expect_near(shining.sphere_lights.at(0).power, dvec3(5, 6, 7) * (4 * pi * pi), 1e-9);
        expect_near(shining.sphere_lights.at(0).center, {0, 9, 0});
        // A ball that shines inwards: triangles, almost as large.
        const auto inside = with("sphere", flip).scene;
        EXPECT_NEAR(inside.mesh_lights.at(0).power.x, 5 * 4 * pi * pi, 0.5);
        const auto corners = corners_of(inside.mesh_lights[0].surface, 5000);
        EXPECT_LT(glm::dot(glm::cross(corners[1] - corners[0], corners[2] - corners[0]), corners[0]), 0);
        const auto disk = with("disk", "").scene.mesh_lights.at(0);
        EXPECT_NEAR(disk.power.x, 5 * pi * pi, 0.05);
        const auto c = corners_of(disk.surface, 4);
        EXPECT_GT(glm::cross(c[1] - c[0], c[2] - c[0]).z, 0);
        // Its radiance does not depend on the unit of length.
        const auto in_mm = mitsuba_scene(xml_ball + "<shape type=\"rectangle\">" + light + "</shape>", {.unit = 0.001});
        expect_near(in_mm.scene.rectangle_lights.at(0).power, dvec3(5, 6, 7) * (pi * 4e-6), 1e-15);
        EXPECT_NEAR(in_mm.scene.spheres.at(0).radius, 0.002, 1e-15);
        // A lamp that emits nothing is a surface.
        EXPECT_EQ(mitsuba_world(xml_ball
                      + "<shape type=\"rectangle\"><emitter type=\"area\"><rgb name=\"radiance\" "
                        "value=\"0\"/></emitter></shape>")
                      .meshes.size(),
            1u);
    }

    TEST(mitsuba_file, lights_have_their_intensity)
    {
        const double pi = std::numbers::pi;
        const auto made = mitsuba_scene(xml_ball + "<emitter type=\"point\"><rgb name=\"intensity\" value=\"1 2 3\"/>"
            + transform("<translate z=\"3\"/>")
            + "</emitter><emitter type=\"spot\"><float name=\"intensity\" value=\"2\"/><float name=\"cutoff_angle\" "
              "value=\"40\"/><float name=\"beamWidth\" value=\"40\"/>"
            + transform("<lookat origin=\"0, 9, 0\" target=\"0, 0, 0\" up=\"1, 0, 0\"/>")
            + "</emitter><emitter type=\"directional\"><vector name=\"direction\" x=\"2\" y=\"-2\" z=\"0\"/><rgb "
              "name=\"irradiance\" value=\"#ff0080\"/></emitter><emitter type=\"directional\"><float "
              "name=\"irradiance\" value=\"5\"/>"
            + transform("<rotate y=\"1\" angle=\"90\"/>")
            + "</emitter><emitter type=\"constant\"><rgb name=\"radiance\" value=\"1, 0, 2\"/></emitter>");
        EXPECT_TRUE(made.notes.empty());
        const auto& s = made.scene;
        ASSERT_EQ(s.point_lights.size(), 2u);
        EXPECT_EQ(s.point_lights[0].position, dvec3(0, 0, 3));
        expect_near(s.point_lights[0].power, 4 * pi * dvec3(1, 2, 3));
        const auto& spot = s.spot_lights.at(0);
        expect_near(glm::normalize(spot.direction), {0, -1, 0});
        EXPECT_EQ(spot.inner_angle, 40);
        EXPECT_EQ(spot.outer_angle, 40);
        expect_near(spot.power, dvec3(2 * 2 * pi * (1 - std::cos(glm::radians(40.0))))); // 2 W/sr in its cone
        expect_near(s.directional_lights.at(0).direction, {2, -2, 0});
        expect_near(s.directional_lights.at(0).irradiance, {1, 0, 128 / 255.0});
        expect_near(s.directional_lights.at(1).direction, {1, 0, 0});
        expect_near(s.directional_lights.at(1).irradiance, dvec3(5));
        expect_near(s.environment_lights.at(0).radiance, {1, 0, 2});
    }

    TEST(mitsuba_file, spectra_of_lights_keep_their_luminance)
    {
        const auto radiance = [](const std::string& property) {
            return mitsuba_world(xml_ball + "<emitter type=\"constant\">" + property + "</emitter>")
                .environment_lights.at(0)
                .radiance;
        };
        const auto luminance = [](const dvec3& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; };
        expect_near(radiance("<spectrum name=\"radiance\" value=\"3\"/>"), dvec3(3));
        const auto flat = radiance("<spectrum name=\"radiance\" value=\"300:3, 900:3\"/>");
        EXPECT_NEAR(luminance(flat), 3, 0.01);
        EXPECT_GT(flat.x, flat.z); // an equal spectrum is reddish in the white of D65
        // Planck's radiance, W/(m^2 sr nm), where the eye is most sensitive, by the radiation constants of CODATA.
        const double planck
            = 1.191042972e-16 * 1e-9 / (std::pow(560e-9, 5) * (std::exp(1.438776877e-2 / (560e-9 * 5500)) - 1));
        EXPECT_NEAR(luminance(radiance("<blackbody name=\"radiance\" temperature=\"5500K\"/>")) / planck, 1, 0.03);
        EXPECT_NEAR(luminance(radiance("<spectrum name=\"radiance\" type=\"blackbody\"><float name=\"temperature\" "
                                       "value=\"5500\"/></spectrum>"))
                / planck,
            1, 0.03);
        expect_near(radiance("<blackbody name=\"radiance\" temperature=\"3000\" scale=\"2\"/>"),
            2.0 * radiance("<blackbody name=\"radiance\" temperature=\"3000\"/>"), 1e-9);
        expect_near(radiance("<spectrum name=\"radiance\" type=\"d65\"><float name=\"scale\" value=\"4\"/></spectrum>"),
            dvec3(4));
    }

    /// The material of the second ball; the first one is diffuse.
    material mitsuba_material(const std::string& bsdf, std::vector<std::string>* notes = nullptr)
    {
        const auto made = mitsuba_scene(xml_ball + "<shape type=\"rectangle\">" + bsdf + "</shape>");
        if (notes != nullptr)
            *notes = notes_of(made);
        return made.scene.materials.at(made.scene.meshes.at(0).material);
    }
    std::string ggx(const std::string& alpha)
    {
        return "<string name=\"distribution\" value=\"ggx\"/><float name=\"alpha\" value=\"" + alpha + "\"/>";
    }

    TEST(mitsuba_file, materials_become_photongrids)
    {
        struct material_case {
            std::string text;
            material_kind kind;
            dvec3 reflectance;
            double index, roughness, opacity;
        };
        const auto head_on = [](double eta, double k) { // Fresnel's reflectance of a conductor
            return std::norm((std::complex(eta, k) - 1.0) / (std::complex(eta, k) + 1.0));
        };
        const auto bsdf = [](const char* type, const std::string& inside) {
            return "<bsdf type=\"" + std::string(type) + "\">" + inside + "</bsdf>";
        };
        const std::string linear = "<boolean name=\"nonlinear\" value=\"true\"/>",
                          grey = "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\".1 .2 .3\"/></bsdf>";
        const material_case cases[] = {
            {bsdf("diffuse", ""), material_kind::lambertian, dvec3(0.5), 1.5, 0, 1},
            {grey, material_kind::lambertian, {0.1, 0.2, 0.3}, 1.5, 0, 1},
            {bsdf("diffuse", "<srgb name=\"reflectance\" value=\"#bc00ff\"/>"), material_kind::lambertian,
                {0.50288646, 0, 1}, 1.5, 0, 1},
            {bsdf("diffuse", "<spectrum name=\"reflectance\" value=\"300:0.3 800:0.3\"/>"), material_kind::lambertian,
                dvec3(0.3), 1.5, 0, 1},
            {bsdf("twosided", grey), material_kind::lambertian, {0.1, 0.2, 0.3}, 1.5, 0, 1},
            {bsdf("mask", "<float name=\"opacity\" value=\"0.25\"/>" + grey), material_kind::lambertian,
                {0.1, 0.2, 0.3}, 1.5, 0, 0.25},
            {bsdf("dielectric", ""), material_kind::glass, dvec3(1), 1.5046 / 1.000277, 0, 1},
            {bsdf("dielectric",
                 "<string name=\"int_ior\" value=\"Water\"/><float name=\"ext_ior\" value=\"1\"/><rgb "
                 "name=\"specular_transmittance\" value=\"1 .5 .25\"/>"),
                material_kind::glass, {1, 0.5, 0.25}, 1.333, 0, 1},
            {bsdf("thindielectric",
                 "<float name=\"int_ior\" value=\"1.3\"/><float name=\"ext_ior\" value=\"1\"/><rgb "
                 "name=\"specular_transmittance\" value=\"1 .5 .25\"/>"),
                material_kind::thin_glass, {1, 0.5, 0.25}, 1.3, 0, 1},
            {bsdf("roughdielectric",
                 ggx("0.0625")
                     + "<float name=\"int_ior\" value=\"1.8\"/><float name=\"ext_ior\" "
                       "value=\"1\"/>"),
                material_kind::glass, dvec3(1), 1.8, 0.25, 1},
            {bsdf("conductor", "<float name=\"eta\" value=\"0.5\"/><float name=\"k\" value=\"2\"/>"),
                material_kind::metal, dvec3(head_on(0.5, 2)), 1.5, 0, 1},
            {bsdf("roughconductor",
                 ggx("0.25")
                     + "<rgb name=\"eta\" value=\"1.6 .9 .5\"/><rgb name=\"k\" value=\"9 6 5\"/><rgb "
                       "name=\"specular_reflectance\" value=\"1 .5 1\"/>"),
                material_kind::metal, {head_on(1.6, 9), head_on(0.9, 6) / 2, head_on(0.5, 5)}, 1.5, 0.5, 1},
            {bsdf("conductor", "<string name=\"material\" value=\"none\"/>"), material_kind::metal, dvec3(1), 1.5, 0,
                1},
            {bsdf("plastic", linear + "<float name=\"int_ior\" value=\"1.7\"/><float name=\"ext_ior\" value=\"1\"/>"),
                material_kind::plastic, dvec3(0.5), 1.7, 0, 1},
        };
        for (const auto& c : cases) {
            std::vector<std::string> notes;
            const auto m = mitsuba_material(c.text, &notes);
            EXPECT_EQ(m.kind, c.kind) << c.text;
            expect_near(m.reflectance, c.reflectance, 1e-6);
            EXPECT_NEAR(m.index_of_refraction, c.index, 1e-12) << c.text;
            EXPECT_NEAR(m.roughness, c.roughness, 1e-12) << c.text;
            EXPECT_EQ(m.opacity, c.opacity) << c.text;
            EXPECT_TRUE(notes.empty()) << c.text << ": " << notes.at(0);
        }
        const auto mixed = mitsuba_world(xml_ball + "<bsdf type=\"diffuse\" id=\"a\"/><shape type=\"rectangle\">"
            + bsdf("blendbsdf",
                "<float name=\"weight\" value=\"0.75\"/><ref id=\"a\"/><bsdf type=\"conductor\" id=\"b\"/>")
            + "</shape>");
        const auto& m = mixed.materials.at(mixed.meshes.at(0).material);
        EXPECT_EQ(m.kind, material_kind::mixture);
        EXPECT_EQ(m.share, 0.75); // of the second
        EXPECT_EQ(mixed.materials.at(m.parts[0]).name, "a");
        EXPECT_EQ(mixed.materials.at(m.parts[1]).kind, material_kind::metal);
        EXPECT_EQ(mitsuba_material(
                      bsdf("blendbsdf", "<float name=\"weight\" value=\"0.25\"/>" + grey + "<bsdf type=\"null\"/>"))
                      .opacity,
            0.75);
        // Gold: its published reflectance head-on (Lide 2009) is red above green above blue.
        const auto gold = mitsuba_material(bsdf("conductor", "<string name=\"material\" value=\"Au\"/>")).reflectance;
        EXPECT_GT(gold.x, 0.9);
        EXPECT_LT(gold.z, 0.5);
        EXPECT_EQ(mitsuba_material(bsdf("principled",
                                       "<float name=\"metallic\" value=\"1\"/><rgb name=\"base_color\" "
                                       "value=\".9 .5 .1\"/><float name=\"roughness\" value=\"0.3\"/>"))
                      .roughness,
            0.3);
        EXPECT_EQ(mitsuba_material(bsdf("principled", "<float name=\"spec_trans\" value=\"1\"/>")).kind,
            material_kind::glass);
    }

    TEST(mitsuba_file, paths_are_as_deep_as_the_integrators)
    {
        const auto depth = [](const std::string& most) {
            return mitsuba_scene(xml_ball + "<integrator type=\"path\">" + most + "</integrator>")
                .scene.render.view.depth;
        };
        EXPECT_EQ(depth("<integer name=\"max_depth\" value=\"9\"/>"), 8u);
        EXPECT_EQ(depth("<integer name=\"max_depth\" value=\"-1\"/>"), view_settings().depth);
        EXPECT_EQ(depth(""), view_settings().depth);
    }

    // Mitsuba's plastic scatters base / (1 - F) below its coat, where F is what the coat throws back of diffuse light;
    // photongrid base / (1 - base F).
    TEST(mitsuba_file, plastic_keeps_the_colour_of_its_base)
    {
        // The mean of Fresnel's reflectance inside, by its integral in steps of the sine squared.
        const double index = 1.5;
        double back = 0;
        constexpr int steps = 200'000;
        for (int i = 0; i < steps; ++i) {
            const double sine2 = (i + 0.5) / steps, below = std::sqrt(1 - sine2), outside2 = 1 - index * index * sine2;
            const double above = std::sqrt(std::max(outside2, 0.0)),
                         s = (index * below - above) / (index * below + above),
                         p = (below - index * above) / (below + index * above);
            back += (outside2 > 0 ? (s * s + p * p) / 2 : 1) / steps;
        }
        const auto m = mitsuba_material("<bsdf type=\"plastic\"><rgb name=\"diffuse_reflectance\" value=\".2 .5 "
                                        "1\"/><float name=\"int_ior\" value=\"1.5\"/><float name=\"ext_ior\" "
                                        "value=\"1\"/></bsdf>");
        const dvec3 base(0.2, 0.5, 1);
        expect_near(m.reflectance / (1.0 - m.reflectance * back), base / (1 - back), 1e-3);
        // A rough coat throws another share back.
        auto rough = mitsuba_material("<bsdf type=\"roughplastic\"><rgb name=\"diffuse_reflectance\" value=\".2 .5 "
                                      "1\"/><float name=\"alpha\" value=\".5\"/></bsdf>");
        EXPECT_GT(std::abs(rough.reflectance.x - m.reflectance.x), 1e-3);
        set_reflectance_above_coat(rough);
        expect_near(rough.reflectance, base, 1e-9);
        EXPECT_EQ(mitsuba_material("<bsdf type=\"roughplastic\"><boolean name=\"nonlinear\" value=\"true\"/></bsdf>")
                      .reflectance,
            dvec3(0.5));
    }

    TEST(mitsuba_file, what_is_replaced_or_left_out_is_noted_with_its_place)
    {
        struct note_case {
            const char *text, *note;
        };
        const note_case cases[] = {
            {"<shape type=\"disk\"><bsdf type=\"hair\"/></shape>",
                "s.xml:3:20: note: bsdf \"hair\": drawn as diffuse 0.5"},
            {"<shape type=\"disk\"><float name=\"sigma\" value=\"3\"/></shape>",
                "s.xml:3:20: note: shape \"disk\": float \"sigma\" is left out"},
            {"<shape type=\"sdfgrid\"/>", "s.xml:3:1: note: shape \"sdfgrid\": is left out"},
            {"<shape type=\"sphere\"><transform name=\"to_world\"><scale x=\"2\"/></transform></shape>",
                "s.xml:3:1: note: shape \"sphere\": drawn as 16384 triangles, since it is stretched, or has a texture "
                "or an opacity, or is glass turned inside out"},
            {"<emitter type=\"sunsky\"/>", "s.xml:3:1: note: emitter \"sunsky\": is left out"},
            {"<emitter type=\"spot\"/>",
                "s.xml:3:1: note: emitter \"spot\": its edge falls off smoothly in the cosine, not evenly in the "
                "angle"},
            {"<shape type=\"rectangle\"><bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"bitmap\"><string "
             "name=\"filename\" value=\"no.png\"/></texture></bsdf></shape>",
                "s.xml:3:88: note: 0.5 in the place of a texture: no.png: cannot be read: No such file or directory"},
            {"<shape type=\"rectangle\"><bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"wood\"/></bsdf>"
             "</shape>",
                "s.xml:3:46: note: texture \"wood\": drawn as 0.5 everywhere"},
            {"<shape type=\"disk\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"2, 1, 1\"/></bsdf></shape>",
                "s.xml:3:20: note: bsdf \"diffuse\": reflectance is limited to 0 to 1"},
            {"<shape type=\"rectangle\"><emitter type=\"area\"/><bsdf type=\"diffuse\"/></shape>",
                "s.xml:3:1: note: the surface of a lamp: black; its bsdf is left out"},
            {"<shape type=\"disk\"><bsdf type=\"roughconductor\"/></shape>",
                "s.xml:3:20: note: bsdf \"roughconductor\": facets by \"beckmann\": drawn as \"ggx\""},
            {"<shape type=\"disk\"><bsdf type=\"bumpmap\"><bsdf type=\"diffuse\"/><texture type=\"bitmap\"/></bsdf>"
             "</shape>",
                "s.xml:3:20: note: bsdf \"bumpmap\": the bsdf inside is drawn without it"},
            {"<shape type=\"disk\"><bsdf type=\"null\"/></shape>",
                "s.xml:3:20: note: bsdf \"null\": its surfaces are left out"},
            {"<shape type=\"disk\"><medium name=\"interior\" type=\"homogeneous\"/></shape>",
                "s.xml:3:20: note: medium \"homogeneous\": absorbs light, but does not scatter it"},
            {"<shape type=\"disk\"><medium name=\"exterior\" type=\"homogeneous\"/></shape>",
                "s.xml:3:1: note: the media of shapes are left out but for those inside that are homogeneous"},
            {"<shape type=\"disk\"><bsdf type=\"plastic\"><float name=\"ext_ior\" value=\"1.33\"/></bsdf></shape>",
                "s.xml:3:20: note: bsdf \"plastic\": the outside has no air: the index is that of both sides' ratio"},
            {"<sensor type=\"thinlens\"/>", "s.xml:3:1: note: a second sensor is left out"},
            {"<path value=\"x\"/>", "s.xml:3:1: note: <path>: files are sought in the scene's folder alone"},
            {"<float name=\"x\" value=\"1\"/>", "s.xml:3:1: note: scene: float \"x\" is left out"},
        };
        for (const auto& c : cases) {
            const auto all = xml_scene("<sensor type=\"perspective\"/>\n" + std::string(c.text) + xml_ball + xml_lamp);
            const auto notes = notes_of(parse_mitsuba("s.xml", all));
            EXPECT_TRUE(std::find(notes.begin(), notes.end(), c.note) != notes.end())
                << c.note << "\n"
                << (notes.empty() ? "(none)" : notes[0]);
            EXPECT_NE(refusal_by([&] { return parse_mitsuba("s.xml", all, {.strict = true}); }), "") << c.text;
        }
        EXPECT_TRUE(mitsuba_scene(xml_ball, {.strict = true}).notes.empty());
        const auto bare = notes_of(parse_mitsuba("s.xml", xml_scene(xml_ball), {.strict = true}));
        ASSERT_EQ(bare.size(), 2u);
        EXPECT_EQ(bare[0], "s.xml: note: the file has no light; a sky with a soft bright patch is added");
    }

    TEST(mitsuba_file, media_inside_of_shapes_absorb)
    {
        const std::string ink = "<medium name=\"interior\" type=\"homogeneous\"><rgb name=\"sigma_t\" value=\"1,2,4\"/>"
                                "<rgb name=\"albedo\" value=\"0\"/><float name=\"scale\" value=\"0.5\"/></medium>";
        for (const auto* bsdf : {"dielectric", "null"}) {
            const auto ball = "<shape type=\"sphere\">" + ink + "<bsdf type=\"" + bsdf + "\"/></shape>";
            const auto s = mitsuba_scene(ball, {.unit = 0.01}).scene;
            const auto& m = s.materials.at(s.spheres.at(0).material);
            expect_near(m.absorption, {50, 100, 200});
            EXPECT_EQ(m.kind, material_kind::glass);
            EXPECT_EQ(m.index_of_refraction == 1, bsdf == std::string("null"));
        }
    }

    TEST(mitsuba_file, refuses_with_the_place)
    {
        struct refusal_case {
            std::string text;
            const char* said; ///< behind "s.xml:"
        };
        std::string deep, end;
        for (int i = 0; i < 70; ++i) {
            deep += "<bsdf type=\"twosided\">";
            end += "</bsdf>";
        }
        const refusal_case cases[] = {
            {"<shpe type=\"sphere\"/>", "2:1: error: found <shpe>; expected an element of Mitsuba, perhaps <shape>"},
            {"<shape tpe=\"sphere\"/>", "2:1: error: <shape> has no attribute \"tpe\", perhaps \"type\""},
            {"<shape/>", "2:1: error: <shape> lacks the attribute \"type\""},
            {"<shape type=\"sphere\">\n  <float name=\"radius\" value=\"1e999\"/></shape>",
                "3:3: error: found \"1e999\"; expected a number"},
            {"<shape type=\"sphere\"><float name=\"radius\" value=\"nan\"/></shape>",
                "2:22: error: found \"nan\"; expected a number"},
            {"<shape type=\"sphere\"><float name=\"radius\" value=\"1 2\"/></shape>",
                "2:22: error: found \"1 2\"; expected one number"},
            {"<shape type=\"sphere\"><string name=\"radius\" value=\"1\"/></shape>",
                "2:22: error: found string \"radius\"; expected a float"},
            {"<shape type=\"sphere\"><float name=\"radius\" value=\"-1\"/></shape>",
                "2:1: error: shape \"sphere\" has no extent: its radius is not above 0"},
            {"<shape type=\"sphere\"><float name=\"radius\" value=\"1\"/><float name=\"radius\" value=\"1\"/></shape>",
                "2:54: error: shape \"sphere\" has \"radius\" twice"},
            {"<shape type=\"sphere\"><ref id=\"x\"/></shape>", "2:22: error: nothing has the id \"x\""},
            {"<bsdf type=\"diffuse\" id=\"wall\"/><shape type=\"sphere\"><ref id=\"wal\"/></shape>",
                "2:54: error: nothing has the id \"wal\", perhaps \"wall\""},
            {"<bsdf type=\"diffuse\" id=\"a\"/>\n<bsdf type=\"diffuse\" id=\"a\"/>",
                "3:1: error: the id \"a\" is defined twice, in line 2 too"},
            {"<shape type=\"sphere\"><float name=\"radius\" value=\"$r\"/></shape>",
                "2:22: error: the parameter \"r\" is not defined; expected a <default> of it before this"},
            {"<default name=\"a\" value=\"0123456789012345678901234567890123456789\"/><default name=\"b\" "
             "value=\"$a$a$a$a$a$a$a$a$a$a\"/><default name=\"c\" value=\"$b$b$b\"/>",
                "2:117: error: a value has more than 1,000 bytes with what its parameters stand for"},
            {"<shape type=\"sphere\">text</shape>", "2:22: error: found the text \"text\"; expected an element"},
            {"<shape type=\"sphere\"><float name=\"radius\" value=\"1\">2</float></shape>",
                "2:53: error: found the text \"2\"; expected an element"},
            {"<bsdf type=\"diffuse\" id=\"a\"/><ref id=\"a\"><float name=\"x\" value=\"1\"/></ref>",
                "2:42: error: found <float> within <ref>; expected its end"},
            {"<shape type=\"sphere\">", "3:3: error: this is no XML: Start-end tags mismatch"},
            {deep + end, "2:1387: error: elements are nested more than 64 deep"},
            {"<bsdf type=\"twosided\" id=\"a\"><ref id=\"a\"/></bsdf><shape type=\"disk\"><ref id=\"a\"/></shape>",
                "2:1: error: bsdf \"twosided\" is made of itself, or of more than 16 within each other"},
            {"<texture type=\"scale\" id=\"t\"><ref id=\"t\"/></texture><shape type=\"disk\"><bsdf "
             "type=\"diffuse\"><ref "
             "name=\"reflectance\" id=\"t\"/></bsdf></shape>",
                "2:30: error: the texture is made of itself, or of more than 100 within each other"},
            {"<shape type=\"instance\" id=\"i\"><ref id=\"i\"/></shape>",
                "2:1: error: found the shape \"instance\" within another one; Mitsuba has none there"},
            {"<shape type=\"disk\"><transform name=\"to_world\"><rotat/></transform></shape>",
                "2:47: error: found <rotat>; expected translate, scale, rotate, lookat or matrix, perhaps <rotate>"},
            {"<shape type=\"disk\"><transform name=\"to_world\"><lookat origin=\"1,1,1\" "
             "target=\"1,1,1\"/></transform></shape>",
                "2:47: error: the origin and the target of <lookat> are the same point"},
            {"<shape type=\"disk\"><transform name=\"to_world\"><matrix value=\"1 2 3\"/></transform></shape>",
                "2:47: error: found a matrix of 3 numbers; expected 16, or 9 without a translation"},
            {"<shape type=\"rectangle\"><transform name=\"to_world\"><scale x=\"0\"/></transform></shape>",
                " error: the scene has no shape that can be drawn"},
            {"<shape type=\"disk\"><bsdf type=\"diffuse\"><spectrum name=\"reflectance\" value=\"500:1 "
             "400:1\"/></bsdf></shape>",
                "2:41: error: the wavelengths of a spectrum do not ascend"},
            {"<shape type=\"disk\"><bsdf type=\"dielectric\"><string name=\"int_ior\" value=\"jelly\"/></bsdf></shape>",
                "2:44: error: found \"jelly\"; expected the name of a matter that Mitsuba knows, such as \"bk7\" or "
                "\"water\""},
            {"<shape type=\"ply\"/>", "2:1: error: shape \"ply\" lacks \"filename\""},
            {"<shape type=\"ply\"><string name=\"filename\" value=\"no.ply\"/></shape>",
                "2:19: error: no.ply: cannot be read: No such file or directory"},
            {"<shape type=\"ply\"><string name=\"filename\" value=\"/etc/passwd\"/></shape>",
                "2:19: error: /etc/passwd: lies outside of the scene's folder; --allow-outside lets scenes name such "
                "files"},
            {"<include filename=\"../x.xml\"/>",
                "2:1: error: ../x.xml: lies outside of the scene's folder; --allow-outside lets scenes name such "
                "files"},
            {"<sensor type=\"perspective\"><string name=\"fov_axis\" value=\"z\"/><float name=\"fov\" "
             "value=\"9\"/></sensor>",
                "2:1: error: found the fov_axis \"z\"; expected x, y, diagonal, smaller or larger"},
            {"<sensor type=\"perspective\"><string name=\"focal_length\" value=\"long\"/></sensor>",
                "2:28: error: found a focal_length that is not one number of mm above 0, as 50mm"},
        };
        for (const auto& c : cases)
            EXPECT_EQ(refusal_by([&] { return parse_mitsuba("s.xml", xml_scene(c.text + "\n")); }),
                std::string("s.xml:") + c.said)
                << c.text;
        const auto whole
            = [](std::string_view text) { return refusal_by([&] { return parse_mitsuba("s.xml", text); }); };
        EXPECT_EQ(whole(xml_scene("")), "s.xml: error: the scene has no shape that can be drawn");
        EXPECT_EQ(whole("<bsdf type=\"diffuse\"/>"), "s.xml:1:1: error: found <bsdf>; expected <scene>");
        EXPECT_EQ(whole("<scene/>"), "s.xml:1:1: error: <scene> lacks a version, such as \"3.0.0\"");
        EXPECT_EQ(whole("<scene version=\"3.0.0\"/>\n<scene version=\"3.0.0\"/>"),
            "s.xml:2:1: error: found <scene> behind the end of <scene>");
        EXPECT_EQ(whole(std::string_view("<scene>\n \0</scene>", 18)),
            "s.xml:2:2: error: found a zero byte; expected XML in UTF-8");
        EXPECT_THROW(parse_mitsuba("s.xml", "", {.unit = 0.0}), std::invalid_argument);
    }

} // namespace
} // namespace photongrid

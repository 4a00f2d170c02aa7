// Every number of a scene, made bad one at a time: the scene is refused, and the message names the part. Every check of
// the headers is provoked. And every setting just outside of its range.
#include "limit_tests.hpp"
#include "test_scenes.hpp"

#include <photongrid/scene/setting_table.hpp>
#include <photongrid/trace/device_scene.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <regex>
#include <string>
#include <vector>

namespace photongrid::testing {
namespace {

    constexpr double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();

    /// A number of a scene, and how to find it in a copy.
    struct number {
        std::string part; ///< "spheres[1]"
        std::string name; ///< "center", as the message should have it
        std::function<double&(scene&)> in;
        quantity of = quantity::point;
    };

    void add_numbers(std::vector<number>& all, const std::string& part, const char* name, quantity of, const dvec3&,
        const std::function<dvec3&(scene&)>& in)
    {
        for (int c = 0; c < 3; ++c)
            all.push_back({part, name, [in, c](scene& s) -> double& { return in(s)[c]; }, of});
    }
    void add_numbers(std::vector<number>& all, const std::string& part, const char* name, quantity of, double,
        const std::function<double&(scene&)>& in)
    {
        all.push_back({part, name, in, of});
    }
    void add_numbers(std::vector<number>& all, const std::string& part, const char* name, quantity of,
        const std::vector<dvec3>& points, const std::function<std::vector<dvec3>&(scene&)>& in)
    {
        for (std::size_t i = 0; i < points.size(); ++i)
            for (int c = 0; c < 3; ++c)
                all.push_back({part, name, [in, i, c](scene& s) -> double& { return in(s)[i][c]; }, of});
    }

    template <class List>
    void add_parts(std::vector<number>& all, List& list, const auto& kind, const auto& find)
    {
        for (std::size_t i = 0; i < list.size(); ++i)
            for_each_field(kind.fields, [&](const auto& f) {
                using value = std::remove_cvref_t<decltype(list[i].*f.member)>;
                add_numbers(all, std::string(kind.list) + "[" + std::to_string(i) + "]", f.name, f.of,
                    list[i].*f.member,
                    std::function<value&(scene&)>([find, i, f](scene& of) -> value& { return find(of)[i].*f.member; }));
            });
    }

    /// Every number of shapes and lights.
    std::vector<number> numbers_of(scene& s)
    {
        std::vector<number> all;
        for_each_shape(s, [&]<class List>(List& list, auto kind) {
            add_parts(all, list, kind, [](scene& of) -> List& { return std::get<List&>(shape_lists(of)); });
        });
        for_each_light(s, [&]<class List>(List& list, auto kind) {
            add_parts(all, list, kind, [](scene& of) -> List& { return std::get<List&>(light_lists(of)); });
        });
        return all;
    }

    /// What a check says of a scene, or of settings; empty if nothing.
    template <class T>
    std::string refusal_of(const T& s, void (*checked)(const T&) = check)
    {
        try {
            checked(s);
            return {};
        } catch (const std::invalid_argument& e) {
            return e.what();
        }
    }

    void expect_refused(const scene& good, const number& n, double bad)
    {
        auto s = good;
        n.in(s) = bad;
        const auto said = refusal_of(s);
        EXPECT_NE(said, "") << n.part << "." << n.name << " = " << bad;
        EXPECT_NE(said.find(n.part), std::string::npos) << said;
        EXPECT_THROW(lay_out(s), std::invalid_argument);
    }

    TEST(bad_scenes, no_number_may_be_nan_or_infinite)
    {
        auto s = all_lights();
        ASSERT_EQ(refusal_of(s), "");
        const auto numbers = numbers_of(s);
        EXPECT_GE(numbers.size(), 100u);
        for (const auto& n : numbers)
            for (const double bad : {nan, infinity, -infinity})
                expect_refused(s, n, bad);
    }

    TEST(bad_scenes, lengths_are_positive_and_powers_not_negative)
    {
        auto s = all_lights();
        int lengths = 0, powers = 0, emissions = 0, angles = 0;
        for (const auto& n : numbers_of(s)) {
            if (n.of == quantity::length) {
                ++lengths;
                for (const double bad : {0.0, -0.0, -1.0, -1e-300})
                    expect_refused(s, n, bad);
            } else if (n.of == quantity::power) {
                ++powers;
                expect_refused(s, n, -1e-300);
                expect_refused(s, n, -1.0);
            } else if (n.of == quantity::emission) {
                ++emissions;
                expect_refused(s, n, -1e-300);
            } else if (n.of == quantity::angle) {
                ++angles;
                expect_refused(s, n, -1e-300);
                expect_refused(s, n, 180.0001);
            }
        }
        EXPECT_GE(lengths, 7);
        EXPECT_EQ(powers, 15);
        EXPECT_EQ(emissions, 6);
        EXPECT_EQ(angles, 2);
    }

    /// The first mesh's surface, to be changed.
    mesh& spoil_mesh(scene& s)
    {
        auto copy = std::make_shared<mesh>(*s.meshes[0].surface);
        s.meshes[0].surface = copy;
        return *copy;
    }

    void spoil_map(scene& s, environment_map m)
    {
        s.environment_lights[0].map = std::make_shared<const environment_map>(std::move(m));
    }

    material mixed(std::uint32_t first, std::uint32_t second)
    {
        material m{"mixture", material_kind::mixture};
        m.parts = {first, second};
        return m;
    }

    /// A change that makes a scene bad, and what the message says.
    struct spoiled {
        const char* what;
        std::function<void(scene&)> spoil;
        const char* part; ///< which the message begins with
    };
    std::vector<spoiled> spoiled_scenes()
    {
        return {
            {"lamp without area", [](scene& x) { x.rectangle_lights[0].edge_u = dvec3(0); }, "rectangle_lights[0]"},
            {"lamp with one direction", [](scene& x) { x.rectangle_lights[0].edge_v = x.rectangle_lights[0].edge_u; },
                "rectangle_lights[0]"},
            {"skew lamp", [](scene& x) { x.rectangle_lights[0].edge_v.x += 0.01; }, "rectangle_lights[0]"},
            {"dark lamp", [](scene& x) { x.rectangle_lights[0].power = dvec3(0); }, "rectangle_lights[0]"},
            {"dark bulb", [](scene& x) { x.point_lights[0].power = dvec3(0); }, "point_lights[0]"},
            {"no light",
                [](scene& x) {
                    x.point_lights.clear();
                    x.rectangle_lights.clear();
                    x.mesh_lights.clear();
                    x.sphere_lights.clear();
                    x.spot_lights.clear();
                    x.directional_lights.clear();
                    x.environment_lights.clear();
                },
                "lights:"},
            {"texture on a sphere", [](scene& x) { x.materials[5].texture.map = std::make_shared<const texture>(); },
                "spheres[1].material"},
            {"texture without coordinates",
                [](scene& x) {
                    x.materials.push_back(x.materials[0]);
                    x.materials.back().texture.map = std::make_shared<const texture>();
                    x.meshes[1].material = static_cast<std::uint32_t>(x.materials.size() - 1);
                },
                "meshes[1].material"},
            {"clear sphere", [](scene& x) { x.materials[5].opacity = 0.5; }, "spheres[1].material"},
            {"opacity above 1", [](scene& x) { x.materials[0].opacity = 1.5; }, "materials[0].opacity"},
            {"share that is no number",
                [](scene& x) {
                    x.materials[0].kind = material_kind::mixture;
                    x.materials[0].parts = {1, 2};
                    x.materials[0].share = nan;
                },
                "materials[0].share"},
            {"texture of a roughness that there is none",
                [](scene& x) { x.materials[0].roughness_texture.map = std::make_shared<const texture>(); },
                "materials[0].roughness_texture"},
            {"texture of no channel",
                [](scene& x) {
                    x.materials[0].opacity_texture.map = std::make_shared<const texture>();
                    x.materials[0].opacity_texture.channel = static_cast<texture_channel>(4);
                },
                "materials[0].texture"},
            {"texture of a mixture",
                [](scene& x) {
                    x.materials[0].kind = material_kind::mixture;
                    x.materials[0].parts = {1, 2};
                    x.materials[0].texture.map = std::make_shared<const texture>();
                },
                "materials[0].texture"},
            {"mixture of nothing", [](scene& x) { x.materials.push_back(mixed(0, 1000)); }, "materials["},
            {"mixture of a mixture",
                [](scene& x) {
                    x.materials.push_back(mixed(0, 1));
                    x.materials.push_back(mixed(0, static_cast<std::uint32_t>(x.materials.size() - 1)));
                },
                "materials["},
            {"mixture of what is clear",
                [](scene& x) {
                    x.materials.push_back({"thin", material_kind::mirror});
                    x.materials.back().opacity = 0.5;
                    x.materials.push_back(mixed(0, static_cast<std::uint32_t>(x.materials.size() - 1)));
                },
                "materials["},
            {"mixture of two that store photons, one below a coat",
                [](scene& x) {
                    x.materials.push_back({"toy", material_kind::plastic});
                    x.materials.push_back(mixed(0, static_cast<std::uint32_t>(x.materials.size() - 1)));
                },
                "materials["},
            {"texture with too few texels",
                [](scene& x) {
                    x.materials[0].texture.map = std::make_shared<const texture>(texture{2, 1});
                },
                "materials[0].texture"},
            {"texture of too many texels",
                [](scene& x) {
                    texture t{65537, 1};
                    t.texels.resize(65537);
                    x.materials[0].texture.map = std::make_shared<const texture>(std::move(t));
                },
                "materials[0].texture"},
            {"texture moved nowhere",
                [](scene& x) {
                    x.materials[0].texture.map = std::make_shared<const texture>();
                    x.materials[0].texture.offset.y = nan;
                },
                "materials[0].texture"},
            {"mesh with too few colors", [](scene& x) { spoil_mesh(x).colors = {glm::vec3(1)}; },
                "meshes[0].mesh: colors"},
            {"mesh with a color above 1",
                [](scene& x) {
                    auto& m = spoil_mesh(x);
                    m.colors.assign(m.positions.size(), glm::vec3(1, 1.5f, 1));
                },
                "meshes[0].mesh: colors[0]"},
            {"mesh with a texture coordinate nowhere",
                [](scene& x) {
                    auto& m = spoil_mesh(x);
                    m.texture_coordinates.assign(m.positions.size(), {0, static_cast<float>(nan)});
                },
                "meshes[0].mesh: texture_coordinates[0]"},
            {"two skies", [](scene& x) { x.environment_lights.push_back(x.environment_lights[0]); },
                "environment_lights:"},
            {"spotlight without an axis", [](scene& x) { x.spot_lights[0].direction = dvec3(0); },
                "spot_lights[0].direction"},
            {"spotlight inside out", [](scene& x) { x.spot_lights[0].inner_angle = 36; }, "spot_lights[0].inner_angle"},
            {"spotlight of no width",
                [](scene& x) { x.spot_lights[0].inner_angle = x.spot_lights[0].outer_angle = 0.009; },
                "spot_lights[0].outer_angle"},
            {"sun without a direction", [](scene& x) { x.directional_lights[0].direction = dvec3(0); },
                "directional_lights[0].direction"},
            {"dark sun", [](scene& x) { x.directional_lights[0].irradiance = dvec3(0); },
                "directional_lights[0].irradiance"},
            {"dark sky", [](scene& x) { x.environment_lights[0].radiance = dvec3(0); },
                "environment_lights[0].radiance"},
            {"sky without an axis", [](scene& x) { x.environment_lights[0].axis = dvec3(0); },
                "environment_lights[0].axis"},
            {"sky turned nowhere", [](scene& x) { x.environment_lights[0].degrees = nan; },
                "environment_lights[0].degrees"},
            {"sky with too few texels",
                [](scene& x) {
                    spoil_map(x, {2, 1, {glm::vec3(1)}});
                },
                "environment_lights[0].map"},
            {"sky of nothing",
                [](scene& x) {
                    spoil_map(x, {0, 0, {}});
                },
                "environment_lights[0].map"},
            {"sky of too many texels",
                [](scene& x) {
                    spoil_map(x, {1u << 13, 1u << 13, {glm::vec3(1)}});
                },
                "environment_lights[0].map"},
            {"sky that is not finite",
                [](scene& x) {
                    spoil_map(x, {1, 1, {{1, static_cast<float>(infinity), 1}}});
                },
                "environment_lights[0].map"},
            {"sky below 0",
                [](scene& x) {
                    spoil_map(x, {1, 1, {{1, 1, -1}}});
                },
                "environment_lights[0].map"},
            {"black sky",
                [](scene& x) {
                    spoil_map(x, {1, 1, {glm::vec3(0)}});
                },
                "environment_lights[0].map"},
            {"disk without a normal", [](scene& x) { x.disks[0].normal = dvec3(0); }, "disks[0]"},
            {"polygon of two corners", [](scene& x) { x.polygons[1].vertices.pop_back(); }, "polygons[1]"},
            {"polygon that is not flat", [](scene& x) { x.polygons[0].vertices[2].y += 0.5; }, "polygons[0]"},
            {"polygon without area",
                [](scene& x) {
                    x.polygons[1].vertices = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
                },
                "polygons[1]"},
            {"polygon with a dent",
                [](scene& x) {
                    x.polygons[0].vertices[2] = {-1, 0, -1};
                },
                "polygons[0]"},
            {"five-pointed star",
                [](scene& x) {
                    x.polygons[1].vertices.clear();
                    for (int i = 0; i < 5; ++i)
                        x.polygons[1].vertices.emplace_back(std::cos(0.8 * M_PI * i), 0, std::sin(0.8 * M_PI * i));
                },
                "polygons[1].vertices"},
            {"material that is not there", [](scene& x) { x.cones[0].material = 99; }, "cones[0].material"},
            {"material of no kind",
                [](scene& x) { x.materials[1].kind = static_cast<material_kind>(material_kinds.size()); },
                "materials[1].kind"},
            {"material of a negative kind", [](scene& x) { x.materials[1].kind = static_cast<material_kind>(-1); },
                "materials[1].kind"},
            {"reflectance", [](scene& x) { x.materials[1].reflectance.y = 2; }, "materials[1].reflectance"},
            {"index of refraction", [](scene& x) { x.materials[2].index_of_refraction = 0.05; },
                "materials[2].index_of_refraction"},
            {"roughness", [](scene& x) { x.materials[1].roughness = 1.5; }, "materials[1].roughness"},
            {"energy", [](scene& x) { x.materials[1].energy = static_cast<facet_bounces>(2); }, "materials[1].energy"},
            {"no axis", [](scene& x) { x.cylinders[0].top = x.cylinders[0].base; }, "cylinders[0].base and top"},
            {"no axis", [](scene& x) { x.cones[0].apex = x.cones[0].base; }, "cones[0].base and apex"},
            {"no axis", [](scene& x) { x.paraboloids[0].rim = x.paraboloids[0].vertex; },
                "paraboloids[0].vertex and rim"},
            {"flat box", [](scene& x) { x.boxes[0].edge_w = dvec3(0); }, "boxes[0]"},
            {"skew box", [](scene& x) { x.boxes[0].edge_w = x.boxes[0].edge_u; }, "boxes[0]"},
            {"glass in glass",
                [](scene& x) {
                    x.spheres[1] = x.spheres[0];
                    x.spheres[1].center.x += 0.1;
                },
                "spheres[1]"},
            {"mesh of nothing", [](scene& x) { x.meshes[0].surface = nullptr; }, "meshes[0].surface"},
            {"mesh without triangles", [](scene& x) { x.meshes[0].surface = std::make_shared<const mesh>(); },
                "meshes[0].triangles"},
            {"mesh with an index beyond its vertices",
                [](scene& x) {
                    x.meshes[1].surface = std::make_shared<const mesh>(mesh{{{0, 0, 0}}, {{0, 0, 1}}});
                },
                "meshes[1].mesh: triangles[0]"},
            {"mesh with a vertex nowhere",
                [](scene& x) {
                    x.meshes[1].surface
                        = std::make_shared<const mesh>(mesh{{{0, static_cast<float>(nan), 0}}, {{0, 0, 0}}});
                },
                "meshes[1].mesh: positions[0]"},
            {"mesh with too few normals",
                [](scene& x) {
                    auto m = *x.meshes[0].surface;
                    m.normals = {{0, 1, 0}};
                    x.meshes[0].surface = std::make_shared<const mesh>(m);
                },
                "meshes[0].mesh: normals: there are 1"},
            {"mesh with a normal that is none",
                [](scene& x) {
                    auto m = *x.meshes[0].surface;
                    m.normals.assign(m.positions.size(), {0, 1, static_cast<float>(infinity)});
                    x.meshes[0].surface = std::make_shared<const mesh>(m);
                },
                "meshes[0].mesh: normals[0]"},
            {"mesh far from anywhere",
                [](scene& x) {
                    auto m = *x.meshes[0].surface;
                    m.origin.y = nan;
                    x.meshes[0].surface = std::make_shared<const mesh>(m);
                },
                "meshes[0].mesh: origin"},
            {"mesh nowhere", [](scene& x) { x.meshes[2].offset.y = infinity; }, "meshes[2].matrix"},
            {"mesh scaled by 0", [](scene& x) { x.meshes[2].linear[1] = dvec3(0); }, "meshes[2].matrix"},
            {"light of no mesh", [](scene& x) { x.mesh_lights[0].surface.surface = nullptr; },
                "mesh_lights[0].surface"},
            {"light without area",
                [](scene& x) {
                    x.mesh_lights[0].surface.surface
                        = std::make_shared<const mesh>(mesh{{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 1}}});
                },
                "mesh_lights[0].triangles"},
            {"dark mesh", [](scene& x) { x.mesh_lights[0].power = dvec3(0); }, "mesh_lights[0].power"},
            {"light nowhere", [](scene& x) { x.mesh_lights[0].surface.offset.z = nan; }, "mesh_lights[0].matrix"},
            {"mesh of no material", [](scene& x) { x.meshes[0].material = 99; }, "meshes[0].material"},
            {"camera nowhere", [](scene& x) { x.camera.position.x = nan; }, "position"},
            {"camera at its target", [](scene& x) { x.camera.look_at = x.camera.position; }, "position and look_at"},
            {"camera without an up", [](scene& x) { x.camera.up = dvec3(0); }, "up"},
            {"up along the view", [](scene& x) { x.camera.up = x.camera.look_at - x.camera.position; }, "up"},
            {"up against the view", [](scene& x) { x.camera.up = 3.0 * (x.camera.position - x.camera.look_at); }, "up"},
            {"field of view", [](scene& x) { x.camera.vertical_fov = 179; }, "vertical_fov"},
            {"no photons", [](scene& x) { x.render.map.photons = 0; }, "photons"},
            {"no radius", [](scene& x) { x.render.estimate.max_radius = 0; }, "max_radius"},
            {"builder", [](scene& x) { x.render.map.builder = static_cast<map_builder>(9); }, "map"},
            {"pixel filter", [](scene& x) { x.render.view.filter = static_cast<pixel_filter>(9); }, "pixel_filter"},
            {"one axis without cells",
                [](scene& x) {
                    x.render.map.grid = {0, 1, 1};
                },
                "grid"},
            {"axis of too many cells",
                [](scene& x) {
                    x.render.map.grid = {(1u << 20) + 1, 1, 1};
                },
                "grid"},
            {"too many cells",
                [](scene& x) {
                    x.render.map.grid = {1u << 20, 1u << 20, 1};
                },
                "grid"},
            {"no pixels", [](scene& x) { x.render.output.width = 0; }, "size"},
            {"exposure", [](scene& x) { x.render.output.exposure = 65; }, "exposure"},
            {"edge correction alone",
                [](scene& x) {
                    x.render.estimate.edges = edge_correction::polygons;
                    x.render.estimate.leaks = {};
                },
                "edge_correction"},
            {"settings for the paper's method", [](scene& x) { x.paper.emplace().view.spp = 0; }, "paper: spp"},
        };
    }

    TEST(bad_scenes, radiance_that_single_precision_cannot_hold_is_refused)
    {
        auto s = all_lights();
        spoil_map(s, {2, 1, {glm::vec3(1), glm::vec3(1e30f)}});
        EXPECT_NO_THROW(lay_out(s));
        s.environment_lights[0].radiance = dvec3(1e12);
        EXPECT_EQ(refusal_of(s), "");
        EXPECT_THROW(lay_out(s), std::invalid_argument);
    }

    TEST(bad_scenes, spoiled_ones_are_refused)
    {
        const auto good = all_lights();
        ASSERT_EQ(refusal_of(good), "");
        for (const auto& each : spoiled_scenes()) {
            auto bad = good;
            each.spoil(bad);
            const auto said = refusal_of(bad);
            EXPECT_EQ(said.find(each.part), 0u) << each.what << ": " << said;
        }
    }

    /// The text of each check in a header: the longest literal of each call of require, and of each throw.
    std::vector<std::string> checks_in(const std::string& header)
    {
        static const std::regex check(R"x((\brequire\(|throw std::invalid_argument\()("[^"]*"|[^";])*;)x"),
            literal(R"x("([^"]*)")x");
        std::vector<std::string> all;
        for (std::sregex_iterator i(header.begin(), header.end(), check), none; i != none; ++i) {
            const std::string call = i->str();
            std::string longest;
            for (std::sregex_iterator l(call.begin(), call.end(), literal); l != none; ++l)
                if (const auto text = (*l)[1].str(); text.size() > longest.size())
                    longest = text;
            if (longest.size() > 2) // else it passes a message on
                all.push_back(longest);
        }
        return all;
    }

    TEST(bad_scenes, every_check_of_the_headers_refuses_one)
    {
        const auto good = all_lights();
        std::string said;
        for (const auto& each : spoiled_scenes()) {
            auto bad = good;
            each.spoil(bad);
            said += refusal_of(bad) + '\n';
        }
        auto numbered = good;
        for (const auto& n : numbers_of(numbered))
            for (const double bad : {nan, -1.0}) {
                auto s = good;
                n.in(s) = bad;
                said += refusal_of(s) + '\n';
            }
        said += refusal_of(automatic_settings(), check_numbers);
        std::size_t checks = 0;
        for (const auto& file :
            std::filesystem::directory_iterator(PHOTONGRID_SCENES "/../../include/photongrid/scene")) {
            std::ifstream in(file.path());
            for (const auto& text : checks_in({std::istreambuf_iterator<char>(in), {}})) {
                ++checks;
                EXPECT_NE(said.find(text), std::string::npos)
                    << file.path().filename() << ": no scene is refused with \"" << text << "\"";
            }
        }
        EXPECT_GE(checks, 35u);
    }

    TEST(bad_scenes, materials_and_cameras_are_checked)
    {
        const auto good = all_shapes();
        const auto refused = [&](const char* part, const std::function<double&(scene&)>& number, double bad) {
            auto s = good;
            number(s) = bad;
            const auto said = refusal_of(s);
            EXPECT_NE(said.find(part), std::string::npos) << bad << ": " << said;
        };
        for (std::size_t m = 0; m < good.materials.size(); ++m)
            for (int c = 0; c < 3; ++c)
                for (const double bad : {nan, infinity, -infinity, -1e-300, 1 + 1e-15})
                    refused(("materials[" + std::to_string(m) + "].reflectance").c_str(),
                        [m, c](scene& s) -> double& { return s.materials[m].reflectance[c]; }, bad);
        for (const double bad : {nan, infinity, -infinity, 0.0, 0.1 - 1e-15, 10 + 1e-14})
            refused(
                "materials[2].index_of_refraction",
                [](scene& s) -> double& { return s.materials[2].index_of_refraction; }, bad);
        for (const std::size_t m : {1u, 2u})
            for (const double bad : {nan, infinity, -infinity, -1e-300, 1 + 1e-15})
                refused(("materials[" + std::to_string(m) + "].roughness").c_str(),
                    [m](scene& s) -> double& { return s.materials[m].roughness; }, bad);
        for (int c = 0; c < 3; ++c)
            for (const double bad : {nan, infinity, -infinity}) {
                refused(
                    "position", [c](scene& s) -> double& { return s.camera.position[c]; }, bad);
                refused(
                    "look_at", [c](scene& s) -> double& { return s.camera.look_at[c]; }, bad);
                refused(
                    "up", [c](scene& s) -> double& { return s.camera.up[c]; }, bad);
            }
        for (const double bad : {nan, infinity, -infinity, 0.0, -1.0, 179.0})
            refused(
                "vertical_fov", [](scene& s) -> double& { return s.camera.vertical_fov; }, bad);
    }

    // Settings: the ends of each range serve, and what lies beyond them is refused by the setting's name.

    void expect_setting(const auto& row, const auto& change, bool good)
    {
        render_settings s;
        change(row.of(s));
        std::string said;
        try {
            check(s);
        } catch (const std::invalid_argument& e) {
            said = e.what();
        }
        if (good)
            EXPECT_EQ(said, "") << row.name;
        else
            EXPECT_EQ(said.find(std::string(row.name) + ":"), 0u) << row.name << " is accepted, or: " << said;
    }

    TEST(bad_settings, each_is_refused_outside_of_its_range)
    {
        int rows = 0;
        for_each_setting([&](const auto& row) {
            namespace t = setting_table;
            using values = std::remove_cvref_t<decltype(row.values)>;
            const auto is = [&](auto value, bool good) {
                expect_setting(
                    row, [&](auto& v) { v = static_cast<std::remove_cvref_t<decltype(v)>>(value); }, good);
            };
            ++rows;
            if constexpr (std::is_same_v<values, t::whole_range>) {
                is(row.values.least, true);
                is(row.values.most, true);
                if (row.values.least > 0)
                    is(row.values.least - 1, false);
                if (row.values.most < 0xFFFFFFFFu)
                    is(row.values.most + 1, false);
            } else if constexpr (std::is_same_v<values, t::real_or_auto>) {
                const auto& range = row.values.range;
                is(std::optional<double>(), true);
                is(std::optional(range.least), true);
                is(std::optional(range.most), true);
                for (const double bad : {std::nextafter(range.least, -infinity), std::nextafter(range.most, infinity),
                         nan, infinity, -infinity})
                    is(std::optional(bad), false);
            } else if constexpr (std::is_same_v<values, real_range>) {
                is(row.values.least, true);
                is(row.values.most, true);
                for (const double bad : {std::nextafter(row.values.least, -infinity),
                         std::nextafter(row.values.most, infinity), nan, infinity, -infinity})
                    is(bad, false);
            } else if constexpr (std::is_same_v<values, t::whole_or_auto>) {
                const auto& range = row.values.range;
                for (const auto good : {range.least, range.most, automatic_number})
                    is(good, true);
                if (range.least > 0)
                    is(range.least - 1, false);
                is(range.most + 1, false);
                is(automatic_number - 1, false);
            } else if constexpr (std::is_same_v<values, t::length_or_auto>) {
                is(1e-9, true);
                is(automatic_length, true);
                for (const double bad : {0.0, -0.999, nan, infinity, -infinity})
                    is(bad, false);
            } else if constexpr (std::is_same_v<values, t::cells>) {
                is(glm::uvec3(0), true);
                is(glm::uvec3(1), true);
                is(glm::uvec3(row.values.most_per_axis, 1, 1), true);
                is(glm::uvec3(2048, 1024, 1024), true);
                is(glm::uvec3(2048, 1025, 1024), false);
                for (int axis = 0; axis < 3; ++axis) {
                    glm::uvec3 v(1);
                    v[axis] = row.values.most_per_axis + 1;
                    is(v, false);
                    v[axis] = 0;
                    is(v, false);
                }
            } else if constexpr (std::is_same_v<values, t::pixels>) {
                for (const auto member : {&output_settings::width, &output_settings::height})
                    for (const std::uint32_t n : {0u, 1u, row.values.most, row.values.most + 1})
                        expect_setting(
                            row, [&](auto& v) { v.*member = n; }, n >= 1 && n <= row.values.most);
            } else if constexpr (std::is_same_v<values, t::policies>) {
                for (const auto member : {&leak_policy::min_cosine, &leak_policy::flattening})
                    for (const float bad : {std::nanf(""), static_cast<float>(infinity), -static_cast<float>(infinity)})
                        expect_setting(
                            row, [&](auto& v) { v.*member = bad; }, false);
                expect_setting(
                    row, [&](auto& v) { v.min_cosine = 1.0001f; }, false);
                expect_setting(
                    row, [&](auto& v) { v.min_cosine = -1.0001f; }, false);
                expect_setting(
                    row, [&](auto& v) { v.flattening = 0.9999f; }, false);
                expect_setting(
                    row, [&](auto& v) { v.flattening = 1.1e6f; }, false);
            } else {
                for (const auto& n : row.values.values)
                    if (row.name != std::string("edge_correction"))
                        is(n.value, true);
                is(100, false);
            }
        });
        EXPECT_GE(rows, 20);
    }

    TEST(bad_settings, a_message_names_the_ends_of_the_range)
    {
        EXPECT_EQ((real_range{0, 0.5, ""}.ends()), "0 to 0.5");
        EXPECT_EQ((real_range{-64, 1e6, " EV"}.ends()), "-64 to 1000000 EV");
        render_settings s;
        s.estimate.interpolation = 0.7;
        try {
            check(s);
            FAIL() << "0.7";
        } catch (const std::invalid_argument& e) {
            EXPECT_STREQ(e.what(), "interpolation: must be from 0 to 0.5");
        }
    }

    TEST(bad_settings, edge_correction_needs_min_cosine)
    {
        render_settings s;
        s.estimate.edges = edge_correction::polygons;
        s.estimate.leaks.min_cosine = 0.5f;
        EXPECT_NO_THROW(check(s));
        s.estimate.leaks.min_cosine = 0;
        EXPECT_THROW(check(s), std::invalid_argument);
        s.estimate.edges = edge_correction::probes; // without it they probe nothing
        EXPECT_NO_THROW(check(s));
    }

} // namespace
} // namespace photongrid::testing

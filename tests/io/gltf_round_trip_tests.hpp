// Scenes that go to glTF and back: two programs' texts in one, since the writer and the reader share no code but 683.
#pragma once

#include "pbrt_writer_tests.hpp"

#include <photongrid/io/gltf_file.hpp>
#include <photongrid/io/gltf_writer.hpp>

#include <map>

namespace photongrid {
namespace {

    /// glTF has mirrors and metals alike, keeps single precision in nothing but vertices, and rounds textures to 8
    /// bits.
    constexpr double rounding_of_gltf = 1e-6;

    double relative_difference(const dvec3& a, const dvec3& b)
    {
        return glm::length(a - b) / std::max(1e-12, glm::length(b));
    }

    /// The area of the triangles of each material, by name, and of the same surfaces in a scene of glTF.
    std::map<std::string, double> areas(const scene& s)
    {
        std::map<std::string, double> all;
        for (const auto& m : s.meshes)
            all[s.materials[m.material].name] += area_of(m);
        return all;
    }

    RC_GTEST_PROP(gltf_round_trip, what_gltf_has_comes_back, (std::uint32_t seed))
    {
        const test_folder folder("gltf_back");
        auto s = scene_generator(seed, true).any_scene();
        s.spheres.resize(1); // each is thousands of triangles there
        s.cylinders.clear();
        s.disks.clear();
        const auto path = folder.file("made.glb");
        write_gltf(path, s);
        const auto r = read_gltf(path).scene;

        RC_ASSERT(relative_difference(r.camera.position, s.camera.position) < 1e-12);
        auto square = r; // its picture has the proportions of the other one, but not its size
        square.render.output = s.render.output;
        for (const double x : {-1.0, 1.0})
            for (const double y : {-1.0, 1.0})
                RC_ASSERT(glm::length(direction_through(square, x, y) - direction_through(s, x, y)) < 1e-9);

        for (const auto& m : s.materials) {
            const auto found = std::find_if(
                r.materials.begin(), r.materials.end(), [&](const material& n) { return n.name == m.name; });
            if (found == r.materials.end())
                continue; // no surface has it
            if (is_mixture(m))
                continue; // the part with the larger share
            const auto kind
                = [](const material& x) { return x.kind == material_kind::mirror ? material_kind::metal : x.kind; };
            RC_ASSERT(kind(*found) == kind(m));
            RC_ASSERT(std::abs(found->roughness - m.roughness) < 1e-12);
            if (m.kind == material_kind::glass || m.kind == material_kind::plastic)
                RC_ASSERT(std::abs(found->index_of_refraction - m.index_of_refraction) < 1e-12);
            RC_ASSERT(std::abs(found->opacity - m.opacity) < 1e-12);
            if (!m.texture.map)
                RC_ASSERT(glm::length(found->reflectance - m.reflectance) < 1e-9);
        }
        auto before = areas(s);
        before.erase(s.materials[s.spheres[0].material].name); // there, triangles of the sphere have it too
        for (const auto& [name, area] : before) {
            const auto after = areas(r);
            RC_ASSERT(after.contains(name));
            RC_ASSERT(std::abs(after.at(name) - area) < rounding_of_gltf * area);
        }

        const auto each = [](const auto& a, const auto& b, const auto& is_same) {
            RC_ASSERT(a.size() == b.size());
            for (std::size_t i = 0; i < a.size(); ++i)
                RC_ASSERT(is_same(a[i], b[i]));
        };
        each(r.point_lights, s.point_lights, [](const auto& a, const auto& b) {
            return relative_difference(a.position, b.position) < 1e-12 && relative_difference(a.power, b.power) < 1e-9;
        });
        each(r.directional_lights, s.directional_lights, [](const auto& a, const auto& b) {
            return glm::length(glm::normalize(a.direction) - glm::normalize(b.direction)) < 1e-9
                && relative_difference(a.irradiance, b.irradiance) < 1e-9;
        });
        dvec3 power(0), expected(0); // of lamps; a rectangle and a sphere are meshes in between
        for (const auto& l : r.mesh_lights)
            power += l.power;
        for (const auto& l : r.rectangle_lights)
            power += l.power;
        for (const auto& l : s.mesh_lights)
            expected += l.power;
        for (const auto& l : s.rectangle_lights)
            expected += l.power;
        for (const auto& l : s.sphere_lights)
            expected += l.power;
        RC_ASSERT(relative_difference(power, expected) < 1e-3); // of a sphere's triangles
    }

    TEST(gltf_round_trip, walls_of_the_cornell_box_have_the_same_triangles)
    {
        const test_folder folder("gltf_walls");
        const auto s = in_triangles(read_scene((example_scenes / "cornell_box.json").string()));
        auto walls = s;
        walls.spheres.clear(); // tessellated there
        write_gltf(folder.file("box.gltf"), walls, {.strict = true});
        const auto r = read_gltf(folder.file("box.gltf"), {.strict = true}).scene;
        ASSERT_EQ(r.meshes.size(), walls.meshes.size());
        for (std::size_t i = 0; i < r.meshes.size(); ++i) {
            const auto name = [i](const scene& x) { return x.materials[x.meshes[i].material].name; };
            EXPECT_EQ(name(r), name(walls));
            ASSERT_EQ(r.meshes[i].surface->triangles.size(), walls.meshes[i].surface->triangles.size());
            for (std::size_t t = 0; t < r.meshes[i].surface->triangles.size(); ++t)
                EXPECT_EQ(corners_of(r.meshes[i], t), corners_of(walls.meshes[i], t));
        }
        ASSERT_EQ(r.rectangle_lights.size(), 1u);
        EXPECT_LT(relative_difference(r.rectangle_lights[0].power, walls.rectangle_lights[0].power), 1e-6);
    }

} // namespace
} // namespace photongrid

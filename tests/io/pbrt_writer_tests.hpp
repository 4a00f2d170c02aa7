// Scenes that go to pbrt-v4 and back.
#pragma once

#include "scene_conversion_tests.hpp"

#include <photongrid/io/pbrt_file.hpp>
#include <photongrid/io/pbrt_writer.hpp>

namespace photongrid {
namespace {

    /// Rounding: of places up to 10 m and of unit vectors, after some transformations.
    constexpr double rounding = 1e-13;

    bool is_near(double a, double b) { return std::abs(a - b) <= rounding * std::max(1.0, std::abs(b)); }
    bool is_near(const dvec3& a, const dvec3& b)
    {
        return glm::length(a - b) <= rounding * std::max(1.0, glm::length(b));
    }

    /// Whether materials scatter alike. pbrt's mirrors are metals.
    bool is_near(const scene& a, const material& m, const scene& b, const material& n)
    {
        const auto kind
            = [](const material& x) { return x.kind == material_kind::mirror ? material_kind::metal : x.kind; };
        if (kind(m) != kind(n) || !is_near(m.opacity, n.opacity))
            return false;
        if (is_mixture(m))
            return is_near(m.share, n.share) && is_near(a, a.materials[m.parts[0]], b, b.materials[n.parts[0]])
                && is_near(a, a.materials[m.parts[1]], b, b.materials[n.parts[1]]);
        const bool same_texture = (m.texture.map == nullptr) == (n.texture.map == nullptr);
        return same_texture && (m.texture.map || is_near(m.reflectance, n.reflectance))
            && is_near(m.index_of_refraction, n.index_of_refraction) && is_near(m.roughness, n.roughness);
    }

    /// The largest difference of two materials' textures, times the reflectance.
    double difference_of_textures(const material& m, const material& n)
    {
        if (!m.texture.map)
            return 0;
        if (m.texture.map->texels.size() != n.texture.map->texels.size() || m.texture.wrap != n.texture.wrap
            || m.texture.scale != n.texture.scale || m.texture.offset != n.texture.offset)
            return 1;
        double most = 0;
        for (std::size_t i = 0; i < m.texture.map->texels.size(); ++i)
            for (int c = 0; c < 3; ++c)
                most = std::max(most,
                    std::abs(m.reflectance[c] * m.texture.map->texels[i][c]
                        - n.reflectance[c] * n.texture.map->texels[i][c]));
        return most / 65535;
    }

    dvec3 direction_through(const scene& s, double x, double y)
    {
        const detail::camera_axes axes(s.camera);
        const double up = std::tan(glm::radians(s.camera.vertical_fov) / 2),
                     right = up * s.render.output.width / s.render.output.height;
        return glm::normalize(axes.forward + x * right * axes.right + y * up * axes.up);
    }

    RC_GTEST_PROP(pbrt_writer, what_pbrt_has_comes_back, (std::uint32_t seed))
    {
        const test_folder folder("pbrt");
        const auto s = scene_generator(seed, true).any_scene();
        const auto path = folder.file("made.pbrt");
        RC_ASSERT(write_pbrt(path, s, {.strict = true}).notes.empty());
        const auto r = read_pbrt(path, {.strict = true}).scene;

        RC_ASSERT(is_near(r.camera.position, s.camera.position));
        for (const double x : {-1.0, 1.0})
            for (const double y : {-1.0, 1.0})
                RC_ASSERT(is_near(direction_through(r, x, y), direction_through(s, x, y)));
        RC_ASSERT(r.render.output.width == s.render.output.width);
        RC_ASSERT(r.render.output.height == s.render.output.height);

        const auto same_material = [&](const auto& a, const auto& b) {
            const auto &m = s.materials[b.material], &n = r.materials[a.material];
            // A texel is rounded to 16 bits, its picture to single precision.
            return is_near(r, n, s, m) && difference_of_textures(m, n) <= 0.51 / 65535;
        };
        const auto each = [](const auto& a, const auto& b, const auto& is_same) {
            RC_ASSERT(a.size() == b.size());
            for (std::size_t i = 0; i < a.size(); ++i)
                RC_ASSERT(is_same(a[i], b[i]));
        };
        each(r.spheres, s.spheres, [&](const auto& a, const auto& b) {
            return a.center == b.center && is_near(a.radius, b.radius) && same_material(a, b);
        });
        each(r.cylinders, s.cylinders, [&](const auto& a, const auto& b) {
            return a.base == b.base && is_near(a.top, b.top) && is_near(a.radius, b.radius) && same_material(a, b);
        });
        each(r.disks, s.disks, [&](const auto& a, const auto& b) {
            return a.center == b.center && is_near(a.normal, glm::normalize(b.normal)) && is_near(a.radius, b.radius)
                && same_material(a, b);
        });
        each(r.meshes, s.meshes, [&](const auto& a, const auto& b) {
            return *a.surface == *b.surface && a.linear == b.linear && a.offset == b.offset && same_material(a, b);
        });
        each(r.point_lights, s.point_lights,
            [&](const auto& a, const auto& b) { return a.position == b.position && is_near(a.power, b.power); });
        each(r.rectangle_lights, s.rectangle_lights, [&](const auto& a, const auto& b) {
            return a.corner == b.corner && is_near(a.edge_u, b.edge_u) && is_near(a.edge_v, b.edge_v)
                && is_near(a.power, b.power);
        });
        each(r.sphere_lights, s.sphere_lights, [&](const auto& a, const auto& b) {
            return a.center == b.center && is_near(a.radius, b.radius) && is_near(a.power, b.power);
        });
        each(r.mesh_lights, s.mesh_lights, [&](const auto& a, const auto& b) {
            return *a.surface.surface == *b.surface.surface && a.surface.linear == b.surface.linear
                && a.surface.offset == b.surface.offset && is_near(a.power, b.power);
        });
        each(r.spot_lights, s.spot_lights, [&](const auto& a, const auto& b) {
            return a.position == b.position && is_near(glm::normalize(a.direction), glm::normalize(b.direction))
                && is_near(a.inner_angle, b.inner_angle) && is_near(a.outer_angle, b.outer_angle)
                && is_near(a.power, b.power);
        });
        each(r.directional_lights, s.directional_lights,
            [&](const auto& a, const auto& b) { return a.direction == b.direction && a.irradiance == b.irradiance; });
        each(r.environment_lights, s.environment_lights,
            [&](const auto& a, const auto& b) { return !a.map && a.radiance == b.radiance; });
    }

    // Colours of sRGB are photongrid's, so that 1 stays 1 and not a little more, which no reflectance is.
    TEST(pbrt_writer, a_white_surface_stays_white)
    {
        const test_folder folder("white");
        auto s = papered_square({}, {});
        s.materials[0].reflectance = {1, 1, 0};
        write_pbrt(folder.file("a.pbrt"), s, {.strict = true});
        const auto r = read_pbrt(folder.file("a.pbrt"), {.strict = true});
        EXPECT_TRUE(r.notes.empty());
        EXPECT_EQ(r.scene.materials.at(0).reflectance, dvec3(1, 1, 0));
    }

    /// The scene that pbrt's file of this one describes: polygons are triangles, and materials are counted as they are
    /// used, shape by shape.
    scene in_triangles(scene s)
    {
        for (const auto& p : s.polygons) {
            mesh m;
            for (const auto& v : p.vertices)
                m.positions.emplace_back(v);
            for (std::uint32_t i = 2; i < p.vertices.size(); ++i)
                m.triangles.emplace_back(0, i - 1, i);
            s.meshes.push_back({.file = "",
                .surface = std::make_shared<const mesh>(m),
                .linear = glm::dmat3(1),
                .offset = dvec3(0),
                .material = p.material});
        }
        s.polygons.clear();
        return s;
    }

    TEST(pbrt_writer, the_cornell_box_comes_back_byte_for_byte)
    {
        const test_folder folder("cornell");
        auto s = read_scene((example_scenes / "cornell_box.json").string());
        const auto made = write_pbrt(folder.file("box.pbrt"), s, {.strict = true});
        EXPECT_EQ(made.files.size(), 1u); // no mesh is large
        auto read = read_pbrt(folder.file("box.pbrt"), {.strict = true}).scene;
        auto expected = in_triangles(s);
        // Materials in the order of use: mirror, glass, white, green, red. They keep their names.
        std::vector<material> materials;
        std::vector<std::uint32_t> index(s.materials.size());
        for (const auto& m : read.materials) {
            const auto at
                = std::find_if(s.materials.begin(), s.materials.end(), [&](const auto& x) { return x.name == m.name; });
            ASSERT_NE(at, s.materials.end()) << m.name;
            index[static_cast<std::size_t>(at - s.materials.begin())] = static_cast<std::uint32_t>(materials.size());
            materials.push_back(*at);
        }
        ASSERT_EQ(materials.size(), s.materials.size());
        expected.materials = materials;
        for (auto& x : expected.spheres)
            x.material = index[x.material];
        for (auto& x : expected.meshes)
            x.material = index[x.material];
        const auto a = lay_out(read), b = lay_out(expected);
        EXPECT_TRUE(has_equal_bytes(a.records, b.records));
    }

    // The mean over the sphere and the texel in a direction, through Clarberg's map and back.
    TEST(pbrt_writer, an_environment_keeps_its_light_and_its_directions)
    {
        const test_folder folder("sky");
        auto s = read_scene((example_scenes / "cornell_box.json").string());
        environment_map map{16, 8, {}};
        for (std::uint32_t i = 0; i < 128; ++i)
            map.radiance.emplace_back(i % 7, 1 + i / 16, 0.5f);
        s.environment_lights.push_back({.name = "sky",
            .file = "",
            .map = std::make_shared<const environment_map>(map),
            .radiance = {1, 2, 3},
            .axis = {1, 2, 3},
            .degrees = 77});
        const auto made = write_pbrt(folder.file("sky.pbrt"), s);
        ASSERT_EQ(made.notes.size(), 1u);
        EXPECT_EQ(text_of(made.notes[0]),
            folder.file("sky.pbrt")
                + ": note: the environment is resampled to a square of 64 x 64 pixels, which pbrt needs");
        EXPECT_THROW(write_pbrt(folder.file("strict.pbrt"), s, {.strict = true}), scene_error);
        EXPECT_FALSE(std::filesystem::exists(folder.file("strict.pbrt")));
        EXPECT_FALSE(std::filesystem::exists(folder.file("strict")));
        const auto r = read_pbrt(folder.file("sky.pbrt")).scene;
        ASSERT_EQ(r.environment_lights.size(), 1u);
        const environment_texels before(s.environment_lights[0]), after(r.environment_lights[0]);
        const auto power = [](const environment_texels& t) {
            dvec3 sum(0);
            for (std::uint32_t row = 0; row < t.height(); ++row)
                for (std::uint32_t column = 0; column < t.width(); ++column)
                    sum += t.radiance(column, row) * t.solid_angle(row);
            return sum;
        };
        const dvec3 a = power(after), b = power(before);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(a[c], b[c], 0.005 * b[c]);
        // Texels of the original, in their middles.
        const auto& l = r.environment_lights[0];
        const auto turned = glm::transpose(rotation_about(l.axis, l.degrees));
        for (std::uint32_t row = 1; row < 7; ++row)
            for (std::uint32_t column = 0; column < 16; ++column) {
                const dvec3 world
                    = rotation_about({1, 2, 3}, 77) * environment_direction((column + 0.5) / 16, (row + 0.5) / 8);
                const dvec3 d = turned * world;
                double u = std::atan2(d.x, -d.z) / (2 * std::numbers::pi);
                u -= std::floor(u);
                const double v = std::acos(d.y) / std::numbers::pi;
                const auto at = static_cast<std::size_t>(v * l.map->height) * l.map->width
                    + static_cast<std::size_t>(u * l.map->width);
                const dvec3 found = dvec3(l.map->radiance[at]) * l.radiance,
                            expected = dvec3(map.radiance[row * 16 + column]) * dvec3(1, 2, 3);
                EXPECT_LT(glm::length(found - expected), 1e-5) << row << ' ' << column;
            }
    }

    TEST(pbrt_writer, notes_what_pbrt_does_not_have)
    {
        const test_folder folder("notes");
        auto s = read_scene((example_scenes / "cornell_box.json").string());
        s.cones.push_back({{0, 0, 0}, {0, 0.1, 0}, 0.1, 0});
        s.cones.push_back({{0, 0, 0}, {0, 0.2, 0}, 0.1, 0});
        s.paraboloids.push_back({{0, 0, 0}, {0, 0.1, 0}, 0.1, 0});
        s.materials[4].reflectance = {1, 0.5, 1};
        s.materials.push_back({.name = "brushed", .kind = material_kind::metal, .roughness = 0.02});
        std::vector<std::string> notes;
        for (const auto& n : write_pbrt(folder.file("a.pbrt"), s).notes)
            notes.push_back(n.what);
        EXPECT_EQ(notes,
            (std::vector<std::string>{
                "material \"glass\": pbrt's glass lets all light pass; its transmittance is left out",
                "material \"brushed\": pbrt takes a roughness below 0.032 for 0", "cones: drawn as 128 triangles each",
                "paraboloids: drawn as 8064 triangles each"}));
        const auto r = read_pbrt(folder.file("a.pbrt")).scene;
        // Vertices lie on the cone and on the paraboloid.
        for (const auto& m : r.meshes)
            for (const dvec3 p : m.surface->positions) {
                const double across = std::hypot(p.x, p.z);
                if (m.surface->triangles.size() == 128) {
                    EXPECT_TRUE(across < 1e-7 || (std::abs(across - 0.1) < 1e-7 && std::abs(p.y) < 1e-7)) << p.y;
                } else if (m.surface->triangles.size() == 8064) {
                    EXPECT_NEAR(p.y, 0.1 * across * across / 0.01, 1e-6);
                }
            }
        EXPECT_THROW(write_pbrt(folder.file("b.pbrt"), s, {.strict = true}), scene_error);
        EXPECT_FALSE(std::filesystem::exists(folder.file("b")));
    }

    // Each surface has one file, and pbrt keeps it in memory once.
    TEST(pbrt_writer, places_of_a_surface_become_instances)
    {
        const test_folder folder("instances");
        auto s = papered_square({}, {});
        s.meshes.clear();
        scene_generator g(1, true);
        const auto small = g.surface(63), large = g.surface(64);
        for (int i = 0; i < 5; ++i)
            s.meshes.push_back({.file = "",
                .surface = i < 3 ? large : small,
                .linear = glm::dmat3(1),
                .offset = dvec3(i, 0, 0),
                .material = 0});
        EXPECT_EQ(write_pbrt(folder.file("a.pbrt"), s, {.strict = true}).files.size(), 3u);
        const auto text = bytes_in(folder.file("a.pbrt"));
        std::map<std::string, int> count;
        for (const auto* word : {"ObjectInstance", "ObjectBegin", "plymesh"})
            for (auto at = text.find(word); at != text.npos; at = text.find(word, at + 1))
                ++count[word];
        EXPECT_EQ(count["ObjectBegin"], 1);
        EXPECT_EQ(count["ObjectInstance"], 3);
        EXPECT_EQ(count["plymesh"], 3); // of the object, and of the two others
        const auto r = read_pbrt(folder.file("a.pbrt"), {.strict = true}).scene;
        ASSERT_EQ(r.meshes.size(), 5u);
        EXPECT_EQ(r.meshes[0].surface, r.meshes[1].surface); // pbrt draws objects last
        EXPECT_EQ(*r.meshes[0].surface, *small);
        for (std::size_t i = 2; i < 5; ++i) {
            EXPECT_EQ(*r.meshes[i].surface, *large);
            EXPECT_EQ(r.meshes[i].offset, s.meshes[i - 2].offset);
        }
    }

} // namespace
} // namespace photongrid

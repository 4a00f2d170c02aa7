// Scenes of glTF, by its specification (https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html): what the file says
// is read with a JSON parser and compared with the scene.
#pragma once

#include "scene_conversion_tests.hpp"

#include <photongrid/io/gltf_writer.hpp>

#include <nlohmann/json.hpp>

namespace photongrid {
namespace {

    /// A URI as the name of a file; the tests' have no other characters that need %.
    std::string decoded(std::string uri)
    {
        for (auto at = uri.find("%20"); at != uri.npos; at = uri.find("%20"))
            uri.replace(at, 3, " ");
        return uri;
    }

    /// A file with its bytes.
    class gltf_document {
    public:
        explicit gltf_document(const std::filesystem::path& path)
        {
            const auto content = bytes_in(path);
            if (path.extension() != ".glb") {
                all = nlohmann::json::parse(content);
                bytes = bytes_in(path.parent_path() / decoded(all.at("buffers").at(0).at("uri")));
                return;
            }
            const auto word = [&](std::size_t at) {
                std::uint32_t n = 0;
                std::memcpy(&n, content.data() + at, sizeof n);
                return n;
            };
            EXPECT_EQ(content.substr(0, 4), "glTF");
            EXPECT_EQ(word(4), 2u);
            EXPECT_EQ(word(8), content.size());
            EXPECT_EQ(content.substr(16, 4), "JSON");
            EXPECT_EQ(word(12) % 4, 0u);
            all = nlohmann::json::parse(content.substr(20, word(12)));
            const auto second = 20 + word(12);
            EXPECT_EQ(word(second) % 4, 0u);
            EXPECT_EQ(content.substr(second + 4, 4), std::string("BIN\0", 4));
            EXPECT_EQ(content.size(), second + 8 + word(second));
            bytes = content.substr(second + 8);
        }

        const nlohmann::json& operator[](const char* key) const { return all.at(key); }

        /// The numbers of an accessor.
        template <class Number>
        std::vector<Number> numbers(std::size_t accessor) const
        {
            const auto& a = all.at("accessors").at(accessor);
            const auto& v = all.at("bufferViews").at(a.at("bufferView").get<std::size_t>());
            const std::map<std::string, std::size_t> parts{{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}};
            const auto count = a.at("count").get<std::size_t>() * parts.at(a.at("type"));
            EXPECT_EQ(a.at("componentType"), (std::is_same_v<Number, float> ? 5126 : 5125));
            EXPECT_EQ(v.at("byteLength"), count * 4);
            EXPECT_EQ(v.at("byteOffset").get<std::size_t>() % 4, 0u);
            EXPECT_LE(v.at("byteOffset").get<std::size_t>() + count * 4, all.at("buffers").at(0).at("byteLength"));
            std::vector<Number> made(count);
            std::memcpy(made.data(), bytes.data() + v.at("byteOffset").get<std::size_t>(), count * 4);
            return made;
        }

        nlohmann::json all;
        std::string bytes;
    };

    const nlohmann::json& named(const nlohmann::json& list, const std::string& name)
    {
        for (const auto& x : list)
            if (x.value("name", "") == name)
                return x;
        ADD_FAILURE() << "nothing is called " << name;
        return list.at(0);
    }

    glm::dmat4 matrix_of(const nlohmann::json& node)
    {
        glm::dmat4 m(1);
        if (node.contains("matrix"))
            for (int i = 0; i < 16; ++i)
                m[i / 4][i % 4] = node.at("matrix").at(static_cast<std::size_t>(i));
        return m;
    }

    void expect_what_the_specification_wants(std::uint32_t seed)
    {
        const test_folder folder("gltf");
        const auto s = scene_generator(seed, false).any_scene();
        const auto path = folder.file(seed % 2 == 0 ? "made.glb" : "made it.gltf");
        const auto written = write_gltf(path, s);
        ASSERT_TRUE(written.files.back() == path);
        const gltf_document d(path);
        ASSERT_TRUE(d["asset"].at("version") == "2.0");
        ASSERT_TRUE(d["buffers"].at(0).at("byteLength").get<std::size_t>() <= d.bytes.size());
        ASSERT_TRUE(d["materials"].size()
            == s.materials.size() + s.rectangle_lights.size() + s.sphere_lights.size() + s.mesh_lights.size());
        ASSERT_TRUE(d["nodes"].size()
            == 1 + count_shapes(s) + count_lights(s) - s.environment_lights.size()); // the camera's too
        for (const auto& m : d["meshes"]) {
            const auto& p = m.at("primitives").at(0);
            const auto positions = d.numbers<float>(p.at("attributes").at("POSITION"));
            const auto& a = d["accessors"].at(p.at("attributes").at("POSITION").get<std::size_t>());
            for (std::size_t c = 0; c < 3; ++c) {
                float low = positions[c], high = low;
                for (std::size_t i = c; i < positions.size(); i += 3) {
                    low = std::min(low, positions[i]);
                    high = std::max(high, positions[i]);
                }
                ASSERT_TRUE(a.at("min").at(c).get<double>() == static_cast<double>(low));
                ASSERT_TRUE(a.at("max").at(c).get<double>() == static_cast<double>(high));
            }
            const auto indices = d.numbers<std::uint32_t>(p.at("indices"));
            ASSERT_TRUE(*std::max_element(indices.begin(), indices.end()) < positions.size() / 3);
            if (p.at("attributes").contains("NORMAL")) {
                const auto n = d.numbers<float>(p.at("attributes").at("NORMAL"));
                ASSERT_TRUE(n.size() == positions.size());
                double most = 0;
                for (std::size_t i = 0; i < n.size(); i += 3)
                    most = std::max(most, std::abs(glm::length(glm::dvec3(n[i], n[i + 1], n[i + 2])) - 1));
                ASSERT_TRUE(most < 1e-6);
            }
            ASSERT_TRUE(p.at("material") < d["materials"].size());
        }
        for (const auto& m : d["materials"])
            for (const auto& c : m.at("pbrMetallicRoughness").at("baseColorFactor"))
                ASSERT_TRUE(c >= 0 && c <= 1);
        for (const auto& i : d.all.value("images", nlohmann::json::array())) {
            if (i.contains("uri")) {
                ASSERT_TRUE(bytes_in(folder.path / decoded(i.at("uri"))).starts_with("\x89PNG"));
            } else {
                const auto& v = d["bufferViews"].at(i.at("bufferView").get<std::size_t>());
                ASSERT_TRUE(std::string_view(d.bytes).substr(v.at("byteOffset")).starts_with("\x89PNG"));
            }
        }
        // Meshes are where they are in the scene.
        for (std::size_t i = 0; i < s.meshes.size(); ++i) {
            const auto& node = named(d["nodes"], "mesh " + std::to_string(i));
            const auto m = matrix_of(node);
            const auto& p = d["meshes"].at(node.at("mesh").get<std::size_t>()).at("primitives").at(0);
            const auto positions = d.numbers<float>(p.at("attributes").at("POSITION"));
            const auto& of = s.meshes[i];
            ASSERT_TRUE(positions.size() == 3 * of.surface->positions.size());
            for (std::size_t v = 0; v < of.surface->positions.size(); ++v) {
                const auto at = dvec3(m * glm::dvec4(positions[3 * v], positions[3 * v + 1], positions[3 * v + 2], 1));
                ASSERT_TRUE(glm::length(at - place_of(of, of.surface->positions[v])) < 1e-5);
            }
            ASSERT_TRUE(p.at("material") == of.material);
        }
    }

    TEST(gltf_writer, says_what_the_specification_wants)
    {
        // 20 scenes, not RapidCheck's hundred: round shapes are thousands of triangles.
        for (std::uint32_t n = 0; n < 20; ++n)
            expect_what_the_specification_wants(n * 2654435761u + 7);
    }

    TEST(gltf_writer, the_cornell_box_is_as_the_specification_says)
    {
        const test_folder folder("gltf_cornell");
        const auto s = read_scene((example_scenes / "cornell_box.json").string());
        const auto made = write_gltf(folder.file("box.gltf"), s);
        ASSERT_EQ(made.notes.size(), 1u);
        EXPECT_EQ(text_of(made.notes[0]), folder.file("box.gltf") + ": note: spheres: drawn as 16128 triangles each");
        const gltf_document d(folder.file("box.gltf"));
        // The camera looks along its -z; the field of view is the vertical one, in radians.
        const auto& camera = d["cameras"].at(0).at("perspective");
        EXPECT_NEAR(camera.at("yfov"), glm::radians(39.3076), 1e-12);
        EXPECT_EQ(camera.at("aspectRatio"), 1);
        EXPECT_GT(camera.at("znear"), 0);
        const auto view = matrix_of(named(d["nodes"], "camera"));
        EXPECT_LT(glm::length(dvec3(view[3]) - dvec3(0.278, 0.273, -0.8)), 1e-12);
        EXPECT_LT(glm::length(dvec3(view[2]) - dvec3(0, 0, -1)), 1e-12); // backwards
        EXPECT_LT(glm::length(dvec3(view[1]) - dvec3(0, 1, 0)), 1e-12);
        EXPECT_LT(glm::length(dvec3(view[0]) - dvec3(-1, 0, 0)), 1e-12); // right, as seen towards +z
        const auto& white = named(d["materials"], "white").at("pbrMetallicRoughness");
        EXPECT_EQ(white.at("baseColorFactor"), nlohmann::json({0.739, 0.735, 0.751, 1.0}));
        EXPECT_EQ(white.at("metallicFactor"), 0);
        EXPECT_EQ(white.at("roughnessFactor"), 1);
        EXPECT_EQ(named(d["materials"], "white").at("extensions").at("KHR_materials_specular").at("specularFactor"), 0);
        const auto& mirror = named(d["materials"], "mirror").at("pbrMetallicRoughness");
        EXPECT_EQ(mirror.at("metallicFactor"), 1);
        EXPECT_EQ(mirror.at("roughnessFactor"), 0);
        const auto& glass = named(d["materials"], "glass").at("extensions");
        EXPECT_EQ(glass.at("KHR_materials_ior").at("ior"), 1.5);
        EXPECT_EQ(glass.at("KHR_materials_transmission").at("transmissionFactor"), 1);
        EXPECT_GT(glass.at("KHR_materials_volume").at("thicknessFactor"), 0);
        // The lamp: 30 W/(m^2 sr), 683 nits for each (examples/scenes/cornell_box.json); it faces down.
        const auto& lamp = named(d["materials"], "ceiling lamp");
        EXPECT_NEAR(lamp.at("extensions").at("KHR_materials_emissive_strength").at("emissiveStrength"), 30 * 683, 1);
        EXPECT_EQ(lamp.at("emissiveFactor"), nlohmann::json({1.0, 1.0, 1.0}));
        const auto& node = named(d["nodes"], "ceiling lamp");
        const auto m = matrix_of(node);
        const auto& p = d["meshes"].at(node.at("mesh").get<std::size_t>()).at("primitives").at(0);
        const auto positions = d.numbers<float>(p.at("attributes").at("POSITION"));
        const auto indices = d.numbers<std::uint32_t>(p.at("indices"));
        ASSERT_EQ(indices.size(), 6u);
        double area = 0;
        for (std::size_t t = 0; t < 6; t += 3) {
            const auto corner = [&](std::size_t c) {
                const auto* at = &positions[3 * indices[t + c]];
                return dvec3(m * glm::dvec4(at[0], at[1], at[2], 1));
            };
            const auto n = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
            EXPECT_LT(n.y, 0);
            area += glm::length(n) / 2;
        }
        EXPECT_NEAR(area, 0.13 * 0.105, 1e-9);
        // A ball: vertices at its radius, seen from its centre.
        const auto ball = matrix_of(named(d["nodes"], "sphere 0"));
        EXPECT_LT(glm::length(dvec3(ball[3]) - dvec3(0.39, 0.1, 0.38)), 1e-12);
        EXPECT_NEAR(glm::length(dvec3(ball[0])), 0.1, 1e-12);
        // One geometry for both balls.
        EXPECT_EQ(d["meshes"]
                      .at(named(d["nodes"], "sphere 0").at("mesh").get<std::size_t>())
                      .at("primitives")
                      .at(0)
                      .at("indices"),
            d["meshes"]
                .at(named(d["nodes"], "sphere 1").at("mesh").get<std::size_t>())
                .at("primitives")
                .at(0)
                .at("indices"));
    }

    // KHR_lights_punctual: candela and lux, 683 lm for each W; such lights shine along -z.
    TEST(gltf_writer, lights_have_candela_and_lux)
    {
        const test_folder folder("gltf_lights");
        auto s = read_scene((example_scenes / "cornell_box.json").string());
        const double pi = std::numbers::pi;
        s.point_lights.push_back({"bulb", {1, 2, 3}, dvec3(8, 4, 2) * pi});
        s.spot_lights.push_back({"spot", {0, 1, 0}, {0, -2, 0}, 30, 60, dvec3(1)});
        s.directional_lights.push_back({"sun", {1, -1, 0}, {2, 4, 1}});
        s.environment_lights.push_back({.name = "sky", .file = "", .map = nullptr, .radiance = dvec3(1)});
        const auto notes = write_gltf(folder.file("a.glb"), s).notes;
        const gltf_document d(folder.file("a.glb"));
        const auto& lights = d["extensions"].at("KHR_lights_punctual").at("lights");
        ASSERT_EQ(lights.size(), 3u);
        const auto& bulb = named(lights, "bulb");
        EXPECT_NEAR(bulb.at("intensity"), 2 * 683, 1e-9); // 8 pi W into 4 pi sr
        EXPECT_EQ(bulb.at("color"), nlohmann::json({1.0, 0.5, 0.25}));
        EXPECT_LT(glm::length(dvec3(matrix_of(named(d["nodes"], "bulb"))[3]) - dvec3(1, 2, 3)), 1e-12);
        const auto& spot = named(lights, "spot");
        EXPECT_NEAR(spot.at("spot").at("innerConeAngle"), pi / 6, 1e-12);
        EXPECT_NEAR(spot.at("spot").at("outerConeAngle"), pi / 3, 1e-12);
        // Of the solid angle 2 pi (1 - cos), the inner one is lit, and half of what is between.
        const double solid = pi * ((1 - std::cos(pi / 6)) + (1 - std::cos(pi / 3)));
        EXPECT_NEAR(spot.at("intensity"), 683 / solid, 1e-9);
        EXPECT_LT(glm::length(dvec3(matrix_of(named(d["nodes"], "spot"))[2]) - dvec3(0, 1, 0)), 1e-12);
        const auto& sun = named(lights, "sun");
        EXPECT_NEAR(sun.at("intensity"), 4 * 683, 1e-9);
        EXPECT_LT(glm::length(-dvec3(matrix_of(named(d["nodes"], "sun"))[2]) - glm::normalize(dvec3(1, -1, 0))), 1e-12);
        std::vector<std::string> said;
        for (const auto& n : notes)
            said.push_back(n.what);
        EXPECT_EQ(said,
            (std::vector<std::string>{"spheres: drawn as 16128 triangles each",
                "spotlight \"spot\": its light falls off at the edge as each program likes",
                "the environment is left out; glTF has none"}));
    }

    // At a point of a surface, glTF's own arithmetic finds the texel that photongrid finds.
    TEST(gltf_writer, textures_lie_where_they_lay)
    {
        const test_folder folder("gltf_textures");
        auto color = use_of(
            {2, 2, {glm::u16vec4(65535), glm::u16vec4(0, 0, 0, 65535), glm::u16vec4(65535), glm::u16vec4(65535)}});
        color.scale = {2, 3};
        color.offset = {0.25, 0.5};
        const auto s = papered_square(color, {});
        EXPECT_TRUE(write_gltf(folder.file("a.gltf"), s, {.strict = true}).notes.empty());
        const gltf_document d(folder.file("a.gltf"));
        const auto& node = named(d["nodes"], "mesh 0");
        const auto& p = d["meshes"].at(node.at("mesh").get<std::size_t>()).at("primitives").at(0);
        const auto& material = d["materials"].at(p.at("material").get<std::size_t>());
        const auto& t = material.at("pbrMetallicRoughness").at("baseColorTexture");
        const auto& moved = t.at("extensions").at("KHR_texture_transform");
        const auto coordinates = d.numbers<float>(p.at("attributes").at("TEXCOORD_0"));
        for (std::size_t v = 0; v < s.meshes[0].surface->texture_coordinates.size(); ++v) {
            const glm::dvec2 ours
                = color.scale * glm::dvec2(s.meshes[0].surface->texture_coordinates[v]) + color.offset;
            const auto placed = [&](std::size_t c) {
                return moved.at("scale").at(c).get<double>() * static_cast<double>(coordinates[2 * v + c])
                    + moved.at("offset").at(c).get<double>();
            };
            const double x = placed(0), y = placed(1);
            EXPECT_NEAR(x, ours.x, 1e-5);
            EXPECT_NEAR(1 - y, ours.y, 1e-5); // glTF counts from the top
        }
        const auto& used = d["extensionsUsed"];
        EXPECT_NE(std::find(used.begin(), used.end(), "KHR_texture_transform"), used.end());
    }

} // namespace
} // namespace photongrid

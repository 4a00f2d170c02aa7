// glTF 2.0: where the camera, shapes and lights are, what materials become, what is noted and what is refused. The
// expected values are computed from the specification.
#pragma once

#include "import_tests.hpp"

#include <photongrid/io/gltf_file.hpp>
#include <photongrid/io/image_file.hpp>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include <bit>
#include <cstring>
#include <numbers>

namespace photongrid {
namespace {

    std::string base64(const std::string& bytes)
    {
        static constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        std::string made;
        for (std::size_t i = 0; i < bytes.size(); i += 3) {
            std::uint32_t bits = 0;
            for (std::size_t n = 0; n < 3; ++n)
                bits = bits << 8 | (i + n < bytes.size() ? static_cast<unsigned char>(bytes[i + n]) : 0u);
            for (std::size_t n = 0; n < 4; ++n)
                made += i + n > bytes.size() ? '=' : letters[bits >> (18 - 6 * n) & 63u];
        }
        return made;
    }

    template <class T>
    std::string bytes_of(std::initializer_list<T> values)
    {
        std::string made;
        for (const T v : values) {
            char b[sizeof v];
            std::memcpy(b, &v, sizeof v);
            made.append(b, sizeof v);
        }
        return made;
    }

    /// A file with one buffer, whose views and accessors are added one by one.
    class gltf_text {
    public:
        /// \return its index.
        std::size_t add_view(const std::string& bytes, const std::string& more = "")
        {
            while (buffer_.size() % 4 != 0)
                buffer_ += '\xAA';
            views_ += std::string(views_.empty() ? "" : ", ") + R"({"buffer": 0, "byteOffset": )"
                + std::to_string(buffer_.size()) + R"(, "byteLength": )" + std::to_string(bytes.size()) + more + "}";
            buffer_ += bytes;
            return view_count_++;
        }
        std::size_t add_accessor(
            std::size_t count, const std::string& type, std::size_t component, const std::string& more)
        {
            accessors_ += std::string(accessors_.empty() ? "" : ", ") + R"({"count": )" + std::to_string(count)
                + R"(, "type": ")" + type + R"(", "componentType": )" + std::to_string(component) + more + "}";
            return accessor_count_++;
        }
        std::size_t add(std::size_t count, const std::string& type, std::size_t component, const std::string& bytes)
        {
            const auto view = add_view(bytes);
            return add_accessor(count, type, component, R"(, "bufferView": )" + std::to_string(view));
        }
        std::size_t floats(const std::string& type, std::size_t each, std::initializer_list<float> v)
        {
            return add(v.size() / each, type, 5126, bytes_of(v));
        }
        /// The text of a file with the other properties in `more`.
        std::string text(const std::string& more) const
        {
            return R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": )" + std::to_string(buffer_.size())
                + R"(, "uri": "data:application/octet-stream;base64,)" + base64(buffer_) + R"("}], "bufferViews": [)"
                + views_ + R"(], "accessors": [)" + accessors_ + "],\n" + more + "}";
        }
        const std::string& buffer() const { return buffer_; }

    private:
        std::string buffer_, views_, accessors_;
        std::size_t view_count_ = 0, accessor_count_ = 0;
    };

    /// A triangle in the plane z = 0 with the given material's and primitive's properties.
    std::string triangle_text(const std::string& primitive, const std::string& more)
    {
        gltf_text g;
        g.floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0});
        return g.text(R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0})" + primitive + "}]}],\n"
            + R"("nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}])" + more);
    }

    scene gltf_scene(const std::string& text) { return parse_gltf("s.gltf", text).scene; }

    /// glTF's camera looks along -z of its node, with +x right and +y up; yfov is the whole vertical angle.
    TEST(gltf_camera, sees_all_four_corners_where_gltf_does)
    {
        const glm::dquat turn = glm::normalize(glm::dquat(0.8, 0.1, -0.5, 0.3));
        const auto placed = glm::translate(glm::dmat4(1), dvec3(3, 2, -7)) * glm::mat4_cast(turn);
        struct camera_case {
            const char* name;
            std::string nodes;
            glm::dmat4 to_scene; ///< without scale
        };
        const std::string trs = R"("translation": [3, 2, -7], "rotation": [0.1, -0.5, 0.3, 0.8])";
        const camera_case cases[] = {{"none", R"({"mesh": 0, "camera": 0})", glm::dmat4(1)},
            {"TRS", R"({"mesh": 0}, {"camera": 0, )" + trs + R"(, "scale": [2, 3, 0.5]})", placed},
            {"mirrored", R"({"mesh": 0}, {"camera": 0, )" + trs + R"(, "scale": [-1, 1, 1]})", placed},
            {"below another",
                R"({"mesh": 0}, {"children": [2], )" + trs + R"(}, {"camera": 0, "translation": [0, 0, 4]})",
                placed * glm::translate(glm::dmat4(1), dvec3(0, 0, 4))},
            {"matrix", R"({"mesh": 0}, {"camera": 0, "matrix": [0,0,-1,0, 0,1,0,0, 1,0,0,0, 5,6,7,1]})",
                glm::dmat4(0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 5, 6, 7, 1)}};
        for (const auto& c : cases) {
            gltf_text g;
            g.floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0});
            const auto made = parse_gltf("s.gltf",
                g.text(R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [)" + c.nodes
                    + R"(], "cameras": [{"type": "perspective", "perspective": {"yfov": 0.9, "aspectRatio": 1.6}}])"));
            const auto& s = made.scene;
            const double aspect = static_cast<double>(s.render.output.width) / s.render.output.height,
                         t = std::tan(0.45);
            EXPECT_NEAR(aspect, 1.6, 0.005) << c.name;
            expect_near(s.camera.position, dvec3(c.to_scene[3]), 1e-12);
            for (const double x : {-1.0, 1.0})
                for (const double y : {-1.0, 1.0})
                    expect_near(view_direction(s, x, y),
                        glm::normalize(glm::dmat3(c.to_scene) * dvec3(x * t * aspect, y * t, -1)), 1e-9);
        }
    }

    TEST(gltf_file, places_meshes_by_nodes)
    {
        gltf_text g;
        g.floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0});
        g.floats("VEC3", 3, {0, 0, 1, 0, 0, 2});
        g.floats("VEC4", 4, {0, 0, 0, 1, 0, 0, 0.70710678f, 0.70710678f});
        const auto s = gltf_scene(g.text(
            R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [
            {"mesh": 0, "translation": [1, 2, 3], "rotation": [0, 0, 1, 1], "scale": [2, 3, 4], "children": [1]},
            {"mesh": 0, "matrix": [1, 0, 0, 0,  0, 1, 0, 0,  0, 0, 1, 0,  5, 0, 0, 1]},
            {"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 1, "ROTATION": 2}}}}],
            "scene": 1, "scenes": [{"nodes": [2]}, {"nodes": [0, 2]}])"));
        ASSERT_EQ(s.meshes.size(), 4u);
        for (const auto& m : s.meshes)
            EXPECT_EQ(m.surface, s.meshes[0].surface);                                    // one surface for all
        const auto corner = [&](std::size_t n) { return corners_of(s.meshes[n], 0)[1]; }; // (1, 0, 0)
        expect_near(corner(0), {1, 4, 3});  // scaled to (2, 0, 0), turned by 90 degrees to (0, 2, 0), moved
        expect_near(corner(1), {1, 14, 3}); // (6, 0, 0) likewise
        expect_near(corner(2), {1, 0, 1});
        expect_near(corner(3), {0, 1, 2}, 1e-7);
    }

    TEST(gltf_file, reads_accessors_of_all_types)
    {
        gltf_text g;
        // Positions with a stride and an offset; normals as normalised bytes; coordinates as normalised shorts.
        const auto view = g.add_view(
            bytes_of<float>({9, 9, 0, 0, 0, 7, 2, 0, 0, 7, 0, 2, 0, 7, 2, 2, 0, 7}), R"(, "byteStride": 16)");
        g.add_accessor(4, "VEC3", 5126, R"(, "byteOffset": 8, "bufferView": )" + std::to_string(view));
        g.add_accessor(4, "VEC3", 5120,
            R"(, "normalized": true, "bufferView": )"
                + std::to_string(
                    g.add_view(bytes_of<std::int8_t>({0, 0, 127, 0, 0, 0, 127, 0, 0, 0, -128, 0, 0, 64, 127, 0}),
                        R"(, "byteStride": 4)")));
        g.add_accessor(4, "VEC2", 5123,
            R"(, "normalized": true, "bufferView": )"
                + std::to_string(g.add_view(bytes_of<std::uint16_t>({0, 0, 65535, 0, 0, 65535, 13107, 65535}))));
        g.add_accessor(4, "VEC4", 5121,
            R"(, "normalized": true, "bufferView": )"
                + std::to_string(g.add_view(
                    bytes_of<std::uint8_t>({255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 51, 255, 255, 255, 255, 255}))));
        g.add(6, "SCALAR", 5121, bytes_of<std::uint8_t>({0, 1, 2, 2, 1, 3}));
        g.add(6, "SCALAR", 5123, bytes_of<std::uint16_t>({0, 1, 2, 2, 1, 3}));
        g.add(6, "SCALAR", 5125, bytes_of<std::uint32_t>({0, 1, 2, 2, 1, 3}));
        const auto at = g.add_view(bytes_of<std::uint16_t>({3, 1})),
                   values = g.add_view(bytes_of<float>({5, 5, 5, 6, 6, 6}));
        const auto sparse = R"(, "sparse": {"count": 2, "indices": {"componentType": 5123, "bufferView": )"
            + std::to_string(at) + R"(}, "values": {"bufferView": )" + std::to_string(values) + "}}";
        g.add_accessor(4, "VEC3", 5126, sparse);
        g.add_accessor(4, "VEC3", 5126, R"(, "byteOffset": 8, "bufferView": )" + std::to_string(view) + sparse);
        const auto primitive = [](const std::string& position, const std::string& rest) {
            return R"({"attributes": {"POSITION": )" + position + rest + "}";
        };
        const std::string all = R"(, "NORMAL": 1, "TEXCOORD_0": 2, "COLOR_0": 3})";
        const auto s = gltf_scene(g.text(R"("meshes": [{"primitives": [)" + primitive("0", all + R"(, "indices": 4)")
            + ", " + primitive("0", R"(}, "indices": 5)") + ", " + primitive("0", R"(}, "indices": 6)") + ", "
            + primitive("0", R"(}, "mode": 5)") + ", " + primitive("0", R"(}, "mode": 6)") + ", "
            + primitive("7", R"(}, "indices": 4)") + ", " + primitive("8", R"(}, "indices": 4)")
            + R"(]}], "nodes": [{"mesh": 0}])"));
        ASSERT_EQ(s.meshes.size(), 7u);
        const auto& first = *s.meshes[0].surface;
        const std::vector<glm::vec3> corners{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {2, 2, 0}};
        const std::vector<glm::uvec3> two{{0, 1, 2}, {2, 1, 3}};
        EXPECT_EQ(first.positions, corners);
        EXPECT_EQ(first.triangles, two);
        const std::vector<glm::vec3> normals{{0, 0, 1}, {0, 0, 1}, {0, 0, -1}, {0, 64 / 127.0f, 1}};
        EXPECT_EQ(first.normals, normals);
        EXPECT_TRUE(first.texture_coordinates.empty()); // nothing uses them
        const std::vector<glm::vec3> colors{{1, 0, 0}, {0, 1, 0}, {0, 0, 0.2f}, {1, 1, 1}};
        EXPECT_EQ(first.colors, colors);
        for (const std::size_t n : {1u, 2u})
            EXPECT_EQ(s.meshes[n].surface->triangles, two) << n;
        const std::vector<glm::uvec3> strip{{0, 1, 2}, {1, 3, 2}}, fan{{1, 2, 0}, {2, 3, 0}};
        EXPECT_EQ(s.meshes[3].surface->triangles, strip);
        EXPECT_EQ(s.meshes[4].surface->triangles, fan);
        const std::vector<glm::vec3> alone{{0, 0, 0}, {6, 6, 6}, {0, 0, 0}, {5, 5, 5}},
            replaced{{0, 0, 0}, {6, 6, 6}, {0, 2, 0}, {5, 5, 5}};
        EXPECT_EQ(s.meshes[5].surface->positions, alone);
        EXPECT_EQ(s.meshes[6].surface->positions, replaced);
    }

    TEST(gltf_file, morphs_and_poses_meshes)
    {
        gltf_text g;
        g.floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0});
        g.floats("VEC3", 3, {0, 0, 1, 0, 0, 1, 0, 0, 1});
        g.add(3, "VEC4", 5121, bytes_of<std::uint8_t>({0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}));
        g.floats("VEC4", 4, {1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 2, 0, 0, 0});
        g.floats("MAT4", 16,
            {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1});
        const auto s = gltf_scene(g.text(R"("meshes": [
            {"primitives": [{"attributes": {"POSITION": 0}, "targets": [{}, {"POSITION": 1}]}], "weights": [9, 0.5]},
            {"primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 2, "WEIGHTS_0": 3}}]}],
            "skins": [{"joints": [3, 4], "inverseBindMatrices": 4}],
            "nodes": [{"mesh": 0}, {"mesh": 0, "weights": [0, 2]}, {"mesh": 1, "skin": 0, "translation": [99, 0, 0]},
            {"translation": [10, 0, 0], "children": [4]}, {"translation": [0, 4, 0]}])"));
        ASSERT_EQ(s.meshes.size(), 3u);
        expect_near(corners_of(s.meshes[0], 0)[1], {1, 0, 0.5});
        expect_near(corners_of(s.meshes[1], 0)[1], {1, 0, 2});
        // Joint 0 moves by (10, 0, 0), joint 1 by (10, 4, 0) - (0, 1, 0). The node of the mesh does nothing.
        expect_near(corners_of(s.meshes[2], 0)[0], {10, 0, 0});
        expect_near(corners_of(s.meshes[2], 0)[1], {11, 1.5, 0});
        expect_near(corners_of(s.meshes[2], 0)[2], {10, 4, 0}); // weights are made to add up to 1
    }

    TEST(gltf_file, lights_are_photometric)
    {
        const double pi = std::numbers::pi;
        gltf_text g;
        g.floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0});
        const auto light
            = [](int n) { return R"("extensions": {"KHR_lights_punctual": {"light": )" + std::to_string(n) + "}}}"; };
        const auto lit = gltf_scene(g.text(R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [
            {"mesh": 0}, {"translation": [1, 2, 3], "scale": [5, 5, 5], )"
            + light(0) + R"(, {"rotation": [0.70710678118654752, 0, 0, 0.70710678118654752], )" + light(1)
            + R"(, {"translation": [0, 0, 9], )" + light(2) + R"(], "extensions": {"KHR_lights_punctual": {"lights": [
            {"type": "point", "intensity": 683, "color": [1, 0.5, 0]}, {"type": "directional", "intensity": 1366},
            {"type": "spot", "intensity": 68.3, "spot": {"innerConeAngle": 0.5, "outerConeAngle": 1}}]}})"));
        expect_near(lit.point_lights.at(0).position, {1, 2, 3});
        expect_near(lit.point_lights.at(0).power, 4 * pi * dvec3(1, 0.5, 0)); // 683 cd: 1 W/sr
        expect_near(
            glm::normalize(lit.directional_lights.at(0).direction), {0, 1, 0}); // -z turned about x by 90 degrees
        expect_near(lit.directional_lights.at(0).irradiance, dvec3(2));
        const auto& spot = lit.spot_lights.at(0);
        expect_near(spot.direction, {0, 0, -1});
        EXPECT_NEAR(spot.inner_angle, glm::degrees(0.5), 1e-12);
        EXPECT_NEAR(spot.outer_angle, glm::degrees(1.0), 1e-12);
        // A spotlight as bright on its axis as a lamp of 0.1 W/sr, of which the solid angle within 0.5 has all.
        EXPECT_GT(spot.power.x, 0.1 * 2 * pi * (1 - std::cos(0.5)));
        EXPECT_LT(spot.power.x, 0.1 * 2 * pi * (1 - std::cos(1.0)));
    }

    /// 2 x 2 texels: red, green with alpha 0.2; below them blue with alpha 0.8, white.
    const std::string four_colours = R"("data:image/png;base64,)"
                                     "iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAYAAABytg0kAAAAFklEQVR42mP4z8DwHwiNGYD0mf9AAABA"
                                     "0Qj4muWXgwAAAABJRU5ErkJggg==\"";

    TEST(gltf_file, materials_become_photongrids)
    {
        struct material_case {
            const char *text, *name;
            material_kind kind;
            dvec3 reflectance;
            double index, roughness;
        };
        const std::string matte = R"("extensions": {"KHR_materials_specular": {"specularFactor": 0}})";
        const double half = std::sqrt(0.02), index_of_half = (1 + half) / (1 - half); // reflects half of 0.04
        const material_case cases[] = {
            {R"("pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": [0.1, 0.2, 0.3, 1]},
                "extensions": {"KHR_materials_specular": {"specularFactor": 0}})",
                "matte", material_kind::lambertian, {0.1, 0.2, 0.3}, 1.5, 0},
            {R"("pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.25})", "plastic",
                material_kind::plastic, dvec3(1), 1.5, 0.25},
            {R"("pbrMetallicRoughness": {"metallicFactor": 0},
                "extensions": {"KHR_materials_ior": {"ior": 1.8}})",
                "index", material_kind::plastic, dvec3(1), 1.8, 1},
            {R"("pbrMetallicRoughness": {"metallicFactor": 0},
                "extensions": {"KHR_materials_specular": {"specularFactor": 0.5}})",
                "weaker", material_kind::plastic, dvec3(1), index_of_half, 1},
            {R"("pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.8, 0.7, 1], "roughnessFactor": 0.5})", "metal",
                material_kind::metal, {0.9, 0.8, 0.7}, 1.5, 0.5},
            {R"("pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0}, "extensions":
                {"KHR_materials_transmission": {"transmissionFactor": 1},
                "KHR_materials_volume": {"thicknessFactor": 1},
                "KHR_materials_ior": {"ior": 1.4}})",
                "glass", material_kind::glass, dvec3(1), 1.4, 0},
            {R"("pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.5,
                "baseColorFactor": [0.9, 0.8, 0.7, 1]}, "extensions":
                {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.4}})",
                "pane", material_kind::thin_glass, {0.9, 0.8, 0.7}, 1.4, 0.5},
        };
        for (const auto& c : cases) {
            const auto made = parse_gltf("s.gltf",
                triangle_text(R"(, "material": 0}, {"attributes": {"POSITION": 0}, "material": 1)",
                    R"(, "materials": [{"name": "m", )" + std::string(c.text) + R"(}, {"pbrMetallicRoughness":
                    {"metallicFactor": 0}, )"
                        + matte + "}]"));
            const auto& m = made.scene.materials.at(made.scene.meshes.at(0).material);
            EXPECT_EQ(m.kind, c.kind) << c.name;
            expect_near(m.reflectance, c.reflectance);
            EXPECT_NEAR(m.index_of_refraction, c.index, 1e-12) << c.name;
            EXPECT_EQ(m.roughness, c.roughness) << c.name;
            EXPECT_EQ(made.notes.size(), 2u) << c.name << ": " << text_of(made.notes.at(0)); // no camera, no light
        }
        const auto mixed = gltf_scene(triangle_text(R"(, "material": 0)",
            R"(, "materials": [{"name": "m", "pbrMetallicRoughness": {"metallicFactor": 0.75}}])"));
        const auto& m = mixed.materials.at(mixed.meshes.at(0).material);
        EXPECT_EQ(m.kind, material_kind::mixture);
        EXPECT_EQ(m.share, 0.75);
        EXPECT_EQ(mixed.materials.at(m.parts[0]).kind, material_kind::plastic);
        EXPECT_EQ(mixed.materials.at(m.parts[1]).kind, material_kind::metal);
        const auto glossy = gltf_scene(triangle_text(R"(, "material": 0)",
            R"(, "materials": [{"extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [1, 0, 0, 1],
            "specularFactor": [0.04, 0.04, 0.04], "glossinessFactor": 0.75}}}])"));
        EXPECT_EQ(glossy.materials.at(0).kind, material_kind::plastic);
        EXPECT_NEAR(glossy.materials.at(0).index_of_refraction, 1.5, 1e-12);
        EXPECT_EQ(glossy.materials.at(0).roughness, 0.25);
        // Of the light that passes the coat, 0.3 leaves again, however often it goes back and forth below: the sum of a
        // geometric series, with what a coat throws back of even light from below, by Fresnel's formula.
        const auto red = gltf_scene(triangle_text(R"(, "material": 0)",
            R"(, "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0,
            "baseColorFactor": [0.3, 0, 1, 1]}}])"));
        double thrown_back = 0;
        constexpr int steps = 200'000;
        for (int i = 0; i < steps; ++i) {
            const double inside = (i + 0.5) / steps, sine = 1.5 * std::sqrt(1 - inside * inside);
            double reflected = 1;
            if (sine < 1) {
                const double outside = std::sqrt(1 - sine * sine),
                             s = (1.5 * inside - outside) / (1.5 * inside + outside),
                             p = (inside - 1.5 * outside) / (inside + 1.5 * outside);
                reflected = 0.5 * (s * s + p * p);
            }
            thrown_back += 2 * inside * reflected / steps;
        }
        const auto base = red.materials.at(0).reflectance;
        EXPECT_NEAR(base.x * (1 - thrown_back) / (1 - base.x * thrown_back), 0.3, 1e-4);
        EXPECT_EQ(base.y, 0);
        EXPECT_NEAR(base.z, 1, 1e-12);
        // Half of the red light is left after 1 m, whatever the thickness, which is for those who do not trace rays.
        const auto tinted = gltf_scene(triangle_text(R"(, "material": 0}, {"attributes": {"POSITION": 0})",
            R"(, "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0}, "extensions":
                {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_volume": {"thicknessFactor": 2,
                "attenuationColor": [0.5, 1, 0], "attenuationDistance": 1}}}])"));
        expect_near(tinted.materials.at(0).reflectance, dvec3(1));
        expect_near(tinted.materials.at(0).absorption, {std::log(2.0), 0, -std::log(1e-9)});
    }

    /// The scene of a square from (0, 0) to (1, 1), with texture coordinates that go downwards, as the file has them.
    std::string textured(const std::string& material, const std::string& more = "")
    {
        gltf_text g;
        g.floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
        g.floats("VEC2", 2, {0, 1, 1, 1, 1, 0, 0, 0});
        g.floats("VEC2", 2, {0, 0.5f, 0.5f, 0.5f, 0.5f, 0, 0, 0});
        g.add(6, "SCALAR", 5121, bytes_of<std::uint8_t>({0, 1, 2, 0, 2, 3}));
        return g.text(R"("meshes": [{"primitives": [
            {"attributes": {"POSITION": 0, "TEXCOORD_0": 1, "TEXCOORD_1": 2}, "indices": 3, "material": 0}]}],
            "nodes": [{"mesh": 0}], "textures": [{"source": 0, "sampler": 0}], "samplers": [{"wrapS": 33071,
            "wrapT": 33071}], "images": [{"uri": )"
            + four_colours + R"(}], "materials": [)" + material + "]" + more);
    }

    /// The texel of a texture that lies at a place of the square, by the conventions of texture_use.
    glm::dvec4 texel_of(const scene& s, const texture_use& t, double x, double y)
    {
        const auto& m = *s.meshes.at(0).surface;
        const glm::dvec2 from = m.texture_coordinates.at(0), right = glm::dvec2(m.texture_coordinates.at(1)) - from,
                         up = glm::dvec2(m.texture_coordinates.at(3)) - from;
        const auto at = t.scale * (from + x * right + y * up) + t.offset;
        const auto cell
            = [](double v, std::uint32_t n) { return static_cast<std::uint32_t>(std::clamp(v * n, 0.0, n - 0.5)); };
        return glm::dvec4(t.map->texels.at(
                   std::size_t{cell(1 - at.y, t.map->height)} * t.map->width + cell(at.x, t.map->width)))
            / 65535.0;
    }

    TEST(gltf_file, textures_lie_as_in_gltf)
    {
        const dvec3 red(1, 0, 0), green(0, 1, 0), blue(0, 0, 1), white(1);
        const auto base = [](const std::string& more) {
            return R"({"pbrMetallicRoughness": {"metallicFactor": 0, "baseColorTexture": {"index": 0)" + more + "}}}";
        };
        const auto transform
            = [&](const std::string& t) { return base(R"(, "extensions": {"KHR_texture_transform": {)" + t + "}}"); };
        struct texture_case {
            std::string material;
            std::array<dvec3, 4> corners; ///< lower left, lower right, upper left, upper right
        };
        const texture_case cases[]
            = {{base(""), {blue, white, red, green}}, {base(R"(, "texCoord": 1)"), {red, red, red, red}},
                // (u, v) -> (u / 2, v / 2 + 0.5): the lower left texel.
                {transform(R"("scale": [0.5, 0.5], "offset": [0, 0.5])"), {blue, blue, blue, blue}},
                {transform(R"("scale": [0.5, 0.5], "offset": [0.5, 0])"), {green, green, green, green}},
                {transform(R"("texCoord": 1, "offset": [0.5, 0])"), {green, green, green, green}},
                // (u, v) -> (v, -u + 1): rotation by 90 degrees as the extension has it, offset (0, 1).
                {transform(R"("rotation": 1.5707963267948966, "offset": [0, 1])"), {white, green, blue, red}}};
        for (const auto& c : cases) {
            const auto s = gltf_scene(textured(c.material));
            const auto& m = s.materials.at(0);
            ASSERT_TRUE(m.texture.map) << c.material;
            EXPECT_EQ(m.texture.wrap, texture_wrap::clamp);
            std::size_t n = 0;
            for (const double y : {0.1, 0.9})
                for (const double x : {0.1, 0.9})
                    expect_near(dvec3(texel_of(s, m.texture, x, y)), c.corners[n++], 1e-4);
        }
    }

    TEST(gltf_file, opacity_and_channels_of_textures)
    {
        const std::string matte = R"(, "extensions": {"KHR_materials_specular": {"specularFactor": 0}})";
        const auto base = [&](const std::string& more) {
            return gltf_scene(textured(R"({"pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor":
                [1, 1, 1, 0.5], "baseColorTexture": {"index": 0}})"
                + matte + more + "}"));
        };
        const auto opaque = base("");
        EXPECT_EQ(opaque.materials.at(0).opacity, 1);
        EXPECT_FALSE(opaque.materials.at(0).opacity_texture.map);
        const auto blended = base(R"(, "alphaMode": "BLEND")");
        const auto& b = blended.materials.at(blended.meshes.at(0).material);
        EXPECT_EQ(b.opacity, 0.5);
        EXPECT_EQ(b.opacity_texture.channel, texture_channel::alpha);
        EXPECT_NEAR(texel_of(blended, b.opacity_texture, 0.9, 0.9).w, 0.2, 1e-4); // green
        const auto cut = base(R"(, "alphaMode": "MASK", "alphaCutoff": 0.3)");
        const auto& c = cut.materials.at(cut.meshes.at(0).material);
        EXPECT_EQ(c.opacity, 1);
        EXPECT_EQ(texel_of(cut, c.opacity_texture, 0.1, 0.1).w, 1); // 0.8 x 0.5 is above 0.3
        EXPECT_EQ(texel_of(cut, c.opacity_texture, 0.9, 0.9).w, 0); // 0.2 x 0.5 is not
        // Green is the roughness, blue what is metal.
        const auto metal = gltf_scene(textured(R"({"pbrMetallicRoughness": {"roughnessFactor": 0.5,
            "metallicRoughnessTexture": {"index": 0}}})"));
        const auto& m = metal.materials.at(metal.meshes.at(0).material);
        ASSERT_EQ(m.kind, material_kind::mixture);
        EXPECT_EQ(m.share, 1);
        EXPECT_EQ(m.share_texture.channel, texture_channel::blue);
        const auto& part = metal.materials.at(m.parts[1]);
        EXPECT_EQ(part.roughness, 0.5);
        EXPECT_EQ(part.roughness_texture.channel, texture_channel::green);
    }

    TEST(gltf_file, surfaces_that_emit_are_lamps)
    {
        const double pi = std::numbers::pi;
        const std::string black = R"("pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": [0, 0, 0, 1]})",
                          strong = R"(, "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 6830}})";
        const auto lamp_of = [&](const std::string& more) {
            gltf_text g;
            g.floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0});
            return parse_gltf("s.gltf",
                g.text(R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0},
                {"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0, "scale": [2, 2, -2]}], "materials": [{)"
                    + more + "}]"));
        };
        const auto lit = lamp_of(black + R"(, "emissiveFactor": [1, 0.5, 0.25])" + strong).scene;
        const auto& l = lit.mesh_lights.at(0);
        expect_near(l.power, dvec3(10, 5, 2.5) * (2 * pi)); // 10 W/(m^2 sr), 2 m^2
        // The front is counterclockwise, and where a node mirrors, as here, clockwise: +z.
        const auto c = corners_of(l.surface, 0);
        EXPECT_GT(glm::cross(c[1] - c[0], c[2] - c[0]).z * -1, 0); // mirrored along z, so -z of the scene
        const auto both = lamp_of(black + R"(, "doubleSided": true, "emissiveFactor": [1, 0.5, 0.25])" + strong).scene;
        expect_near(both.mesh_lights.at(0).power, dvec3(10, 5, 2.5) * (4 * pi), 1e-3);
        const auto grey = notes_of(lamp_of(R"("name": "g", "emissiveFactor": [1, 1, 1])"));
        EXPECT_TRUE(std::any_of(grey.begin(), grey.end(), [](const std::string& n) {
            return n.ends_with(": note: material \"g\": the surface of a lamp: black; what it reflects is left out");
        }));

        // A square whose left half is black: the triangles that touch the right half emit.
        const std::string half = R"("data:image/png;base64,)"
                                 "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAADklEQVR42mNgYGD4DwIADvoE/FjYU/0A"
                                 "AAAASUVORK5CYII=\"";
        gltf_text g;
        g.floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0, 2, 1, 0});
        g.floats("VEC2", 2, {0, 1, 0.5f, 1, 0.5f, 0, 0, 0, 1, 1, 1, 0});
        g.add(12, "SCALAR", 5121, bytes_of<std::uint8_t>({0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2}));
        const auto split = gltf_scene(g.text(R"("meshes": [{"primitives": [
            {"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}]}], "nodes": [{"mesh": 0}],
            "textures": [{"source": 0}], "images": [{"uri": )"
            + half + R"(}], "materials": [{)" + black
            + R"(, "emissiveTexture": {"index": 0}, "emissiveFactor": [1, 1, 1])" + strong + "}]"));
        ASSERT_EQ(split.meshes.size(), 1u);
        EXPECT_EQ(split.meshes[0].surface->triangles.size(), 2u);
        ASSERT_EQ(split.rectangle_lights.size(), 1u);
        expect_near(split.rectangle_lights[0].power, dvec3(10 * pi), 1e-3);
        EXPECT_EQ(split.rectangle_lights[0].corner.x, 1);
    }

    TEST(gltf_file, what_is_replaced_or_left_out_is_noted_with_its_place)
    {
        struct note_case {
            std::string text;
            const char* note;
        };
        const auto material = [](const std::string& more) {
            return triangle_text(
                R"(, "material": 0}, {"attributes": {"POSITION": 0})", ",\n\"materials\": [{" + more + "}]");
        };
        const note_case cases[] = {
            {triangle_text("", ""), "s.gltf:2:28: note: surfaces without a material: drawn as diffuse 0.5"},
            {triangle_text(R"(}, {"attributes": {"POSITION": 0}, "mode": 1)", ""),
                "s.gltf:2:61: note: mesh 0: its points or lines are left out"},
            {material(R"("name": "n", "normalTexture": {"index": 0})"),
                "s.gltf:4:15: note: material \"n\": its map of normals is left out"},
            {material(R"("extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1}})"),
                "s.gltf:4:15: note: material 0: drawn without its clear coat"},
            {material(R"("extensions": {"KHR_materials_unlit": {}})"),
                "s.gltf:4:15: note: material 0: is unlit: drawn as diffuse, in the scene's light"},
            {triangle_text("", ",\n\"animations\": [{}]"),
                "s.gltf:4:16: note: animations are left out: everything is where the nodes have it"},
            {triangle_text("", ",\n\"extensionsUsed\": [\"X_y\"]"),
                "s.gltf:4:20: note: extension \"X_y\": is left out"},
        };
        for (const auto& c : cases) {
            const auto notes = notes_of(parse_gltf("s.gltf", c.text));
            EXPECT_TRUE(std::find(notes.begin(), notes.end(), c.note) != notes.end())
                << c.note << "\n"
                << (notes.empty() ? "(none)" : notes[0]);
            EXPECT_NE(refusal_by([&] { return parse_gltf("s.gltf", c.text, {.strict = true}); }), "") << c.note;
        }
    }

    TEST(gltf_file, refuses_with_the_place)
    {
        struct refusal_case {
            std::string text;
            const char* said;
        };
        const std::string asset = R"({"asset": {"version": "2.0"},)"
                                  "\n";
        gltf_text short_view;
        short_view.add_accessor(
            4, "VEC3", 5126, R"(, "bufferView": )" + std::to_string(short_view.add_view(std::string(36, '\0'))));
        const refusal_case cases[] = {
            {"",
                "s.gltf:1:1: error: syntax error while parsing value - unexpected end of input; expected '[', '{', or "
                "a "
                "literal"},
            {"[]", "s.gltf:1:1: error: found an array of 0; expected the object of a glTF file"},
            {R"({"asset": {"version": "1.0"}})", "s.gltf:1:11: error: found version \"1.0\" of glTF; expected 2.0"},
            {asset + R"("nodes": [{"children": [1]}, {"children": [0]}]})",
                "s.gltf:2:11: error: the node is a child of itself, or of one below it"},
            {asset + R"("nodes": [{"children": [2]}, {"children": [2]}, {}]})",
                "s.gltf:2:44: error: node 2 has two parents"},
            {asset + R"("nodes": [{"mesh": 0}]})",
                "s.gltf:2:20: error: found the number 0; expected an index of \"meshes\", of which there are 0"},
            {asset + R"("nodes": [{"rotation": [0, 0, 0, 0]}]})",
                "s.gltf:2:11: error: the rotation is 0; expected a unit quaternion"},
            {asset + R"("nodes": [{"scale": [1, 2]}]})",
                "s.gltf:2:21: error: \"scale\": found an array of 2; expected 3 numbers"},
            {asset + R"("extensionsRequired": ["KHR_draco_mesh_compression"]})",
                "s.gltf:2:24: error: the meshes are compressed (KHR_draco_mesh_compression), which photongrid does not "
                "read; export them uncompressed"},
            {asset + R"("extensionsRequired": ["X_y"]})",
                "s.gltf:2:24: error: the file requires \"X_y\", which photongrid does not read"},
            {short_view.text(
                 R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}])"),
                "s.gltf:1:241: error: the accessor reaches beyond the end of its buffer view"},
            {triangle_text(R"(, "indices": 0)", ""),
                "s.gltf:1:241: error: found an accessor of 3 numbers for each element; expected 1"},
            {triangle_text("", R"(, "buffers": 3)"),
                "s.gltf:3:53: error: key \"buffers\" is given twice; expected each key "
                "once"},
            {asset + R"("nodes": []})", "s.gltf: error: the scene has no shape that can be drawn"},
            {"glTF", "s.gltf: error: the file ends within its header"},
            {"glTF" + bytes_of<std::uint32_t>({1, 20, 0, 0}),
                "s.gltf: error: found version 1 of binary glTF; expected 2"},
            {"glTF" + bytes_of<std::uint32_t>({2, 20, 99, 0x4E4F534A}),
                "s.gltf: error: a chunk of the file reaches beyond its end"},
        };
        for (const auto& c : cases)
            EXPECT_EQ(refusal_by([&] { return parse_gltf("s.gltf", c.text); }), c.said) << c.text;
        // The elements of a .glb, which nobody can count lines in, are named by JSON pointers.
        std::string json = asset + R"("nodes": [{}, {"mesh": 7}]})";
        json.resize((json.size() + 3) / 4 * 4, ' ');
        const auto size = static_cast<std::uint32_t>(json.size());
        EXPECT_EQ(refusal_by([&] {
            return parse_gltf("s.glb", "glTF" + bytes_of<std::uint32_t>({2, size + 20, size, 0x4E4F534A}) + json);
        }),
            "s.glb#/nodes/1/mesh: error: found the number 7; expected an index of \"meshes\", of which there are 0");
    }

    TEST_F(import_folder, reads_gltf_with_its_files)
    {
        gltf_text g;
        g.floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0});
        const std::string rest = R"("bufferViews": [{"buffer": 0, "byteLength": 36}], "accessors": [{"bufferView": 0,
            "count": 3, "type": "VEC3", "componentType": 5126}], "meshes": [{"primitives": [{"attributes":
            {"POSITION": 0}}]}], "nodes": [{"mesh": 0}]})";
        const auto file = [&](const std::string& uri) {
            return R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 36)" + uri + "}], " + rest;
        };
        write("a buffer+1.bin", g.buffer() + "more than its length");
        write("s.gltf", file(R"(, "uri": "a%20buffer+1.bin")"));
        const auto s = import_scene((folder / "s.gltf").string()).scene;
        EXPECT_EQ(s.meshes.at(0).surface->positions.at(1), glm::vec3(1, 0, 0));
        auto json = file("");
        json.resize((json.size() + 3) / 4 * 4, ' ');
        const auto size = static_cast<std::uint32_t>(json.size());
        write("s.glb",
            "glTF" + bytes_of<std::uint32_t>({2, size + 64, size, 0x4E4F534A}) + json
                + bytes_of<std::uint32_t>({36, 0x004E4942}) + g.buffer());
        EXPECT_EQ(*import_scene((folder / "s.glb").string()).scene.meshes.at(0).surface, *s.meshes.at(0).surface);
        write("s.gltf", file(R"(, "uri": "../outside.bin")"));
        const auto refused = refusal_by([&] { return import_scene((folder / "s.gltf").string()); });
        EXPECT_NE(refused.find("s.gltf:1:69: error: "), std::string::npos) << refused;
        EXPECT_NE(refused.find("lies outside of the scene's folder"), std::string::npos) << refused;
    }

    TEST_F(import_folder, camera_and_environment_of_other_files_replace_the_scenes)
    {
        write("s.gltf", triangle_text("", ""));
        write("camera.pbrt",
            "Film \"rgb\" \"integer xresolution\" 30 \"integer yresolution\" 20\nScale -1 1 1\nLookAt 1 2 9 "
            "0 0 0 0 1 0\nCamera \"perspective\" \"float fov\" 35\nWorldBegin\nShape \"sphere\"\n");
        image sky{.width = 2, .height = 1, .pixels = {{1, 2, 3}, {4, 5, 6}}};
        write_image((folder / "sky.pfm").string(), sky);
        const auto path = [&](const char* name) { return (folder / name).string(); };
        const auto made = import_scene(
            path("s.gltf"), {.strict = false, .camera_from = path("camera.pbrt"), .environment = path("sky.pfm")});
        expect_near(made.scene.camera.position, {1, 2, 9});
        EXPECT_NEAR(made.scene.camera.vertical_fov, 35, 1e-12);
        EXPECT_EQ(made.scene.render.output.width, 30u);
        EXPECT_EQ(made.scene.render.output.height, 20u);
        ASSERT_EQ(made.scene.environment_lights.size(), 1u);
        EXPECT_EQ(made.scene.environment_lights[0].map->radiance, sky.pixels);
        for (const auto& n : notes_of(made)) // no camera or light was added
            EXPECT_EQ(n.find("is added"), std::string::npos) << n;
        const auto own = import_scene(std::string(PHOTONGRID_SCENES) + "/ring.json", {.environment = path("sky.pfm")});
        EXPECT_EQ(own.scene.environment_lights.at(0).map->radiance, sky.pixels);
        EXPECT_NE(refusal_by([&] { return import_scene(path("s.gltf"), {.environment = path("no.hdr")}); }), "");
    }

} // namespace
} // namespace photongrid

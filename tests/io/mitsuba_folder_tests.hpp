// Files that scenes of Mitsuba name: included ones, surfaces, textures and environments.
#pragma once

#include "mitsuba_file_tests.hpp"

#include <zlib.h>

#include <cstring>

namespace photongrid {
namespace {

    class mitsuba_folder : public import_folder {
    protected:
        imported_scene made(const std::string& body)
        {
            write("s.xml", xml_scene(body + "<sensor type=\"perspective\"/>" + xml_lamp));
            return import_scene((folder / "s.xml").string());
        }
        std::string refused(const std::string& body)
        {
            return refusal_by([&] { return made(body); });
        }
    };

    std::string file_shape(const std::string& type, const std::string& file, const std::string& more = "")
    {
        return "<shape type=\"" + type + "\"><string name=\"filename\" value=\"" + file + "\"/>" + more + "</shape>";
    }

    /// A square of z = 0 whose texture coordinates are x and y.
    const std::string square_ply
        = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty "
          "float u\nproperty float v\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 0 0\n1 "
          "0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n4 0 1 2 3\n",
        square_obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";

    TEST_F(mitsuba_folder, reads_files_that_it_names)
    {
        write("below/square.ply", square_ply);
        write("below/more.xml", xml_scene(file_shape("ply", "below/square.ply") + "<default name=\"r\" value=\"3\"/>"));
        write("below/ball.xml",
            "<?xml version=\"1.0\"?>\n<!-- one object -->\n<shape type=\"sphere\"><float name=\"radius\" "
            "value=\"$r\"/></shape>");
        const auto s = made("<include filename=\"below/more.xml\"/>" + file_shape("ply", "below\\square.ply")
            + "<include filename=\"below/ball.xml\"/>");
        ASSERT_EQ(s.scene.meshes.size(), 2u);
        EXPECT_EQ(s.scene.spheres.at(0).radius, 3);
        EXPECT_EQ(format_of_file((folder / "s.xml").string()), scene_format::mitsuba);
        const auto two = made(file_shape("ply", "below/square.ply") + file_shape("ply", "below/square.ply"));
        EXPECT_EQ(two.scene.meshes[0].surface, two.scene.meshes[1].surface); // read once

        EXPECT_NE(refused("<include filename=\"s.xml\"/>").find("does one include itself?"), std::string::npos);
        write("bad.xml", "<scene version=\"3.0.0\">\n <shpae/>\n</scene>");
        EXPECT_EQ(refused("<include filename=\"bad.xml\"/>"),
            (folder / "bad.xml").string()
                + ":2:2: error: found <shpae>; expected an element of Mitsuba, perhaps "
                  "<shape>");
        std::filesystem::create_symlink("/etc/passwd", folder / "link.ply");
        EXPECT_NE(refused(file_shape("ply", "link.ply")).find("lies outside of the scene's folder"), std::string::npos);
    }

    TEST_F(mitsuba_folder, meshes_without_normals_look_smooth_and_face_as_wound)
    {
        // A corner of a cube: three squares' triangles meet there, with a right angle each.
        write("corner.ply",
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement "
            "face 3\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 3 "
            "2\n3 0 1 3\n");
        const auto smooth = made(file_shape("ply", "corner.ply")).scene.meshes.at(0);
        ASSERT_EQ(smooth.surface->normals.size(), 4u);
        expect_near(dvec3(smooth.surface->normals[0]), glm::normalize(dvec3(-1)), 1e-6);
        EXPECT_EQ(normal_of_triangle(smooth), dvec3(0, 0, -1));
        const auto flat = made(file_shape("ply", "corner.ply", "<boolean name=\"face_normals\" value=\"true\"/>"))
                              .scene.meshes.at(0);
        EXPECT_TRUE(flat.surface->normals.empty());
        EXPECT_EQ(flat.file, "corner.ply");
        const auto reversed = made(file_shape("ply", "corner.ply", "<boolean name=\"flip_normals\" value=\"true\"/>"))
                                  .scene.meshes.at(0);
        EXPECT_EQ(normal_of_triangle(reversed), dvec3(0, 0, 1));
        expect_near(dvec3(reversed.surface->normals[0]), glm::normalize(dvec3(1)), 1e-6);
        // Normals of a file decide which side is outside, as in Mitsuba.
        write("down.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 -1\nf 1//1 2//1 3//1\n");
        const auto down = made(file_shape("obj", "down.obj")).scene.meshes.at(0);
        EXPECT_EQ(normal_of_triangle(down), dvec3(0, 0, -1));
    }

    /// A picture of 2 x 2 texels: red and green above, blue and white below.
    const std::string four_texels("\0\0\2\0\0\0\0\0\0\0\0\0\2\0\2\0\x18\x20" // TGA, rows from the top
                                  "\0\0\xff\0\xff\0\xff\0\0\xff\xff\xff",
        30);

    /// The texel at texture coordinates by the convention of scene/texture.hpp, without interpolation.
    glm::u16vec4 texel_at(const texture_use& t, glm::dvec2 coordinates)
    {
        const auto at = t.scale * coordinates + t.offset;
        const auto cell = [](double c, std::uint32_t n) {
            return std::min(static_cast<std::uint32_t>((c - std::floor(c)) * n), n - 1);
        };
        return t.map->texels[std::size_t{cell(1 - at.y, t.map->height)} * t.map->width + cell(at.x, t.map->width)];
    }

    /// The texel at a place of a mesh that is a function of x and y, by the first triangle that has it.
    glm::u16vec4 texel_on(const scene& s, const dvec3& place)
    {
        const auto& m = s.meshes.at(0);
        for (std::size_t n = 0; n < m.surface->triangles.size(); ++n) {
            const auto& t = m.surface->triangles[n];
            const auto c = corners_of(m, n);
            const auto normal = glm::cross(c[1] - c[0], c[2] - c[0]);
            if (std::abs(glm::dot(normal, place - c[0])) > 1e-9)
                continue;
            dvec3 weights;
            for (int k = 0; k < 3; ++k)
                weights[k] = glm::dot(glm::cross(c[static_cast<std::size_t>((k + 1) % 3)] - place,
                                          c[static_cast<std::size_t>((k + 2) % 3)] - place),
                                 normal)
                    / glm::dot(normal, normal);
            if (weights.x < -1e-9 || weights.y < -1e-9 || weights.z < -1e-9)
                continue;
            glm::dvec2 at(0);
            for (int k = 0; k < 3; ++k)
                at += weights[k] * glm::dvec2(m.surface->texture_coordinates.at(t[k]));
            return texel_at(s.materials.at(m.material).texture, at);
        }
        ADD_FAILURE() << "no triangle there";
        return {};
    }

    // In Mitsuba the first row of a picture is at v = 0, and v of OBJ files is reversed.
    TEST_F(mitsuba_folder, pictures_lie_on_surfaces_as_in_mitsuba)
    {
        write("four.tga", four_texels);
        write("square.ply", square_ply);
        write("square.obj", square_obj);
        const glm::u16vec4 red(65535, 0, 0, 65535), green(0, 65535, 0, 65535), blue(0, 0, 65535, 65535), white(65535);
        const auto picture = [](const std::string& more = "") {
            return "<bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"bitmap\"><string name=\"filename\" "
                   "value=\"four.tga\"/>"
                + more + "</texture></bsdf>";
        };
        const auto flip = [](const char* value) {
            return "<boolean name=\"flip_tex_coords\" value=\"" + std::string(value) + "\"/>";
        };
        const auto on = [&](const std::string& shape, const dvec3& a, const dvec3& b, const dvec3& c) {
            const auto s = made(shape);
            EXPECT_TRUE(s.notes.empty()) << notes_of(s).at(0);
            return std::array{texel_on(s.scene, a), texel_on(s.scene, b), texel_on(s.scene, c)};
        };
        // At the lower left, the lower right and the upper left of the square.
        const dvec3 a(0.2, 0.3, 0), b(0.8, 0.3, 0), c(0.2, 0.8, 0);
        using texels = std::array<glm::u16vec4, 3>;
        const texels from_the_top{red, green, blue}, from_below{blue, white, red};
        EXPECT_EQ(on(file_shape("ply", "square.ply", picture()), a, b, c), from_the_top);
        EXPECT_EQ(on(file_shape("ply", "square.ply", picture() + flip("true")), a, b, c), from_below);
        EXPECT_EQ(on(file_shape("obj", "square.obj", picture()), a, b, c), from_below);
        EXPECT_EQ(on(file_shape("obj", "square.obj", picture() + flip("false")), a, b, c), from_the_top);
        EXPECT_EQ(
            on("<shape type=\"rectangle\">" + picture() + "</shape>", {-0.6, -0.4, 0}, {0.6, -0.4, 0}, {-0.6, 0.6, 0}),
            from_the_top);
        // to_uv: Mitsuba's coordinates times a half, plus a half along v: the lower row of the picture, left texel.
        EXPECT_EQ(on(file_shape("ply", "square.ply",
                         picture(transform("<scale x=\"0.5\" y=\"0.5\"/><translate y=\"0.5\"/>", "to_uv"))),
                      a, b, c),
            (texels{blue, blue, blue}));
        EXPECT_EQ(on(file_shape("ply", "square.ply",
                         picture("<float name=\"uscale\" value=\"0.5\"/><float name=\"uoffset\" value=\"0.5\"/>")),
                      a, b, c),
            (texels{green, green, white}));
        // The sides of a cube: u along y and v along x on that of +z (Mitsuba's table of its cube).
        EXPECT_EQ(on("<shape type=\"cube\">" + picture() + "</shape>", {-0.6, -0.4, 1}, {0.6, -0.4, 1}, {-0.6, 0.6, 1}),
            (texels{red, blue, green}));
        EXPECT_EQ(on("<shape type=\"cube\">" + picture() + "</shape>", {0.6, 1, 0.6}, {-0.6, 1, 0.6}, {0.6, 1, -0.6}),
            (texels{red, green, blue}));
        // Color0 of a checkerboard is where both halves of u and v are the same.
        const auto checks = made("<shape type=\"rectangle\"><bsdf type=\"diffuse\"><texture name=\"reflectance\" "
                                 "type=\"checkerboard\"><rgb name=\"color0\" value=\"1\"/><rgb name=\"color1\" "
                                 "value=\"0\"/>"
            + transform("<scale x=\"2\" y=\"1\"/>", "to_uv") + "</texture></bsdf></shape>");
        const auto is_white = [&](double u, double v) {
            return texel_on(checks.scene, {2 * u - 1, 2 * v - 1, 0}).x > 32767;
        };
        EXPECT_TRUE(is_white(0.1, 0.2));
        EXPECT_FALSE(is_white(0.3, 0.2));
        EXPECT_FALSE(is_white(0.1, 0.7));
        EXPECT_TRUE(is_white(0.3, 0.7));
        EXPECT_TRUE(is_white(0.6, 0.2));
    }

    TEST_F(mitsuba_folder, round_shapes_with_pictures_have_mitsubas_coordinates)
    {
        write("four.tga", four_texels);
        const std::string picture = "<bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"bitmap\"><string "
                                    "name=\"filename\" value=\"four.tga\"/></texture></bsdf>";
        const auto check = [&](const std::string& shape, const auto& coordinates) {
            const auto s = made(shape + picture + "</shape>").scene;
            const auto& m = *s.meshes.at(0).surface;
            double worst = 0;
            for (std::size_t i = 0; i < m.positions.size(); ++i) {
                const dvec3 p = place_of(s.meshes[0], m.positions[i]);
                const glm::dvec2 expected = coordinates(p), got(m.texture_coordinates[i]);
                if (std::isnan(expected.x + expected.y))
                    continue; // the angle around an axis, on it
                double u = std::abs(got.x - expected.x), v = std::abs(1 - got.y - expected.y);
                worst = std::max({worst, std::min(u, 1 - u), std::min(v, 1 - v)});
            }
            EXPECT_LT(worst, 1e-5) << shape;
        };
        const auto around = [](double x, double y) {
            const double angle = std::atan2(y, x) / (2 * std::numbers::pi);
            return std::hypot(x, y) < 1e-6 ? std::nan("") : angle < 0 ? angle + 1 : angle;
        };
        check("<shape type=\"sphere\"><point name=\"center\" value=\"1, 2, 3\"/>", [&](const dvec3& p) {
            const dvec3 d = p - dvec3(1, 2, 3);
            return glm::dvec2(around(d.x, d.y), std::acos(std::clamp(d.z, -1.0, 1.0)) / std::numbers::pi);
        });
        check("<shape type=\"cylinder\"><point name=\"p1\" value=\"0, 0, 4\"/>",
            [&](const dvec3& p) { return glm::dvec2(around(p.x, p.y), p.z / 4); });
        check("<shape type=\"disk\">",
            [&](const dvec3& p) { return glm::dvec2(std::hypot(p.x, p.y), around(p.x, p.y)); });
    }

    TEST_F(mitsuba_folder, opacity_and_roughness_may_be_pictures)
    {
        write("four.tga", four_texels);
        const auto picture = [](const char* name) {
            return "<texture name=\"" + std::string(name)
                + "\" type=\"bitmap\"><boolean name=\"raw\" value=\"true\"/><string name=\"filename\" "
                  "value=\"four.tga\"/></texture>";
        };
        const auto s = made("<shape type=\"rectangle\"><bsdf type=\"mask\">" + picture("opacity")
            + "<bsdf type=\"diffuse\"/></bsdf></shape><shape type=\"rectangle\"><bsdf type=\"roughconductor\"><string "
              "name=\"distribution\" value=\"ggx\"/>"
            + picture("alpha") + "</bsdf></shape>");
        EXPECT_TRUE(s.notes.empty());
        const auto& clear = s.scene.materials.at(s.scene.meshes.at(0).material);
        EXPECT_EQ(clear.opacity, 1);
        // Luminances, of Rec. 709.
        EXPECT_NEAR(texel_at(clear.opacity_texture, {0.2, 0.8}).x, 0.2126 * 65535, 1);
        EXPECT_NEAR(texel_at(clear.opacity_texture, {0.8, 0.8}).x, 0.7152 * 65535, 1);
        const auto& rough = s.scene.materials.at(s.scene.meshes.at(1).material);
        EXPECT_NEAR(texel_at(rough.roughness_texture, {0.2, 0.8}).x, std::sqrt(0.2126) * 65535, 1);
    }

    TEST_F(mitsuba_folder, environments_have_mitsubas_directions)
    {
        // 4 x 2 texels, of which the one in row 0, column 1 is red. PFM begins below.
        std::vector<float> numbers(24, 0.25f);
        numbers[12 + 3] = 7;
        std::string picture = "PF\n4 2\n-1.0\n";
        picture.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float));
        write("sky.pfm", picture);
        const auto turn = glm::rotate(glm::dmat4(1), glm::radians(30.0), dvec3(0, 1, 0));
        for (const bool is_turned : {false, true}) {
            const auto s = made(xml_ball
                + "<emitter type=\"envmap\"><string name=\"filename\" value=\"sky.pfm\"/><float "
                  "name=\"scale\" value=\"2\"/>"
                + (is_turned ? transform("<rotate y=\"1\" angle=\"30\"/>") : "") + "</emitter>");
            EXPECT_TRUE(s.notes.empty());
            const auto& l = s.scene.environment_lights.at(0);
            EXPECT_EQ(l.radiance, dvec3(2));
            ASSERT_EQ(l.map->radiance.size(), 8u);
            EXPECT_EQ(l.map->radiance[1].x, 7);
            // Mitsuba: u = atan2(x, -z) / 2 pi, v = acos(y) / pi. The middle of that texel is u = 3/8, v = 1/4.
            const double angle = 2 * std::numbers::pi * 3 / 8, down = std::numbers::pi / 4;
            const dvec3 there(std::sin(angle) * std::sin(down), std::cos(down), -std::cos(angle) * std::sin(down));
            expect_near(environment_direction(0.375, 0.25), there);
            const auto turned = glm::rotate(glm::dmat4(1), glm::radians(l.degrees), l.axis);
            expect_near(
                dvec3(turned * glm::dvec4(there, 0)), is_turned ? dvec3(turn * glm::dvec4(there, 0)) : there, 1e-9);
        }
    }

    // --- serialized files ---
    template <class Number>
    void put(std::string& bytes, Number n)
    {
        bytes.append(reinterpret_cast<const char*>(&n), sizeof n);
    }

    /// A surface in the format of Mitsuba 0.6's documentation: a triangle at height z with everything.
    template <class Real>
    std::string packed_triangle(unsigned version, double z)
    {
        std::string plain;
        put(plain, std::uint32_t{0x000B} | (sizeof(Real) == 8 ? 0x2000u : 0x1000u)); // normals, coordinates, colours
        if (version == 4)
            plain.append("name", 5);
        put(plain, std::uint64_t{3});
        put(plain, std::uint64_t{1});
        for (const double n : {0.0, 0.0, z, 1.0, 0.0, z, 0.0, 1.0, z, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0,
                 0.0, 1.0, 0.0, 0.0, 1.0, 0.25, 0.5, 0.75, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0})
            put(plain, static_cast<Real>(n));
        for (const std::uint32_t i : {0u, 1u, 2u})
            put(plain, i);
        auto size = compressBound(plain.size());
        std::string packed(size, '\0');
        EXPECT_EQ(compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(plain.data()),
                      plain.size()),
            Z_OK);
        packed.resize(size);
        std::string all;
        put(all, std::uint16_t{0x041C});
        put(all, static_cast<std::uint16_t>(version));
        return all + packed;
    }
    template <class Real>
    std::string serialized_file(unsigned version)
    {
        auto file = packed_triangle<Real>(version, 5);
        const auto second = file.size();
        file += packed_triangle<Real>(version, 6);
        if (version == 4) {
            put(file, std::uint64_t{0});
            put(file, std::uint64_t{second});
        } else {
            put(file, std::uint32_t{0});
            put(file, static_cast<std::uint32_t>(second));
        }
        put(file, std::uint32_t{2});
        return file;
    }

    TEST_F(mitsuba_folder, reads_serialized_files)
    {
        const std::string second = "<integer name=\"shapeIndex\" value=\"1\"/>";
        for (const unsigned version : {3u, 4u})
            for (const bool is_double : {false, true}) {
                write("s.serialized", is_double ? serialized_file<double>(version) : serialized_file<float>(version));
                const auto s
                    = made(file_shape("serialized", "s.serialized") + file_shape("serialized", "s.serialized", second));
                ASSERT_EQ(s.scene.meshes.size(), 2u);
                for (std::size_t n = 0; n < 2; ++n) {
                    const auto& m = *s.scene.meshes[n].surface;
                    const float z = n == 0 ? 5 : 6;
                    EXPECT_EQ(m.positions, (std::vector<glm::vec3>{{0, 0, z}, {1, 0, z}, {0, 1, z}}));
                    EXPECT_EQ(m.normals, (std::vector<glm::vec3>(3, {0, 0, 1})));
                    EXPECT_EQ(m.triangles, (std::vector<glm::uvec3>{{0, 1, 2}}));
                    EXPECT_TRUE(m.colors.empty()); // no texture asks for them
                }
                const auto colored = made(file_shape("serialized", "s.serialized",
                    "<bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"vertexcolors\"/></bsdf>"));
                EXPECT_EQ(colored.scene.meshes.at(0).surface->colors,
                    (std::vector<glm::vec3>{{0.25, 0.5, 0.75}, {1, 1, 1}, {0, 0, 0}}));
            }
        EXPECT_NE(refused(file_shape("serialized", "s.serialized", "<integer name=\"shape_index\" value=\"2\"/>"))
                      .find("has no surface 2; its table at the end has 2, counted from 0"),
            std::string::npos);
        write("other.serialized", "\x1c\x04\x09\x01");
        EXPECT_NE(refused(file_shape("serialized", "other.serialized")).find("is of version 265"), std::string::npos);
    }

    TEST_F(mitsuba_folder, serialized_files_survive_damage)
    {
        const auto whole = serialized_file<float>(4);
        std::size_t refusals = 0;
        for (std::size_t n = 0; n < whole.size(); ++n) {
            write("cut.serialized", whole.substr(0, n));
            refusals += refused(file_shape("serialized", "cut.serialized")).empty() ? 0 : 1;
            auto bytes = whole;
            bytes[n] = static_cast<char>(bytes[n] ^ 0x55);
            write("bad.serialized", bytes);
            for (const auto* index : {"0", "1"})
                refused(file_shape("serialized", "bad.serialized",
                    "<integer name=\"shape_index\" value=\"" + std::string(index) + "\"/>"));
        }
        EXPECT_GE(refusals, whole.size() / 3);
        // A surface that says that it has 2^40 vertices.
        std::string plain;
        put(plain, std::uint32_t{0x1000});
        plain += '\0';
        put(plain, std::uint64_t{1} << 31);
        put(plain, std::uint64_t{1} << 31);
        auto size = compressBound(plain.size());
        std::string packed(size, '\0');
        compress(
            reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(plain.data()), plain.size());
        write("large.serialized", std::string("\x1c\x04\x04\0", 4) + packed.substr(0, size));
        EXPECT_NE(refused(file_shape("serialized", "large.serialized")).find("has a surface of more than 2^32 bytes"),
            std::string::npos);
    }

} // namespace
} // namespace photongrid

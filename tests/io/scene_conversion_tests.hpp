// Scenes that are written as scene files: they read as the same ones, in a folder that stands alone.
#pragma once

#include "generated_scenes.hpp"

#include <photongrid/io/image_file.hpp>
#include <photongrid/io/ply_file.hpp>
#include <photongrid/io/ply_writer.hpp>
#include <photongrid/io/scene_export.hpp>
#include <photongrid/io/scene_file.hpp>
#include <photongrid/io/scene_import.hpp>
#include <photongrid/io/scene_writer.hpp>

#include <photongrid/trace/device_scene.hpp>

#include <bit>
#include <cstring>
#include <limits>
#include <set>

namespace photongrid {
namespace {

    const std::filesystem::path example_scenes = PHOTONGRID_SCENES;

    /// A scene without the names of its files, which are the only thing that may differ.
    scene without_files(scene s)
    {
        for (auto& m : s.meshes)
            m.file.clear();
        for (auto& l : s.mesh_lights)
            l.surface.file.clear();
        for (auto& l : s.environment_lights)
            l.file.clear();
        for (auto& m : s.materials) {
            m.texture.file.clear();
            for (const auto& [key, member] : detail::number_textures)
                (m.*member).file.clear();
        }
        return s;
    }

    /// Names of all files below a folder.
    std::set<std::string> files_below(const std::filesystem::path& folder)
    {
        std::set<std::string> all;
        for (const auto& e : std::filesystem::recursive_directory_iterator(folder))
            if (e.is_regular_file())
                all.insert(std::filesystem::relative(e.path(), folder).generic_string());
        return all;
    }

    template <class Part>
    bool has_equal_bytes(const std::vector<Part>& a, const std::vector<Part>& b)
    {
        return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Part)) == 0);
    }

    RC_GTEST_PROP(scene_conversion, reads_back_as_the_same_scene, (std::uint32_t seed))
    {
        const test_folder folder("conversion");
        const auto s = scene_generator(seed, false).any_scene();
        const auto path = folder.file("made.json");
        const auto made = write_scene(path, s);
        RC_ASSERT(made.notes.empty());
        RC_ASSERT(made.files.back() == path);
        RC_ASSERT(files_below(folder.path).size() == made.files.size());
        const auto read = read_scene(path);
        RC_ASSERT(without_files(read) == without_files(s));
        for (std::size_t i = 1; i < s.meshes.size(); ++i)
            if (s.meshes[i].surface == s.meshes[i - 1].surface)
                RC_ASSERT(read.meshes[i].surface == read.meshes[i - 1].surface);
        for (const auto& m : read.meshes)
            RC_ASSERT(m.surface->triangles.size() < 64 || m.file.ends_with(".ply"));
    }

    /// The number of a texel that reading single precision gives.
    TEST(scene_conversion, every_texel_is_exact)
    {
        const test_folder folder("texels");
        texture all{256, 256, {}};
        for (std::uint32_t t = 0; t < 65536; ++t)
            all.texels.emplace_back(t, 65535 - t, t ^ 21845, 65535);
        const auto s = papered_square(use_of(all), use_of(all, texture_channel::green));
        write_scene(folder.file("a.json"), s);
        const auto read = read_scene(folder.file("a.json"));
        const auto& back = read.materials.at(0);
        EXPECT_EQ(back.texture.map->texels, all.texels);
        EXPECT_EQ(back.opacity_texture.map->texels, all.texels);
    }

    // 8 bits hold an alpha of k * 257 alone; of another one that channel is kept which is used.
    TEST(scene_conversion, an_alpha_of_16_bits_keeps_what_is_used)
    {
        const test_folder folder("alpha");
        const texture odd{2, 1, {glm::u16vec4(1, 2, 3, 4), glm::u16vec4(5, 6, 7, 65000)}};
        write_scene(folder.file("a.json"), papered_square({}, use_of(odd, texture_channel::alpha)));
        const auto read = read_scene(folder.file("a.json"));
        const auto& back = read.materials.at(0).opacity_texture;
        ASSERT_EQ(back.map->texels.size(), 2u);
        EXPECT_EQ(back.map->texels[0][static_cast<int>(back.channel)], 4);
        EXPECT_EQ(back.map->texels[1][static_cast<int>(back.channel)], 65000);
    }

    TEST(scene_conversion, examples_stay_the_same_for_kernels_too)
    {
        std::size_t scenes_read = 0;
        for (const auto& entry : std::filesystem::directory_iterator(example_scenes)) {
            const auto ending = entry.path().extension();
            if ((ending != ".json" && ending != ".pbrt") || entry.path().string().ends_with(".schema.json"))
                continue;
            const test_folder folder("example");
            const auto source = entry.path().string();
            const auto s = import_scene(source).scene;
            const auto path = folder.file("copy of it.json");
            export_scene(path, s, {.strict = true, .source = source});
            const auto read = import_scene(path, {.strict = true}).scene;
            EXPECT_TRUE(without_files(read) == without_files(s)) << source;
            EXPECT_TRUE(has_equal_bytes(lay_out(read).records, lay_out(s).records)) << source;
            ++scenes_read;
        }
        EXPECT_GE(scenes_read, 9u);
    }

    TEST(scene_conversion, a_picture_beside_the_file_stays_and_others_are_copied)
    {
        const test_folder folder("pictures");
        for (const auto* name : {"leaves.json", "leaves_leaf.png", "leaves_rust.png", "leaves_twigs.ply"})
            std::filesystem::copy_file(example_scenes / name, folder.path / name);
        const auto source = folder.file("leaves.json");
        const auto s = read_scene(source);
        export_scene(folder.file("again.json"), s, {.strict = false, .source = source});
        EXPECT_NE(bytes_in(folder.file("again.json")).find("\"leaves_leaf.png\""), std::string::npos);
        std::filesystem::create_directory(folder.path / "below");
        const auto made = export_scene(folder.file("below/again.json"), s, {.strict = false, .source = source});
        std::size_t copies = 0;
        for (const auto& f : made.files)
            copies += bytes_in(f) == bytes_in(folder.path / "leaves_leaf.png") ? 1 : 0;
        EXPECT_EQ(copies, 1u);
        EXPECT_TRUE(without_files(read_scene(folder.file("below/again.json"))) == without_files(s));
    }

    TEST(scene_conversion, leaves_nothing_half_written)
    {
        const test_folder folder("refused");
        scene s = read_scene((example_scenes / "pool.json").string());
        const auto path = folder.file("pool.json");
        std::ofstream(path) << "before";
        s.point_lights.assign(1025, {"lamp", dvec3(0, 1, 0), dvec3(1)});
        try {
            write_scene(path, s);
            ADD_FAILURE() << "1,025 lights were written";
        } catch (const scene_error& e) {
            EXPECT_TRUE(std::string(e.what()).starts_with(path + ": error: cannot hold this scene: ")) << e.what();
            EXPECT_NE(std::string(e.what()).find("expected at most 1024"), std::string::npos) << e.what();
        }
        EXPECT_EQ(bytes_in(path), "before");
        EXPECT_EQ(files_below(folder.path), std::set<std::string>{"pool.json"});
        EXPECT_FALSE(std::filesystem::exists(folder.path / "pool"));
        s.point_lights.resize(1);
        std::ofstream(folder.file("pool")) << "a file";
        EXPECT_THROW(write_scene(path, s), file_error);
        EXPECT_EQ(bytes_in(path), "before");
        EXPECT_EQ(bytes_in(folder.file("pool")), "a file");
        EXPECT_THROW(export_scene(folder.file("none/pool.json"), s), file_error);
        EXPECT_THROW(export_scene(folder.file("pool.xml"), s), file_error);
    }

    // A file in the folder that has another content keeps it, and what was written before is not written again.
    TEST(scene_conversion, replaces_no_other_file)
    {
        const test_folder folder("others");
        scene s = read_scene((example_scenes / "pool.json").string());
        const auto path = folder.file("a.json");
        const auto first = write_scene(path, s);
        ASSERT_EQ(first.files.size(), 2u);
        const auto before = bytes_in(first.files[0]);
        auto moved = *s.meshes.at(0).surface;
        moved.positions[0].x += 1;
        s.meshes[0].surface = std::make_shared<const mesh>(moved);
        const auto second = write_scene(path, s);
        EXPECT_NE(second.files[0], first.files[0]);
        EXPECT_EQ(bytes_in(first.files[0]), before);
    }

    TEST(ply_writer, numbers_are_the_same_bit_for_bit)
    {
        constexpr float least = std::numeric_limits<float>::denorm_min();
        mesh m{{{-0.0f, least, 1e18f}, {0.1f, -1e-30f, 3}, {1, 2, 3}}, {{0, 1, 2}, {2, 1, 0}},
            {{0, 0, 0}, {0.1f, 0.2f, 3e8f}, {1, -0.0f, least}}, {{0.1f, 1e6f}, {-1e6f, 0}, {least, 1}},
            {{0, 0.1f, 1}, {least, 0.5f, 1.0f / 3}, {1, 1, 1}}};
        const auto read = parse_ply("m.ply", ply_bytes(m));
        EXPECT_TRUE(has_equal_bytes(read.positions, m.positions));
        EXPECT_TRUE(has_equal_bytes(read.normals, m.normals));
        EXPECT_TRUE(has_equal_bytes(read.texture_coordinates, m.texture_coordinates));
        EXPECT_TRUE(has_equal_bytes(read.colors, m.colors));
        EXPECT_EQ(read.triangles, m.triangles);
        m.colors.pop_back();
        EXPECT_THROW(ply_bytes(m), std::invalid_argument);
    }

} // namespace
} // namespace photongrid

// Every file of the fuzzer's corpus keeps the promise on this compiler too; a crash that fuzzing finds is added there.
#include "scene_corpus.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <vector>

namespace photongrid {
namespace {

    const std::filesystem::path corpus = PHOTONGRID_SCENE_CORPUS;

    /// The files of a format's folder.
    std::vector<std::filesystem::path> files_of(const testing::corpus_format& f)
    {
        std::vector<std::filesystem::path> made;
        for (const auto& entry : std::filesystem::directory_iterator(corpus / f.name))
            made.push_back(entry.path());
        return made;
    }

    std::string contents(const std::filesystem::path& path)
    {
        std::ifstream in(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }

    TEST(scene_corpus, keeps_the_promise)
    {
        for (const auto& f : testing::corpus_formats)
            for (const auto& path : files_of(f)) {
                const auto text = contents(path);
                EXPECT_LT(text.size(), 4096u) << path << ": the fuzzer cuts longer ones";
                EXPECT_EQ(testing::broken_promise(f.format, text), "") << path;
            }
    }

    // Else the corpus would exercise the first lines of the readers only.
    TEST(scene_corpus, holds_good_scenes_and_bad_ones_of_each_format)
    {
        std::set<std::string> good;
        for (const auto& f : testing::corpus_formats) {
            std::size_t bad = 0;
            for (const auto& path : files_of(f)) {
                const auto text = contents(path);
                try {
                    if (text.starts_with("newmtl"))
                        obj::parse_mtl("s.json", text);
                    else
                        testing::scene_of(f.format, text);
                    good.insert(f.name + ("/" + path.filename().string()));
                    if (!text.starts_with("newmtl")) {
                        EXPECT_EQ(format_of("", text), f.format) << path;
                    }
                } catch (const scene_error&) {
                    ++bad;
                }
            }
            EXPECT_GE(bad, 1u) << f.name;
        }
        for (const auto* name : {"photongrid/minimal.json", "photongrid/sphere.json", "photongrid/cylinder.json",
                 "photongrid/cone.json", "photongrid/paraboloid.json", "photongrid/disk.json", "photongrid/box.json",
                 "photongrid/mesh.json", "photongrid/triangle.json", "photongrid/pentagon.json",
                 "photongrid/materials.json", "photongrid/rectangle_light.json", "photongrid/units_mm_kw.json",
                 "photongrid/units_cm_mw.json", "photongrid/every_setting.json", "photongrid/comments_and_schema.json",
                 "photongrid/byte_order_mark.json", "photongrid/crlf_and_tabs.json", "photongrid/glass_ball.json",
                 "photongrid/ring.json", "photongrid/cornell_box.json", "photongrid/estimate_settings.json",
                 "pbrt/shapes.pbrt", "pbrt/materials.pbrt", "pbrt/lights.pbrt", "mitsuba/shapes.xml",
                 "mitsuba/materials.xml", "mitsuba/lights.xml", "mitsuba/old.xml", "gltf/lamps.gltf", "gltf/lamps.glb",
                 "gltf/materials.gltf", "gltf/materials.glb", "gltf/accessors.gltf", "gltf/poses.gltf",
                 "obj/materials.obj", "obj/concave.obj", "obj/keys.mtl", "ply/ascii.ply", "ply/binary.ply",
                 "ply/colors.ply", "ply/normals_big_endian.ply"})
            EXPECT_TRUE(good.contains(name)) << name;
    }

} // namespace
} // namespace photongrid

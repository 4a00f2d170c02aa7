// Every file of the fuzzer's corpus keeps the promise on this compiler too; a crash that fuzzing finds is added there.
#include "scene_corpus.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

namespace photongrid {
namespace {

    const std::filesystem::path corpus = PHOTONGRID_SCENE_CORPUS;

    std::string contents(const std::filesystem::path& path)
    {
        std::ifstream in(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }

    TEST(scene_corpus, keeps_the_promise)
    {
        std::size_t files = 0;
        for (const auto& entry : std::filesystem::directory_iterator(corpus)) {
            const auto text = contents(entry.path());
            EXPECT_LT(text.size(), 4096u) << entry.path() << ": the fuzzer cuts longer ones";
            EXPECT_EQ(testing::broken_promise(text), "") << entry.path();
            ++files;
        }
        EXPECT_GE(files, 30u);
    }

    // Else the corpus would exercise the first lines of the reader only.
    TEST(scene_corpus, holds_good_scenes_and_bad_ones)
    {
        std::set<std::string> good;
        std::size_t bad = 0;
        for (const auto& entry : std::filesystem::directory_iterator(corpus)) {
            try {
                const auto text = contents(entry.path());
                if (text.starts_with("newmtl"))
                    obj::parse_mtl("s.json", text);
                else
                    testing::scene_of(text);
                good.insert(entry.path().stem().string());
            } catch (const scene_error&) {
                ++bad;
            }
        }
        for (const auto* name :
            {"minimal", "sphere", "cylinder", "cone", "paraboloid", "disk", "box", "mesh", "triangle", "pentagon",
                "materials", "rectangle_light", "units_mm_kw", "units_cm_mw", "every_setting", "comments_and_schema",
                "byte_order_mark", "crlf_and_tabs", "glass_ball", "ring", "cornell_box", "largest_and_smallest_lengths",
                "estimate_settings", "pbrt_shapes", "pbrt_materials", "pbrt_lights", "obj_materials", "obj_concave",
                "mtl_keys", "ply_colors", "mitsuba_shapes", "mitsuba_materials", "mitsuba_lights", "mitsuba_old"})
            EXPECT_TRUE(good.contains(name)) << name;
        EXPECT_GE(bad, 20u);
    }

} // namespace
} // namespace photongrid

// Readers of scenes tell which files a scene names.
#pragma once

#include <photongrid/io/scene_import.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include <unistd.h>

namespace photongrid {
namespace {

    class named_files : public ::testing::Test {
    protected:
        named_files()
        {
            std::filesystem::create_directories(folder);
            write("square.ply",
                "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n");
            write("grey.pfm", "PF\n1 1\n-1.0\n" + std::string(12, '\0'));
        }
        ~named_files() override { std::filesystem::remove_all(folder); }
        void write(const std::string& name, const std::string& content) const
        {
            std::ofstream(folder / name, std::ios::binary) << content;
        }
        /// The names of what the reader of the scene `name` reads besides, whether it can read the scene or not.
        std::set<std::string> named_in(const std::string& name) const
        {
            std::set<std::string> heard;
            import_settings how;
            how.before_reading = [&](const std::string& path) {
                EXPECT_EQ(std::filesystem::path(path).parent_path(), folder) << path;
                heard.insert(std::filesystem::path(path).filename().string());
            };
            try {
                import_scene((folder / name).string(), how);
            } catch (const scene_error&) {
                heard.insert("refused");
            }
            return heard;
        }
        std::filesystem::path folder
            = std::filesystem::temp_directory_path() / ("photongrid_named_" + std::to_string(::getpid()));
    };

    using names = std::set<std::string>;

    TEST_F(named_files, of_photongrids_own_scenes)
    {
        const auto text = [](const std::string& mesh) {
            return R"({"photongrid": 1, "units": {"length": "m", "power": "W"},
 "camera": {"position": [0, 1, 5], "look_at": [0, 0, 0], "vertical_fov": 40},
 "materials": {"white": {"type": "lambertian", "reflectance": 0.7},
  "grey": {"type": "lambertian", "reflectance": 1, "texture": "grey.pfm"}},
 "shapes": [{"type": "mesh", "file": ")"
                + mesh + R"(", "material": "white"}],
 "lights": [{"type": "point", "position": [0, 3, 0], "power": 10}, {"type": "environment", "file": "sky.pfm"}],
 "render": {"size": [64, 48], "photons": 1000, "k": 20, "max_radius": 0.25}})";
        };
        write("sky.pfm", "PF\n2 1\n-1.0\n" + std::string(24, '\1'));
        write("scene.json", text("square.ply"));
        EXPECT_EQ(named_in("scene.json"), (names{"grey.pfm", "square.ply", "sky.pfm"}));
        write("scene.json", text("missing.ply"));
        EXPECT_EQ(named_in("scene.json"), (names{"grey.pfm", "missing.ply", "refused"}));
    }

    TEST_F(named_files, of_pbrts_scenes)
    {
        write("scene.pbrt", "WorldBegin\nInclude \"more.pbrt\"\n");
        write("more.pbrt",
            "Texture \"grey\" \"spectrum\" \"imagemap\" \"string filename\" \"grey.pfm\"\n"
            "Material \"diffuse\" \"texture reflectance\" \"grey\"\n"
            "LightSource \"point\"\nShape \"plymesh\" \"string filename\" \"square.ply\"\n");
        EXPECT_EQ(named_in("scene.pbrt"), (names{"more.pbrt", "grey.pfm", "square.ply"}));
        write("more.pbrt", "Shape \"plymesh\" \"string filename\" \"missing.ply\"\n");
        EXPECT_EQ(named_in("scene.pbrt"), (names{"missing.ply", "more.pbrt", "refused"}));
    }

} // namespace
} // namespace photongrid

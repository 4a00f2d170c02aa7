// What the tests of readers of other programs' scenes share.
#pragma once

#include "scene_texts.hpp"

#include <photongrid/io/scene_import.hpp>

namespace photongrid {
namespace {

    std::vector<std::string> notes_of(const imported_scene& s)
    {
        std::vector<std::string> all;
        for (const auto& n : s.notes)
            all.push_back(text_of(n));
        return all;
    }

    void expect_near(const dvec3& a, const dvec3& b, double most = 1e-12)
    {
        EXPECT_LT(glm::length(a - b), most)
            << a.x << ' ' << a.y << ' ' << a.z << " is not " << b.x << ' ' << b.y << ' ' << b.z;
    }

    /// The direction of the ray through a place of the picture, from -1, -1 (left, lower) to 1, 1.
    dvec3 view_direction(const scene& s, double x, double y)
    {
        const detail::camera_axes axes(s.camera);
        const double up = std::tan(glm::radians(s.camera.vertical_fov) / 2),
                     right = up * s.render.output.width / s.render.output.height;
        return glm::normalize(axes.forward + x * right * axes.right + y * up * axes.up);
    }

    /// A folder for the files of one test.
    class import_folder : public ::testing::Test {
    protected:
        import_folder() { std::filesystem::create_directories(folder / "below"); }
        ~import_folder() override { std::filesystem::remove_all(folder); }
        void write(const std::string& name, const std::string& content)
        {
            std::ofstream(folder / name, std::ios::binary) << content;
        }
        std::filesystem::path folder = std::filesystem::temp_directory_path()
            / ("photongrid_import_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + "_"
                + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    };

} // namespace
} // namespace photongrid

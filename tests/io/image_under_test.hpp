// A folder for pictures of a test.
#pragma once

#include <photongrid/compare/image_difference.hpp>
#include <photongrid/compare/picture_noise.hpp>
#include <photongrid/io/image_file.hpp>
#include <photongrid/io/tone_map.hpp>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>
#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <random>

#include <sys/resource.h>
#include <unistd.h>

namespace photongrid {
namespace {

    namespace fs = std::filesystem;

    /// A folder of its own for each test.
    class image_file : public ::testing::Test {
    protected:
        image_file() : folder(fs::temp_directory_path() / ("photongrid_image_" + std::to_string(::getpid())))
        {
            fs::create_directories(folder);
        }
        ~image_file() override { fs::remove_all(folder); }
        std::string path(const std::string& name) const { return (folder / name).string(); }
        std::size_t files() const
        {
            return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
        }
        fs::path folder;
    };

    image gradient()
    {
        image p{.width = 7, .height = 5, .pixels = {}};
        for (std::uint32_t i = 0; i < 35; ++i)
            p.pixels.emplace_back(static_cast<float>(i) / 3.0f, 1e-30f * static_cast<float>(i), 1e30f);
        p.pixels[4] = glm::vec3(-1.5f, 0.0f, std::numeric_limits<float>::infinity());
        return p;
    }

    void write_text(const std::string& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

    template <class Action>
    std::string refusal(Action&& action)
    {
        try {
            action();
        } catch (const file_error& e) {
            return e.what();
        }
        return "";
    }

} // namespace
} // namespace photongrid

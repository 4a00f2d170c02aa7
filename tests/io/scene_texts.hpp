// Texts of scenes, and what reading them says.
#pragma once

#include <photongrid/io/scene_file.hpp>
#include <photongrid/io/scene_keys.hpp>
#include <photongrid/io/scene_writer.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>

namespace photongrid {
namespace {

    const std::string scenes = PHOTONGRID_SCENES;

    /// A scene of which every line is known: 4 camera, 6 and 7 materials, 9 and 10 shapes, 12 light, 13 render.
    const std::vector<std::string> good = {
        R"({"photongrid": 1,)",
        R"( "name": "small",)",
        R"( "units": {"length": "m", "power": "W"},)",
        R"( "camera": {"position": [0, 1, 5], "look_at": [0, 0, 0], "vertical_fov": 40},)",
        R"( "materials": {)",
        R"(  "white": {"type": "lambertian", "reflectance": [0.7, 0.6, 0.5]},)",
        R"(  "clear": {"type": "glass", "index_of_refraction": 1.5}},)",
        R"( "shapes": [)",
        R"(  {"type": "sphere", "center": [0, 1, 0], "radius": 0.5, "material": "clear"},)",
        R"(  {"type": "polygon", "vertices": [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]], "material": "white"}],)",
        R"( "lights": [)",
        R"(  {"type": "point", "name": "lamp", "position": [0, 3, 0], "power": [10, 20, 30]}],)",
        R"( "render": {"size": [64, 48], "photons": 1000, "k": 20, "grid": [4, 1, 4], "max_radius": 0.25}})",
    };

    std::string text(const std::vector<std::string>& lines)
    {
        std::string all;
        for (const auto& l : lines)
            all += l + "\n";
        return all;
    }

    /// `good` with another line of its settings; "}": without settings.
    [[maybe_unused]] std::string good_with(const std::string& render)
    {
        auto lines = good;
        lines[12] = render;
        if (render == "}")
            lines[11].pop_back(); // the comma
        return text(lines);
    }

    /// The error of a reader, or "" if it throws none.
    template <class Read>
    std::string refusal_by(const Read& read)
    {
        try {
            (void)read();
            return "";
        } catch (const scene_error& e) {
            return e.what();
        }
    }

    /// The reader's error for `content`, or "" if it accepts it.
    [[maybe_unused]] std::string refusal(const std::string& content)
    {
        return refusal_by([&] { return parse_scene("s.json", content); });
    }

    /// `text` with three of its bytes replaced by some of `bytes`.
    [[maybe_unused]] std::string damaged(std::string text, std::string_view bytes, std::uint32_t& state)
    {
        for (int changes = 0; changes < 3; ++changes) {
            state = state * 1664525u + 1013904223u;
            text[(state >> 8) % text.size()] = bytes[(state >> 4) % bytes.size()];
        }
        return text;
    }

    /// The reader's error for `good` with `from` replaced by `to` in one line (counted from 1).
    [[maybe_unused]] std::string refusal(std::size_t line, const std::string& from, const std::string& to)
    {
        auto lines = good;
        auto& l = lines[line - 1];
        const auto at = l.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        l.replace(at, from.size(), to);
        return refusal(text(lines));
    }

    [[maybe_unused]] void expect_refusal(
        const std::string& said, const std::string& place, std::initializer_list<const char*> words)
    {
        EXPECT_EQ(said.substr(0, place.size() + 16), "s.json:" + place + ": error: ") << said;
        for (const auto* w : words)
            EXPECT_NE(said.find(w), std::string::npos) << "\"" << w << "\" in: " << said;
    }

} // namespace
} // namespace photongrid

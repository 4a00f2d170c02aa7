// What the reader of scene files promises for any bytes at all. The fuzzer (fuzz_scene.cpp) and the replay of the
// committed corpus (scene_corpus.cpp) hold it to the same function.
#pragma once

#include "scene_file.hpp"

#include <photongrid/device_scene.hpp>

#include <algorithm>
#include <string>

namespace photongrid::testing {

namespace detail {
    /// A message for people: it names the file and a place that exists, is no novel, and cannot upset a terminal.
    inline std::string broken_in_message(const scene_error& e, std::string_view text)
    {
        const std::string_view said = e.what();
        const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1;
        if (!said.starts_with("s.json") || said.find(": error: ") == std::string_view::npos)
            return "the message names no file: " + std::string(said);
        if (e.line > lines || e.column > text.size() + 1 || (e.line > 0 && e.column < 1))
            return "the message names a place outside the text: " + std::string(said);
        if (said.size() > 2000)
            return "the message has " + std::to_string(said.size()) + " bytes";
        if (std::any_of(
                said.begin(), said.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }))
            return "the message has control characters";
        return "";
    }

    /// What kernels assume of a laid-out scene without looking: finite records, unit normals and axes, ranges that
    /// exist.
    inline std::string broken_in_layout(const scene_records& r, const scene& s)
    {
        const auto unit = [](const glm::vec4& v) { return std::abs(glm::length(glm::dvec3(v)) - 1) < 1e-5; };
        for (const auto& v : r.records)
            if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z) || !std::isfinite(v.w))
                return "a record is not finite";
        if (!std::isfinite(r.layout.scale.x) || r.layout.scale.x < 0)
            return "the scene's scale is not finite";
        const auto& l = r.layout;
        const std::size_t edges = [&] { // each is a record, and so is the vertex it begins at
            std::size_t n = 4 * s.rectangle_lights.size();
            for (const auto& p : s.polygons)
                n += p.vertices.size();
            return n;
        }();
        const std::size_t lights = s.rectangle_lights.size() + s.point_lights.size();
        if (l.round_things.x != 0 || l.round_things.z != 2 * s.spheres.size()
            || l.flat_things.x != l.round_things.z + 5 * (s.cylinders.size() + s.cones.size() + s.paraboloids.size())
            || l.flat_things.z != l.flat_things.x + 3 * s.disks.size()
            || l.rest.x != l.flat_things.z + 2 * (s.polygons.size() + s.rectangle_lights.size()) + 2 * edges
            || l.rest.y != l.rest.x + 2 * s.materials.size() || r.records.size() != l.rest.y + 6 * lights
            || l.rest.z != lights)
            return "the ranges of the records do not follow each other";
        for (std::size_t i = l.round_things.z; i < l.flat_things.x; i += 5)
            if (!unit(r.records[i + 1]) || !unit(r.records[i + 2]) || !unit(r.records[i + 3]))
                return "the axes of a cylinder, cone or paraboloid are not unit vectors";
        for (std::size_t i = l.flat_things.x; i < l.flat_things.z; i += 3)
            if (!unit(r.records[i]))
                return "the normal of a disk is not a unit vector";
        for (std::size_t i = l.flat_things.z; i < l.rest.x; i += 2 + 2 * static_cast<std::size_t>(r.records[i + 1].x))
            if (!unit(r.records[i]))
                return "the normal of a polygon is not a unit vector";
        return "";
    }
} // namespace detail

/// Reads `text` as a scene and lays it out for a device. Returns what was broken of the promise, or "": either a good
/// scene_error, or a scene that check() takes and that lay_out() takes or refuses with std::invalid_argument.
inline std::string broken_promise(std::string_view text)
{
    try {
        scene s;
        try {
            s = parse_scene("s.json", std::string(text));
        } catch (const scene_error& e) {
            return detail::broken_in_message(e, text);
        }
        try {
            check(s);
        } catch (const std::invalid_argument& e) {
            return std::string("check() refuses what the reader took: ") + e.what();
        }
        try {
            const auto records = lay_out(s);
            make_grid(records.low, records.high, s.render.grid);
            return detail::broken_in_layout(records, s);
        } catch (const std::invalid_argument&) {
            return ""; // no Lambertian surface, or too large for single precision
        }
    } catch (const std::exception& e) {
        return std::string("an exception that the documentation does not name: ") + e.what();
    }
}

} // namespace photongrid::testing

// Guarantees of the readers of scene files for arbitrary bytes. The fuzzer (fuzz_scene.cpp) and the replay of the
// committed corpus (scene_corpus.cpp) hold them to the same function.
#pragma once

#include <photongrid/io/gltf_file.hpp>
#include <photongrid/io/mitsuba_file.hpp>
#include <photongrid/io/obj/materials.hpp>
#include <photongrid/io/obj_scene.hpp>
#include <photongrid/io/pbrt_file.hpp>
#include <photongrid/io/ply_file.hpp>
#include <photongrid/io/scene_file.hpp>
#include <photongrid/io/scene_import.hpp>

#include <photongrid/map/map_buffers.hpp>
#include <photongrid/trace/device_scene.hpp>

#include <algorithm>
#include <set>
#include <string>
#include <tuple>

namespace photongrid::testing {

/// The folders of the corpus, which the fuzzer takes as --format=NAME.
struct corpus_format {
    const char* name;
    scene_format format;
};
inline constexpr corpus_format corpus_formats[]
    = {{"photongrid", scene_format::photongrid}, {"pbrt", scene_format::pbrt}, {"mitsuba", scene_format::mitsuba},
        {"gltf", scene_format::gltf}, {"obj", scene_format::obj}, {"ply", scene_format::ply}};

namespace detail {
    /// A message for users: it names the file and an existing line, is short, and has no control characters.
    inline std::string broken_in_message(const scene_error& e, std::string_view text)
    {
        const std::string_view said = e.what();
        const auto lines = static_cast<std::size_t>(std::max(std::count(text.begin(), text.end(), '\n'),
                               std::count(text.begin(), text.end(), '\r'))) // of old Macs
            + 1;
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
    inline std::string broken_in_layout(const scene_layout& r, const scene& s)
    {
        const auto unit = [](const glm::vec4& v) { return std::abs(glm::length(glm::dvec3(v)) - 1) < 1e-5; };
        for (const auto& v : r.records)
            if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z) || !std::isfinite(v.w))
                return "a record is not finite";
        const float round_share = r.records[kernels::SCENE_SIZES].x;
        if (!std::isfinite(round_share) || round_share < 0)
            return "the share of round shapes in ray offsets is not finite";
        const auto quadrics = r.table(photongrid::detail::quadric_number), disks = r.table(shape_kind<disk>::number),
                   polygons = r.table(shape_kind<polygon>::number), materials = r.table(kernels::MATERIAL_TABLE),
                   lights = r.table(kernels::LIGHT_TABLE);
        if (polygons.count != s.polygons.size() + s.rectangle_lights.size() || materials.count != s.materials.size()
            || lights.count != count_lights(s))
            return "a table has lost something";
        if (materials.first != kernels::FIRST_MATERIAL || materials.stride != kernels::MATERIAL_RECORDS)
            return "the materials do not stand where kernels look for them";
        std::size_t shapes = polygons.count, next = materials.first + std::size_t{materials.count} * materials.stride;
        for (uint number = 0; number < kernels::SCENE_TABLES; ++number)
            if (number != shape_kind<polygon>::number && number != kernels::MATERIAL_TABLE
                && number != kernels::SCENE_SIZES && number != kernels::LIGHT_TABLE && number != kernels::LIGHT_TREE) {
                const auto t = r.table(number);
                if (number != kernels::TEXTURE_TABLE && number != kernels::MEDIA_TABLE)
                    shapes += t.count;
                next += t.count * t.stride;
            }
        if (shapes != count_shapes(s) - s.meshes.size() + s.rectangle_lights.size())
            return "a shape is in no table";
        std::set<std::tuple<double, double, bool>> rebounds; // what facets hide stands in no table
        for (const auto& m : s.materials)
            if (const bool varies = m.roughness_texture.map != nullptr; has_rebounds(m)
                && rebounds.emplace(refracts(m) ? m.index_of_refraction : 0, m.roughness, varies).second)
                next += 1 + (varies ? 16u : 1u) * (kernels::REBOUND_STEPS + 3);
        if (polygons.first != next)
            return "the tables of the shapes do not follow each other";
        for (uint n = 0; n < polygons.count; ++n) {
            if (next + 1 >= r.records.size() || !unit(r.records[next]))
                return "the normal of a polygon is not a unit vector";
            next += 2 + 2 * static_cast<std::size_t>(r.records[next + 1].x); // each edge is a record, and each vertex
        }
        const auto tree = r.table(kernels::LIGHT_TREE);
        if (lights.first != next || tree.first != lights.first + lights.count * lights.stride
            || r.records.size() != tree.first + tree.count * tree.stride)
            return "lights, their tree and the end do not follow the polygons";
        for (uint n = 0, i = quadrics.first; n < quadrics.count; ++n, i += quadrics.stride)
            if (!unit(r.records[i + 1]) || !unit(r.records[i + 2]) || !unit(r.records[i + 3]))
                return "the axes of a cylinder, cone or paraboloid are not unit vectors";
        for (uint n = 0, i = disks.first; n < disks.count; ++n, i += disks.stride)
            if (!unit(r.records[i]))
                return "the normal of a disk is not a unit vector";
        return "";
    }
} // namespace detail

/// Reads `bytes` as a PLY file, with the same result as broken_promise.
inline std::string broken_in_ply(std::string_view bytes)
{
    mesh m;
    try {
        m = parse_ply("s.json.ply", bytes);
    } catch (const scene_error& e) {
        return detail::broken_in_message(e, bytes);
    }
    try {
        check(m);
        return m.triangles.size() > bytes.size() ? "more triangles than bytes" : "";
    } catch (const std::invalid_argument& e) {
        return std::string("check() refuses what the reader took: ") + e.what();
    }
}

namespace detail {
    /// Notes must be like messages.
    inline std::string broken_in_notes(const std::vector<import_note>& notes, std::string_view text)
    {
        for (const auto& n : notes) {
            const auto broken = broken_in_message({n.file, n.line, n.column, n.what}, text);
            if (!broken.empty())
                return "a note: " + broken;
        }
        return "";
    }
} // namespace detail

/// Reads `text` as an MTL file and makes its materials, with the same result as broken_promise.
inline std::string broken_in_mtl(std::string_view text)
{
    try {
        const auto made = obj::parse_mtl("s.json", text);
        scene_builder builder("s.json", {});
        for (const auto& m : made)
            if (!obj::emission_of(builder, m))
                obj::add_material(builder, m, text.size() % 2 == 0); // with texture coordinates, or without
        if (const auto broken = detail::broken_in_notes(builder.log().take(), text); !broken.empty())
            return broken;
        return made.size() > text.size() ? "more materials than bytes" : "";
    } catch (const scene_error& e) {
        return detail::broken_in_message(e, text);
    }
}

/// Reads `text` as a scene of a format, whatever it looks like.
/// \throws scene_error.
inline imported_scene scene_of(scene_format format, std::string_view text)
{
    switch (format) {
    case scene_format::pbrt: return parse_pbrt("s.json", text);
    case scene_format::mitsuba: return parse_mitsuba("s.json", text);
    case scene_format::gltf: return parse_gltf("s.json", text);
    case scene_format::obj: return parse_obj_scene("s.json", text);
    case scene_format::ply: return parse_ply_scene("s.json", text);
    case scene_format::photongrid: break;
    }
    return {parse_scene("s.json", std::string(text)), {}};
}

/// Reads `text` as a scene of a format, and lays it out for a device. Returns the violated guarantee, or "": either a
/// good scene_error, or a scene that check() takes and that lay_out() takes or refuses with std::invalid_argument.
inline std::string broken_promise(scene_format format, std::string_view text)
{
    try {
        format_of("s.json", text); // throws nothing
        if (format == scene_format::obj && text.starts_with("newmtl"))
            return broken_in_mtl(text);
        if (format == scene_format::ply)
            if (const auto broken = broken_in_ply(text); !broken.empty())
                return broken;
        scene s;
        try {
            auto imported = scene_of(format, text);
            s = std::move(imported.scene);
            if (const auto broken = detail::broken_in_notes(imported.notes, text); !broken.empty())
                return broken;
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
            make_grid(records.low, records.high, s.render.map.grid);
            return detail::broken_in_layout(records, s);
        } catch (const std::invalid_argument&) {
            return ""; // no Lambertian surface, or too large for single precision
        }
    } catch (const std::exception& e) {
        return std::string("an exception that the documentation does not name: ") + e.what();
    }
}

} // namespace photongrid::testing

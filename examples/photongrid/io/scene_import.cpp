#include <photongrid/io/gltf_file.hpp>
#include <photongrid/io/import/glass_bodies.hpp>
#include <photongrid/io/import/import_log.hpp>
#include <photongrid/io/import/scene_files.hpp>
#include <photongrid/io/mitsuba_file.hpp>
#include <photongrid/io/obj_scene.hpp>
#include <photongrid/io/pbrt_file.hpp>
#include <photongrid/io/scene_file.hpp>
#include <photongrid/io/scene_import.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <utility>

namespace photongrid {

namespace {
    constexpr std::string_view blanks = " \t\r\n";

    /// The first word of a text without comments (#).
    std::string_view first_word(std::string_view text)
    {
        if (text.starts_with("\xEF\xBB\xBF")) // a byte order mark
            text.remove_prefix(3);
        for (;;) {
            text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
            if (!text.starts_with("#"))
                return text.substr(0, text.find_first_of(" \t\r\n\"["));
            text.remove_prefix(std::min(text.find('\n'), text.size()));
        }
    }

    /// The first bytes of a file; none if it cannot be read, which its reader says.
    std::string beginning_of(const std::string& path)
    {
        std::string bytes(std::size_t{1} << 16, '\0');
        if (std::error_code none; !std::filesystem::is_regular_file(path, none))
            return "";
        const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(
            std::fopen(path.c_str(), "rb"), [](std::FILE* f) { return f ? std::fclose(f) : 0; });
        bytes.resize(file ? std::fread(bytes.data(), 1, bytes.size(), file.get()) : 0);
        return bytes;
    }

    /// Whether a JSON text has this key somewhere.
    bool has_key(std::string_view text, std::string_view key)
    {
        const auto quoted = '"' + std::string(key) + '"';
        for (auto at = text.find(quoted); at != text.npos; at = text.find(quoted, at + 1)) {
            const auto next = text.find_first_not_of(blanks, at + quoted.size());
            if (next != text.npos && text[next] == ':')
                return true;
        }
        return false;
    }

    /// Whether Blender wrote a glTF or an OBJ file, of which this is the beginning.
    bool is_by_blender(std::string_view text)
    {
        return text.find("glTF Blender I/O") != text.npos || text.starts_with("# Blender");
    }

    constexpr std::string_view words_of_pbrt[] = {"Integrator", "Transform", "Sampler", "PixelFilter", "Film", "Camera",
        "LookAt", "Scale", "Rotate", "Translate", "Option", "ColorSpace", "WorldBegin", "Accelerator", "Include",
        "Attribute", "Identity", "ConcatTransform", "MakeNamedMedium", "MediumInterface", "CoordinateSystem",
        "ActiveTransform", "TransformTimes"};
    constexpr std::string_view words_of_obj[] = {"mtllib", "usemtl", "v", "vn", "vt", "o", "g", "s"};
    constexpr std::pair<std::string_view, scene_format> endings[]
        = {{".pbrt", scene_format::pbrt}, {".xml", scene_format::mitsuba}, {".gltf", scene_format::gltf},
            {".glb", scene_format::gltf}, {".obj", scene_format::obj}, {".ply", scene_format::ply}};
} // namespace

scene_format format_of(const std::string& path, std::string_view text)
{
    if (text.starts_with("glTF"))
        return scene_format::gltf;
    if (text.starts_with("ply\n") || text.starts_with("ply\r"))
        return scene_format::ply;
    const auto word = first_word(text);
    if (word.starts_with("{")) {
        if (has_key(text, "photongrid"))
            return scene_format::photongrid;
        if (has_key(text, "asset"))
            return scene_format::gltf;
    }
    if (word.starts_with("<"))
        return scene_format::mitsuba;
    if (std::find(std::begin(words_of_pbrt), std::end(words_of_pbrt), word) != std::end(words_of_pbrt))
        return scene_format::pbrt;
    if (std::find(std::begin(words_of_obj), std::end(words_of_obj), word) != std::end(words_of_obj))
        return scene_format::obj;
    const auto ending = ending_of(path);
    for (const auto& [name, format] : endings)
        if (ending == name)
            return format;
    return scene_format::photongrid;
}

scene_format format_of_file(const std::string& path) { return format_of(path, beginning_of(path)); }

namespace {
    /// `text`: the beginning of the file.
    imported_scene read_any(
        const std::string& path, scene_format format, std::string_view text, const import_settings& settings)
    {
        switch (format) {
        case scene_format::pbrt: return read_pbrt(path, settings);
        case scene_format::mitsuba: return read_mitsuba(path, settings);
        case scene_format::gltf: return read_gltf(path, settings);
        case scene_format::obj: return read_obj_scene(path, settings);
        case scene_format::ply: return read_ply_scene(path, settings);
        case scene_format::photongrid: break;
        }
        if (const auto ending = ending_of(path);
            !text.empty() && ending != ".json" && !first_word(text).starts_with("{"))
            throw scene_error(path, 0, 0,
                ending == ".mtl"
                    ? "has materials alone; open the .obj that names it"
                    : "is no scene that photongrid reads; expected .json, .gltf, .glb, .obj, .ply, .pbrt or "
                      ".xml");
        if (settings.unit)
            throw scene_error(path, 0, 0, "a unit was given, but photongrid's own scene files have \"units\"");
        if (settings.z_up)
            throw scene_error(path, 0, 0, "y is up in photongrid's own scene files");
        import_log log(settings.strict);
        auto s = read_scene(path, file_reading_of(settings, log));
        return {std::move(s), log.take()};
    }

    /// Puts a picture in the place of a scene's environments.
    void set_environment(scene& s, const std::string& path, double degrees, file_reading how)
    {
        environment_light l;
        l.name = "environment"; // without the name of its file, which is not in the folder of the scene
        try {
            l.map = scene_files("", true, how).environment(path);
        } catch (const file_error& e) {
            throw scene_error(path, 0, 0, e.what());
        }
        if (degrees != 0) {
            l.axis = dvec3(0, 1, 0);
            l.degrees = degrees;
        }
        s.environment_lights = {l};
    }
} // namespace

imported_scene import_scene(const std::string& path, const import_settings& settings)
{
    const auto text = beginning_of(path);
    const auto format = format_of(path, text);
    auto made = read_any(path, format, text, settings);
    mend_glass(made, path, format == scene_format::pbrt || format == scene_format::mitsuba);
    if (!settings.environment.empty()) {
        import_log log(settings.strict);
        auto how = file_reading_of(settings, log);
        how.before_reading = {}; // it is no file of the scene
        const bool stands_as_in_blender = !settings.environment_rotate && is_by_blender(text);
        set_environment(made.scene, settings.environment,
            settings.environment_rotate.value_or(stands_as_in_blender ? 90.0 : 0.0), std::move(how));
        if (stands_as_in_blender)
            log.say(source_place(settings.environment),
                "stands as in Blender, which wrote the scene, with its middle at x; --environment-rotate 0 turns it to "
                "z");
        for (auto& note : log.take())
            made.notes.push_back(std::move(note));
    }
    if (!settings.camera_from.empty()) {
        const auto from = import_scene(settings.camera_from, {.allow_outside = settings.allow_outside}).scene;
        made.scene.camera = from.camera;
        made.scene.render.output.width = from.render.output.width;
        made.scene.render.output.height = from.render.output.height;
    }
    // What is drawn is what was checked: no command refuses what another one takes.
    try {
        check(made.scene);
    } catch (const std::invalid_argument& e) {
        throw scene_error(path, 0, 0, e.what());
    }
    return made;
}

} // namespace photongrid

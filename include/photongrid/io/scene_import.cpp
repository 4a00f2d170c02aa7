#include <photongrid/io/json_tree.hpp>
#include <photongrid/io/pbrt_file.hpp>
#include <photongrid/io/scene_file.hpp>
#include <photongrid/io/scene_import.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>

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
} // namespace

scene_format format_of(const std::string& path, std::string_view text)
{
    const auto word = first_word(text);
    if (word.starts_with("{"))
        return scene_format::photongrid;
    static constexpr std::string_view words[] = {"Integrator", "Transform", "Sampler", "PixelFilter", "Film", "Camera",
        "LookAt", "Scale", "Rotate", "Translate", "Option", "ColorSpace", "WorldBegin", "Accelerator", "Include",
        "Attribute", "Identity", "ConcatTransform", "MakeNamedMedium", "MediumInterface", "CoordinateSystem",
        "ActiveTransform", "TransformTimes"};
    if (std::find(std::begin(words), std::end(words), word) != std::end(words))
        return scene_format::pbrt;
    std::filesystem::path name(path);
    if (name.extension() == ".gz")
        name.replace_extension();
    return name.extension() == ".pbrt" ? scene_format::pbrt : scene_format::photongrid;
}

scene_format format_of_file(const std::string& path) { return format_of(path, beginning_of(path)); }

imported_scene import_scene(const std::string& path, const import_settings& settings)
{
    switch (format_of_file(path)) {
    case scene_format::pbrt: return read_pbrt(path, settings);
    case scene_format::photongrid: break;
    }
    if (settings.unit)
        throw scene_error(path, 0, 0, "a unit was given, but photongrid's own scene files have \"units\"");
    return {read_scene(path), {}};
}

} // namespace photongrid

#include <photongrid/io/export/picture_files.hpp>
#include <photongrid/io/image_formats.hpp>
#include <photongrid/io/surface_reader.hpp>
#include <photongrid/io/tone_map.hpp>

#include <algorithm>
#include <cmath>

namespace photongrid {

namespace {
    namespace fs = std::filesystem;

    /// What the name of a copy begins with: that of the file, without characters that a scene's file might not take.
    std::string plain_stem(const std::string& file)
    {
        auto stem = fs::path(file.substr(file.find_last_of("/\\") + 1)).stem().string().substr(0, 40);
        for (char& c : stem)
            if (!(c >= 'a' && c <= 'z') && !(c >= 'A' && c <= 'Z') && !(c >= '0' && c <= '9') && c != '-')
                c = '_';
        return stem.empty() ? "picture" : stem;
    }

    /// Whether each format can name the file as it is, beside the scene.
    bool is_plain_name(const std::string& file, const scene_files& beside)
    {
        return scene_values::is_name(file) && beside.lies_inside(file)
            && file.find_first_of("\\\"") == std::string::npos;
    }

    bool is_opaque(const texture& map)
    {
        return std::all_of(map.texels.begin(), map.texels.end(), [](const auto& t) { return t.w == 65535; });
    }

    std::uint16_t linear_texel(unsigned char code)
    {
        return static_cast<std::uint16_t>(std::lround(linear_value(code) * 65535.0f)); // as scene_files reads it
    }
} // namespace

picture_files::picture_files(side_files& to, const std::string& source)
    : to_(to), beside_(to.folder(), true), source_(fs::path(source).parent_path(), true)
{
}

/// Whether a file reads as a picture. `is_same`: compares it with the one that scene_files reads.
template <class IsSame>
bool picture_files::holds(scene_files& in, const std::string& file, const IsSame& is_same)
{
    try {
        return is_same(in, file);
    } catch (const file_error&) {
        return false;
    }
}

/// The name of the file that a picture was read from, or of its copy; "" if it does not read as the picture any more.
template <class IsSame>
std::string picture_files::existing(const std::string& file, const IsSame& is_same)
{
    if (file.empty())
        return "";
    if (is_plain_name(file, beside_) && holds(beside_, file, is_same))
        return file;
    return holds(source_, file, is_same) ? to_.add(plain_stem(file), ending_of(file), source_.bytes_of(file)) : "";
}

std::string picture_files::texture(texture_use& t, texture_holds holds)
{
    const auto known = textures_.find({t.map, holds});
    if (known != textures_.end())
        return known->second;
    const auto before = t.map;
    auto name = existing(
        t.file, [&](scene_files& in, const std::string& file) { return *in.texture(file, holds) == *t.map; });
    if (name.empty())
        name = made(t, holds);
    if (t.map == before)
        textures_.emplace(std::pair(before, holds), name);
    return name;
}

std::string picture_files::bytes_of_source(const texture_use& t, texture_holds holds_what)
{
    const auto is_same
        = [&](scene_files& in, const std::string& file) { return *in.texture(file, holds_what) == *t.map; };
    return !t.file.empty() && holds(source_, t.file, is_same) ? source_.bytes_of(t.file) : "";
}

std::string picture_files::made(texture_use& t, texture_holds holds)
{
    if (!is_opaque(*t.map)) {
        auto opaque = *t.map;
        if (const auto bytes = exact_bytes(*t.map, holds); holds == texture_holds::numbers && !bytes.empty())
            return to_.add("texture", ".png", image_formats::png_bytes(t.map->width, t.map->height, bytes));
        for (auto& texel : opaque.texels) {
            if (holds == texture_holds::numbers)
                texel = glm::u16vec4(texel[static_cast<int>(t.channel)]);
            texel.w = 65535; // a colour's means nothing
        }
        t.map = std::make_shared<const photongrid::texture>(std::move(opaque));
        if (holds == texture_holds::numbers)
            t.channel = texture_channel::red;
    }
    std::vector<glm::vec3> texels;
    texels.reserve(t.map->texels.size());
    for (const auto& texel : t.map->texels)
        texels.emplace_back(numbers_of(texel));
    return add_exr("texture", t.map->width, t.map->height, texels);
}

std::string picture_files::environment(const environment_light& l)
{
    const auto name
        = existing(l.file, [&](scene_files& in, const std::string& file) { return *in.environment(file) == *l.map; });
    return name.empty() ? add_exr("sky", l.map->width, l.map->height, l.map->radiance) : name;
}

std::string picture_files::add_exr(
    const std::string& kind, std::uint32_t width, std::uint32_t height, const std::vector<glm::vec3>& texels)
{
    return to_.add(kind, ".exr", image_formats::exr_bytes({.width = width, .height = height, .pixels = texels}, {}));
}

std::vector<unsigned char> nearest_bytes(const texture& map, texture_holds holds)
{
    std::vector<unsigned char> bytes;
    bytes.reserve(4 * map.texels.size());
    const tone_map encoded(0);
    const auto of_number = [](std::uint16_t v) { return static_cast<unsigned char>((v + 128u) / 257u); };
    for (const auto& t : map.texels) {
        for (int c = 0; c < 3; ++c)
            bytes.push_back(
                holds == texture_holds::colour ? encoded(static_cast<float>(t[c]) / 65535.0f) : of_number(t[c]));
        bytes.push_back(holds == texture_holds::colour ? 255 : of_number(t.w));
    }
    return bytes;
}

std::vector<unsigned char> exact_bytes(const texture& map, texture_holds holds)
{
    auto bytes = nearest_bytes(map, holds);
    for (std::size_t i = 0; i < map.texels.size(); ++i)
        for (int c = 0; c < (holds == texture_holds::colour ? 3 : 4); ++c) {
            const auto code = bytes[4 * i + static_cast<std::size_t>(c)];
            const auto read = holds == texture_holds::colour ? linear_texel(code) : static_cast<unsigned>(code) * 257u;
            if (read != map.texels[i][c])
                return {};
        }
    return bytes;
}

} // namespace photongrid

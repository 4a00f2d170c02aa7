#include <photongrid/io/image_file.hpp>
#include <photongrid/io/import/scene_files.hpp>
#include <photongrid/io/obj_file.hpp>
#include <photongrid/io/ply_file.hpp>
#include <photongrid/io/whole_file.hpp>

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace photongrid {

namespace fs = std::filesystem;

namespace {
    constexpr std::size_t max_bytes = std::size_t{1} << 32;

    /// Whether a file lies in a folder or below it, with symbolic links followed.
    bool lies_in(const fs::path& file, const fs::path& folder)
    {
        std::error_code wrong;
        // Made absolute first: a relative path whose beginning does not exist would stay relative.
        const auto from = fs::weakly_canonical(fs::absolute(folder.empty() ? fs::path(".") : folder), wrong);
        const auto to = fs::weakly_canonical(fs::absolute(file), wrong);
        return !wrong && std::mismatch(from.begin(), from.end(), to.begin(), to.end()).first == from.end();
    }

    bool has_control_characters(const std::string& text)
    {
        return std::any_of(
            text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; });
    }

    /// The content of compressed bytes (RFC 1952).
    std::string unpacked(const std::string& path, const std::string& bytes)
    {
        z_stream stream{};
        if (inflateInit2(&stream, 15 + 16) != Z_OK) // the largest window, with gzip's header
            fail_file(path, "cannot be unpacked: out of memory");
        const std::unique_ptr<z_stream, decltype(&inflateEnd)> ended(&stream, inflateEnd);
        std::string made;
        std::array<char, std::size_t{1} << 16> block{};
        std::size_t taken = 0;
        for (int answer = Z_OK; answer != Z_STREAM_END;) {
            if (stream.avail_in == 0 && taken < bytes.size()) {
                const auto n = std::min<std::size_t>(bytes.size() - taken, std::size_t{1} << 30);
                stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + taken));
                stream.avail_in = static_cast<uInt>(n);
                taken += n;
            }
            stream.next_out = reinterpret_cast<Bytef*>(block.data());
            stream.avail_out = static_cast<uInt>(block.size());
            answer = inflate(&stream, Z_NO_FLUSH);
            if (answer != Z_OK && answer != Z_STREAM_END)
                fail_file(path, "cannot be unpacked: it is damaged, or it ends too early");
            made.append(block.data(), block.size() - stream.avail_out);
            if (made.size() > max_bytes)
                fail_file(path, "has more than 2^32 bytes when unpacked");
        }
        return made;
    }

    texture texture_of_picture(const picture_channels& picture, texture_holds holds)
    {
        texture made{picture.width, picture.height, {}};
        made.texels.reserve(picture.pixels.size());
        for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
            const glm::vec4 p
                = holds == texture_holds::numbers ? picture.pixels[i] : glm::vec4(linear_pixel(picture, i), 1.0f);
            if (std::isnan(p.x) || std::isnan(p.y) || std::isnan(p.z) || std::isnan(p.w))
                throw std::invalid_argument("a pixel is not a number");
            made.texels.emplace_back(glm::vec4(0.5f) + glm::clamp(p, 0.0f, 1.0f) * 65535.0f);
        }
        return made;
    }

    std::shared_ptr<const texture> checked_texture(
        const std::string& path, const picture_channels& picture, texture_holds holds)
    {
        try {
            texture_use use;
            use.map = std::make_shared<const texture>(texture_of_picture(picture, holds));
            check(use);
            return use.map;
        } catch (const std::invalid_argument& e) {
            fail_file(path, e.what());
        }
    }
} // namespace

std::string ending_of(const std::string& name)
{
    fs::path path(name);
    if (path.extension() == ".gz")
        path.replace_extension();
    auto e = path.extension().string();
    std::transform(e.begin(), e.end(), e.begin(),
        [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c; });
    return e;
}

fs::path scene_files::found_path(const std::string& name) const
{
    auto path = folder_ / name; // name alone if it is absolute
    if (std::error_code none; name.find('\\') != std::string::npos && !fs::exists(path, none)) {
        auto slashed = name;
        std::replace(slashed.begin(), slashed.end(), '\\', '/');
        path = folder_ / slashed;
    }
    return path;
}

bool scene_files::lies_inside(const std::string& name) const { return lies_in(found_path(name), folder_); }

std::string scene_files::path_of(const std::string& name) const
{
    if (name.empty() || name.size() > 1000 || has_control_characters(name))
        fail_file(shown_word(name), "is no file's name; expected 1 to 1,000 bytes without control characters");
    const auto path = found_path(name);
    if (!allow_outside_ && !lies_in(path, folder_))
        fail_file(path.string(), "lies outside of the scene's folder; --allow-outside lets scenes name such files");
    return path.string();
}

/// Reading from a device or a pipe might never end.
std::string scene_files::path_of_regular(const std::string& name) const
{
    auto path = path_of(name);
    if (before_reading_)
        before_reading_(path);
    std::error_code wrong;
    const auto status = fs::status(path, wrong);
    if (!fs::exists(status))
        fail_file(path, "cannot be read: " + (wrong ? wrong.message() : "there is no such file"));
    if (!fs::is_regular_file(status))
        fail_file(path, fs::is_directory(status) ? "is a folder" : "is not a regular file");
    if (const auto size = fs::file_size(path, wrong); wrong || size > max_bytes)
        fail_file(path, wrong ? wrong.message() : "has more than 2^32 bytes");
    return path;
}

std::string scene_files::bytes_of(const std::string& name) const
{
    const auto path = path_of_regular(name);
    auto bytes = whole_file(path);
    if (bytes.starts_with("\x1f\x8b"))
        return unpacked(path, bytes);
    return bytes;
}

std::shared_ptr<const mesh> scene_files::surface(const std::string& name)
{
    auto& surface = surfaces_[name];
    if (!surface) {
        const auto path = path_of_regular(name), bytes = bytes_of(name);
        auto made = ending_of(name) == ".obj" ? parse_obj(path, bytes) : parse_ply(path, bytes);
        if (made.triangles.empty())
            fail_file(path, "has no face");
        surface = std::make_shared<const mesh>(std::move(made));
    }
    return surface;
}

std::shared_ptr<const texture> scene_files::texture(const std::string& name, texture_holds holds)
{
    auto& map = textures_[{name, holds}];
    if (!map) {
        const auto path = path_of_regular(name);
        map = checked_texture(path, read_channels(path), holds);
    }
    return map;
}

std::shared_ptr<const texture> scene_files::texture_of(
    const std::string& name, std::string_view bytes, texture_holds holds)
{
    auto& map = textures_[{name, holds}];
    if (!map)
        map = checked_texture(name, decode_channels(name, bytes), holds);
    return map;
}

std::shared_ptr<const environment_map> scene_files::environment(const std::string& name)
{
    auto& map = environments_[name];
    if (!map) {
        const auto path = path_of_regular(name);
        auto picture = read_linear_image(path);
        environment_map made{picture.width, picture.height, std::move(picture.pixels)};
        try {
            check(made);
        } catch (const std::invalid_argument& e) {
            fail_file(path, std::string(e.what()).substr(5)); // without "map: "
        }
        map = std::make_shared<const environment_map>(std::move(made));
    }
    return map;
}

} // namespace photongrid

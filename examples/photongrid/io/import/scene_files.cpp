#include <photongrid/io/import/mended_mesh.hpp>
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

    /// Counts values that a picture should not have.
    struct odd_values {
        std::uint64_t count = 0;
        std::uint32_t x = 0, y = 0; ///< of the first
        void add(std::size_t x_, std::uint32_t y_)
        {
            if (count++ == 0) {
                x = static_cast<std::uint32_t>(x_);
                y = y_;
            }
        }
        /// "3 values are `which`, the first at pixel (12, 5): `what`"
        std::string text(const char* which, const char* what) const
        {
            return std::to_string(count) + (count == 1 ? " value is " : " values are ") + which
                + (count == 1 ? "" : ", the first") + " at pixel (" + std::to_string(x) + ", " + std::to_string(y)
                + "): " + what;
        }
    };

    /// Makes a texture of a picture.
    class texture_sink : public picture_sink {
    public:
        explicit texture_sink(texture_holds holds) : holds_(holds) {}
        void begin(const picture_header& header) override
        {
            is_srgb_ = header.is_srgb;
            made.width = header.width;
            made.height = header.height;
            made.texels.resize(std::size_t{header.width} * header.height);
        }
        void row(std::uint32_t y, std::span<const glm::vec4> pixels) override
        {
            auto* to = made.texels.data() + std::size_t{y} * made.width;
            for (std::size_t x = 0; x < pixels.size(); ++x) {
                auto p = pixels[x];
                for (int c = 0; c < 4; ++c)
                    if (std::isnan(p[c])) {
                        odd.add(x, y);
                        p[c] = 0;
                    }
                if (holds_ == texture_holds::colour)
                    p = glm::vec4(linear_pixel(p, is_srgb_), 1.0f);
                to[x] = glm::u16vec4(glm::vec4(0.5f) + glm::clamp(p, 0.0f, 1.0f) * 65535.0f);
            }
        }
        texture made;
        odd_values odd;

    private:
        texture_holds holds_;
        bool is_srgb_ = false;
    };

    /// Replaces what no light has.
    odd_values mend_radiance(environment_map& map)
    {
        odd_values odd;
        float largest = 0;
        for (const auto& l : map.radiance)
            for (int c = 0; c < 3; ++c)
                if (std::isfinite(l[c]))
                    largest = std::max(largest, l[c]);
        for (std::size_t i = 0; i < map.radiance.size(); ++i)
            for (int c = 0; c < 3; ++c)
                if (auto& v = map.radiance[i][c]; !(v >= 0 && std::isfinite(v))) {
                    odd.add(i % map.width, static_cast<std::uint32_t>(i / map.width));
                    v = v > 0 ? largest : 0;
                }
        return odd;
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
    if (how_.before_reading)
        how_.before_reading(path);
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
        const auto path = path_of(name), bytes = bytes_of(name);
        std::vector<std::string> left_out;
        ply_rest rest;
        auto made = ending_of(name) == ".obj" ? parse_obj(path, bytes, &left_out) : parse_ply(path, bytes, &rest);
        for (const auto& r : rest.left_out)
            if (r.line == 0) // of its faces
                left_out.push_back(r.what);
        if (auto said = mend(made); !said.empty())
            left_out.push_back(std::move(said));
        for (const auto& what : left_out)
            note(path, what);
        if (made.triangles.empty())
            fail_file(path, "has no face");
        surface = std::make_shared<const mesh>(std::move(made));
    }
    return surface;
}

void scene_files::note(const std::string& path, const std::string& what) const
{
    if (how_.note)
        how_.note(path, what);
}

std::shared_ptr<const texture> scene_files::decoded_texture(
    const std::string& path, std::string_view bytes, texture_holds holds)
{
    texture_sink sink(holds);
    decode_picture(path, bytes, sink, pixels_);
    if (sink.odd.count > 0)
        note(path, sink.odd.text("not a number", "taken as 0"));
    texture_use use;
    use.map = std::make_shared<const photongrid::texture>(std::move(sink.made));
    try {
        check(use);
    } catch (const std::invalid_argument& e) {
        fail_file(path, e.what());
    }
    return use.map;
}

std::shared_ptr<const texture> scene_files::texture(const std::string& name, texture_holds holds)
{
    auto& map = textures_[{name, holds}];
    if (!map)
        map = decoded_texture(path_of(name), bytes_of(name), holds);
    return map;
}

std::shared_ptr<const texture> scene_files::texture_of(
    const std::string& name, std::string_view bytes, texture_holds holds)
{
    auto& map = textures_[{name, holds}];
    if (!map)
        map = decoded_texture(name, bytes, holds);
    return map;
}

std::shared_ptr<const environment_map> scene_files::environment(const std::string& name)
{
    auto& map = environments_[name];
    if (!map) {
        const auto path = path_of(name);
        auto picture = decode_linear_image(path, bytes_of(name), pixels_);
        environment_map made{picture.width, picture.height, std::move(picture.pixels)};
        if (const auto odd = mend_radiance(made); odd.count > 0)
            note(path, odd.text("no radiance", "below 0 or no number is taken as 0, infinite as the largest other"));
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

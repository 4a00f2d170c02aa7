#include <photongrid/io/mitsuba/serialized.hpp>
#include <photongrid/io/scene_error.hpp>

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

namespace photongrid::mitsuba {

namespace {
    constexpr std::size_t max_unpacked = std::size_t{1} << 32;

    // Bits of the number at the beginning of a surface.
    constexpr std::uint32_t with_normals = 1, with_coordinates = 2, with_colors = 8, with_face_normals = 16,
                            in_double_precision = 0x2000;

    template <class Number>
    Number little_endian(const char* bytes)
    {
        static_assert(std::endian::native == std::endian::little);
        Number n;
        std::memcpy(&n, bytes, sizeof n);
        return n;
    }

    [[noreturn]] void fail_serialized(const std::string& file, const std::string& what)
    {
        throw scene_error(file, 0, 0, what);
    }

    /// Where the bytes of a surface begin, by the table at the end of the file.
    std::size_t start_of(const std::string& file, std::string_view bytes, std::size_t index, unsigned version)
    {
        if (index == 0)
            return 0;
        const std::size_t wide = version == 3 ? 4 : 8;
        const auto count = bytes.size() < 4 ? 0 : little_endian<std::uint32_t>(bytes.data() + bytes.size() - 4);
        if (index >= count || (bytes.size() - 4) / wide < count)
            fail_serialized(file,
                "has no surface " + std::to_string(index) + "; its table at the end has " + std::to_string(count)
                    + ", counted from 0");
        const auto* entry = bytes.data() + bytes.size() - 4 - wide * (count - index);
        return version == 3 ? little_endian<std::uint32_t>(entry)
                            : static_cast<std::size_t>(little_endian<std::uint64_t>(entry));
    }

    /// Unpacks a stream of zlib (RFC 1950) piece by piece, so that no more memory is taken than it has bytes.
    class unpacker {
    public:
        unpacker(const std::string& file, std::string_view packed) : file_(file), packed_(packed)
        {
            if (inflateInit(&stream_) != Z_OK)
                fail_serialized(file_, "cannot be unpacked: out of memory");
        }
        ~unpacker() { inflateEnd(&stream_); }
        unpacker(const unpacker&) = delete;
        unpacker& operator=(const unpacker&) = delete;

        /// The next `count` numbers.
        template <class Number>
        std::vector<Number> numbers(std::uint64_t count)
        {
            if (count > (max_unpacked - taken_) / sizeof(Number))
                fail_serialized(file_, "has a surface of more than 2^32 bytes");
            taken_ += count * sizeof(Number);
            std::vector<Number> made;
            std::array<Number, 4096> block{};
            while (made.size() < count) {
                const auto n = std::min<std::size_t>(block.size(), static_cast<std::size_t>(count) - made.size());
                unpack(block.data(), n * sizeof(Number));
                made.insert(made.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(n));
            }
            return made;
        }
        template <class Number>
        Number number()
        {
            return numbers<Number>(1)[0];
        }

    private:
        void unpack(void* to, std::size_t bytes)
        {
            stream_.next_out = static_cast<Bytef*>(to);
            stream_.avail_out = static_cast<uInt>(bytes);
            while (stream_.avail_out > 0) {
                if (stream_.avail_in == 0 && !packed_.empty()) {
                    const auto n = std::min<std::size_t>(packed_.size(), std::size_t{1} << 30);
                    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed_.data()));
                    stream_.avail_in = static_cast<uInt>(n);
                    packed_.remove_prefix(n);
                }
                const auto answer = inflate(&stream_, Z_NO_FLUSH);
                if (answer != Z_OK && !(answer == Z_STREAM_END && stream_.avail_out == 0))
                    fail_serialized(file_, "cannot be unpacked: it is damaged, or it ends too early");
            }
        }

        const std::string& file_;
        std::string_view packed_;
        z_stream stream_{};
        std::uint64_t taken_ = 0;
    };

    /// As many vectors, of the precision of the file.
    template <class Vector>
    std::vector<Vector> vectors(unpacker& u, std::uint64_t count, bool is_double)
    {
        constexpr auto n = static_cast<std::size_t>(Vector::length());
        std::vector<Vector> all;
        const auto fill = [&](const auto& numbers) {
            all.resize(numbers.size() / n);
            for (std::size_t i = 0; i < numbers.size(); ++i)
                all[i / n][static_cast<int>(i % n)] = static_cast<typename Vector::value_type>(numbers[i]);
        };
        if (is_double) {
            auto numbers = u.numbers<double>(count * n);
            for (auto& d : numbers) // a larger one has no float, and is refused like infinity
                if (std::abs(d) > static_cast<double>(std::numeric_limits<float>::max()))
                    d = std::numeric_limits<double>::infinity();
            fill(numbers);
        } else {
            fill(u.numbers<float>(count * n));
        }
        return all;
    }
} // namespace

serialized_mesh parse_serialized(const std::string& file, std::string_view bytes, std::size_t index)
{
    const auto header_at = [&](std::size_t at) -> unsigned {
        if (at > bytes.size() || bytes.size() - at < 4 || little_endian<std::uint16_t>(bytes.data() + at) != 0x041C)
            fail_serialized(
                file, "is no serialized file of Mitsuba: it lacks the number 0x041C where a surface begins");
        const unsigned version = little_endian<std::uint16_t>(bytes.data() + at + 2);
        if (version != 3 && version != 4)
            fail_serialized(file, "is of version " + std::to_string(version) + "; versions 3 and 4 are read");
        return version;
    };
    const auto start = start_of(file, bytes, index, header_at(0));
    const auto version = header_at(start);
    unpacker u(file, bytes.substr(start + 4));
    const auto flags = u.number<std::uint32_t>();
    if (version == 4)
        for (std::size_t length = 0; u.number<char>() != '\0';) // its name
            if (++length > 10'000)
                fail_serialized(file, "has a surface whose name has more than 10,000 bytes");
    const auto vertices = u.number<std::uint64_t>(), triangles = u.number<std::uint64_t>();
    if (vertices > std::numeric_limits<std::uint32_t>::max() || triangles > std::numeric_limits<std::uint32_t>::max())
        fail_serialized(file, "has a surface of 2^32 vertices or triangles, or more");
    const bool is_double = (flags & in_double_precision) != 0;
    serialized_mesh made{.surface = {}, .has_face_normals = (flags & with_face_normals) != 0};
    auto& m = made.surface;
    if (is_double)
        set_positions(m, vectors<glm::dvec3>(u, vertices, true));
    else
        m.positions = vectors<glm::vec3>(u, vertices, false);
    if (flags & with_normals)
        m.normals = vectors<glm::vec3>(u, vertices, is_double);
    if (flags & with_coordinates)
        m.texture_coordinates = vectors<glm::vec2>(u, vertices, is_double);
    if (flags & with_colors)
        m.colors = vectors<glm::vec3>(u, vertices, is_double);
    for (auto& c : m.colors)
        for (int channel = 0; channel < 3; ++channel)
            c[channel] = std::clamp(c[channel], 0.0f, 1.0f);
    const auto corners = u.numbers<std::uint32_t>(triangles * 3);
    for (std::size_t i = 0; i < corners.size(); i += 3)
        m.triangles.emplace_back(corners[i], corners[i + 1], corners[i + 2]);
    try {
        check(m);
    } catch (const std::invalid_argument& e) {
        fail_serialized(file, e.what());
    }
    return made;
}

} // namespace photongrid::mitsuba

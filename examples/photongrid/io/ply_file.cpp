#include <photongrid/io/ply/header.hpp>
#include <photongrid/io/tone_map.hpp>
#include <photongrid/io/whole_file.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <vector>

namespace photongrid {

namespace ply {
    namespace {
        class reader : public header_reader {
        public:
            using header_reader::header_reader;

            mesh read()
            {
                read_header();
                for (const auto& e : elements_)
                    read_element(e);
                for (std::size_t t = 0; t < made_.triangles.size(); ++t) // faces may come before vertices
                    for (int c = 0; c < 3; ++c)
                        if (made_.triangles[t][c] >= made_.positions.size())
                            throw scene_error(file_, 0, 0,
                                "triangle " + std::to_string(t) + ": its corner " + std::to_string(c) + " is vertex "
                                    + std::to_string(made_.triangles[t][c]) + "; there are "
                                    + std::to_string(made_.positions.size()));
                return std::move(made_);
            }

        private:
            // --- the elements ---
            void read_element(const element& e)
            {
                std::uint64_t least = 0; // bytes of one
                for (const auto& p : e.properties) {
                    const bool is_ascii = format_ == format::ascii;
                    least += is_ascii ? 2 : size_of(p.count.value_or(p.type));
                    if (p.use == role::corners)
                        least += 3 * (is_ascii ? 2 : size_of(p.type));
                }
                // The last number of a text needs no blank behind it.
                if (e.count > 0 && least > 0 && e.count - 1 > (bytes_.size() - at_) / least)
                    fail("the header declares " + std::to_string(e.count) + " elements " + shown_word(e.name)
                        + ", which need more bytes than the file has");
                if (least == 0)
                    return;
                const bool is_vertex = e.name == "vertex", has_normals = is_smooth(), has_coordinates = is_mapped(),
                           has_colors = is_colored();
                // Single precision holds what nearly all files have; the others' positions are kept in double until all
                // are known.
                const bool is_single = std::all_of(e.properties.begin(), e.properties.end(), [&](const property& p) {
                    return p.use > role::z || (p.type == scalar::f32 && format_ != format::ascii);
                });
                std::vector<glm::dvec3> places;
                if (is_vertex && is_single)
                    made_.positions.reserve(made_.positions.size() + e.count);
                for (const auto& p : e.properties)
                    if (p.use == role::corners) // most files have triangles alone
                        made_.triangles.reserve(made_.triangles.size() + e.count);
                std::array<float, static_cast<std::size_t>(role::corners)> v{};
                glm::dvec3 place(0);
                for (std::uint64_t i = 0; i < e.count; ++i) {
                    for (const auto& p : e.properties) {
                        if (p.use == role::corners && read_corners_of_32_bits(p))
                            continue;
                        if (p.count)
                            read_list(p);
                        else if (p.use == role::none)
                            (void)next(p.type);
                        else if (p.use > role::z || is_single)
                            v[static_cast<std::size_t>(p.use)] = number_for(p);
                        else
                            place[static_cast<int>(p.use)] = coordinate(p.type);
                    }
                    if (is_vertex && is_single)
                        made_.positions.emplace_back(v[0], v[1], v[2]);
                    else if (is_vertex)
                        places.push_back(place);
                    if (is_vertex && has_normals)
                        made_.normals.emplace_back(v[3], v[4], v[5]);
                    if (is_vertex && has_coordinates)
                        made_.texture_coordinates.emplace_back(v[6], v[7]);
                    if (is_vertex && has_colors)
                        made_.colors.emplace_back(v[8], v[9], v[10]);
                }
                if (is_vertex && !is_single)
                    set_positions(made_, places);
            }
            float number_for(const property& p)
            {
                switch (p.use) {
                case role::u:
                case role::v: return limited(p.type, -1e6, 1e6, "a texture coordinate that is not from -10^6 to 10^6");
                case role::red:
                case role::green:
                case role::blue:
                    if (p.type == scalar::u8) {
                        const auto code = limited(p.type, 0, 255, "a colour that is not from 0 to 255");
                        return linear_value(static_cast<unsigned char>(code));
                    }
                    return limited(p.type, 0, 1, "a colour that is neither a byte nor a number from 0 to 1");
                default: return static_cast<float>(coordinate(p.type));
                }
            }
            float limited(scalar type, double least, double most, const char* otherwise)
            {
                const double d = next(type);
                if (!(d >= least && d <= most))
                    fail(otherwise);
                return static_cast<float>(d);
            }
            double coordinate(scalar type)
            {
                const double d = type == scalar::f32 && format_ == format::little_endian && bytes_.size() - at_ >= 4
                    ? binary_as<float>() // as nearly all files have them
                    : next(type);
                if (!(std::abs(d) <= 1e18))
                    fail("a coordinate that is not finite or above 10^18");
                return d;
            }
            void read_list(const property& p)
            {
                const double length = next(*p.count);
                if (!(length >= 0 && length <= 4294967295.0 && length == std::floor(length)))
                    fail("the length of a list is not a whole number from 0 to 2^32 - 1");
                if (length * (format_ == format::ascii ? 2 : static_cast<double>(size_of(p.type)))
                    > static_cast<double>(bytes_.size() - at_) + 1)
                    fail("a list of " + std::to_string(static_cast<std::uint64_t>(length))
                        + " needs more bytes than the file has");
                if (p.use == role::corners && length < 3)
                    fail("a face with " + std::to_string(static_cast<int>(length)) + " corners; expected at least 3");
                std::uint32_t first = 0, before = 0;
                for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(length); ++i) {
                    const double d = next(p.type);
                    if (p.use != role::corners)
                        continue;
                    if (!(d >= 0 && d <= 4294967295.0 && d == std::floor(d)))
                        fail("an index that is not a whole number from 0 to 2^32 - 1");
                    const auto index = static_cast<std::uint32_t>(d);
                    if (i == 0)
                        first = index;
                    else if (i >= 2)
                        made_.triangles.push_back({first, before, index});
                    before = index;
                }
            }

            /// Reads a face as nearly all files have them, without doubles, and with one look for the end of the file.
            /// Does nothing and returns false for others, which read_list reads or refuses.
            bool read_corners_of_32_bits(const property& p)
            {
                if (format_ == format::ascii || *p.count != scalar::u8
                    || (p.type != scalar::i32 && p.type != scalar::u32) || at_ >= bytes_.size())
                    return false;
                const std::size_t length = static_cast<unsigned char>(bytes_[at_]);
                if (length < 3 || bytes_.size() - at_ < 1 + 4 * length)
                    return false;
                const bool is_reversed = (format_ == format::big_endian) != (std::endian::native == std::endian::big);
                const auto index = [&](std::size_t i) {
                    std::uint32_t n;
                    std::memcpy(&n, bytes_.data() + at_ + 1 + 4 * i, sizeof n);
                    return is_reversed ? n >> 24 | (n >> 8 & 0xFF00u) | (n << 8 & 0xFF0000u) | n << 24 : n;
                };
                if (p.type == scalar::i32)
                    for (std::size_t i = 0; i < length; ++i)
                        if (index(i) > 0x7FFFFFFFu)
                            return false;
                for (std::size_t i = 2; i < length; ++i)
                    made_.triangles.push_back({index(0), index(i - 1), index(i)});
                at_ += 1 + 4 * length;
                return true;
            }

            double next(scalar type) { return format_ == format::ascii ? next_in_text() : next_in_binary(type); }
            double next_in_text()
            {
                while (at_ < bytes_.size() && is_blank(bytes_[at_]))
                    ++at_;
                const char* begin = bytes_.data() + at_;
                const char* end = bytes_.data() + bytes_.size();
                if (begin == end)
                    fail("the file ends; expected a number");
                double d = 0;
                const auto [past, wrong] = std::from_chars(*begin == '+' ? begin + 1 : begin, end, d);
                if (wrong == std::errc::result_out_of_range) // from_chars leaves d as it was
                    d = std::strtod(std::string(begin, past).c_str(), nullptr);
                else if (wrong != std::errc() || (past != end && !is_blank(*past)))
                    fail("found "
                        + shown_word(std::string_view(
                            begin, static_cast<std::size_t>(std::find_if(begin, end, is_blank) - begin)))
                        + "; expected a number");
                at_ = static_cast<std::size_t>(past - bytes_.data());
                return d;
            }
            static bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

            template <class T>
            double binary_as()
            {
                std::array<char, sizeof(T)> b;
                std::memcpy(b.data(), bytes_.data() + at_, sizeof(T));
                if ((format_ == format::big_endian) != (std::endian::native == std::endian::big))
                    std::reverse(b.begin(), b.end());
                at_ += sizeof(T);
                return static_cast<double>(std::bit_cast<T>(b));
            }
            double next_in_binary(scalar type)
            {
                if (bytes_.size() - at_ < size_of(type))
                    fail("the file ends; expected a number");
                switch (type) {
                case scalar::i8: return binary_as<std::int8_t>();
                case scalar::u8: return binary_as<std::uint8_t>();
                case scalar::i16: return binary_as<std::int16_t>();
                case scalar::u16: return binary_as<std::uint16_t>();
                case scalar::i32: return binary_as<std::int32_t>();
                case scalar::u32: return binary_as<std::uint32_t>();
                case scalar::f32: return binary_as<float>();
                case scalar::f64: return binary_as<double>();
                }
                return 0;
            }

            mesh made_;
        };
    } // namespace
} // namespace ply

mesh parse_ply(const std::string& file, std::string_view bytes, ply_rest* rest)
{
    return ply::reader(file, bytes, rest).read();
}

mesh read_ply(const std::string& path) { return parse_ply(path, whole_file(path)); }

} // namespace photongrid

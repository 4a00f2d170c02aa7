#include <photongrid/io/import/polygon_cutter.hpp>
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
#include <limits>
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
                cut_polygons();
                if (rest_ != nullptr && flat_ > 0)
                    rest_->left_out.push_back({0, text_of_flat_faces(flat_)});
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
            /// What is out of range is left to mend().
            float number_for(const property& p)
            {
                const bool is_code = p.use >= role::red && p.use <= role::blue && p.type == scalar::u8;
                if (!is_code)
                    return static_cast<float>(coordinate(p.type));
                const double code = next(p.type);
                return code >= 0 && code <= 255 ? linear_value(static_cast<unsigned char>(code))
                                                : std::numeric_limits<float>::quiet_NaN();
            }
            double coordinate(scalar type)
            {
                const double d = type == scalar::f32 && format_ == format::little_endian && bytes_.size() - at_ >= 4
                    ? binary_as<float>() // as nearly all files have them
                    : next(type);
                return std::abs(d) <= 1e18 ? d : std::numeric_limits<double>::quiet_NaN();
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
                const auto corners = static_cast<std::uint64_t>(length);
                if (p.use == role::strips) {
                    read_strips(p, corners);
                    return;
                }
                if (p.use == role::corners)
                    begin_face(corners);
                std::uint32_t first = 0, before = 0;
                for (std::uint64_t i = 0; i < corners; ++i) {
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

            /// Counts a face that is no triangle.
            void begin_face(std::uint64_t corners)
            {
                flat_ += corners < 3 ? 1 : 0;
                if (corners > 3)
                    polygons_.push_back({made_.triangles.size(), static_cast<std::size_t>(corners)});
            }
            /// Strips of triangles, each of whose corners makes one with the two before. -1 ends a strip.
            void read_strips(const property& p, std::uint64_t corners)
            {
                std::array<std::uint32_t, 2> before{};
                std::size_t in_strip = 0;
                for (std::uint64_t i = 0; i < corners; ++i) {
                    const double d = next(p.type);
                    if (d == -1 || (p.type == scalar::u32 && d == 4294967295.0)) {
                        in_strip = 0;
                        continue;
                    }
                    if (!(d >= 0 && d <= 4294967294.0 && d == std::floor(d)))
                        fail("an index that is neither -1 nor a whole number from 0 to 2^32 - 2");
                    const auto index = static_cast<std::uint32_t>(d);
                    // Every other triangle would show its back. Strips are joined by triangles without area.
                    if (in_strip >= 2 && before[0] != before[1] && before[1] != index && before[0] != index)
                        made_.triangles.push_back(in_strip % 2 == 0 ? glm::uvec3(before[0], before[1], index)
                                                                    : glm::uvec3(before[1], before[0], index));
                    before = {before[1], index};
                    ++in_strip;
                }
            }
            /// Cuts those that are no fans around their first corner.
            void cut_polygons()
            {
                polygon_cutter cutter;
                std::vector<std::uint32_t> corners;
                std::vector<glm::dvec3> outline;
                for (const auto& face : polygons_) {
                    auto* triangles = &made_.triangles[face.first];
                    corners = {triangles[0].x, triangles[0].y};
                    for (std::size_t i = 0; i + 2 < face.corners; ++i)
                        corners.push_back(triangles[i].z);
                    outline.clear();
                    for (const auto c : corners)
                        outline.emplace_back(made_.positions[c]);
                    for (const auto& t : cutter.triangles_of(outline, normal_of_polygon(outline)))
                        *triangles++ = {corners[t.x], corners[t.y], corners[t.z]};
                }
                if (rest_ != nullptr && cutter.not_cut() > 0)
                    rest_->left_out.push_back({0, text_of_crossed_faces(cutter.not_cut())});
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
                begin_face(length);
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

            struct polygon {
                std::size_t first;   ///< of its triangles, a fan
                std::size_t corners; ///< more than three
            };
            mesh made_;
            std::vector<polygon> polygons_;
            std::size_t flat_ = 0; ///< faces of fewer than three corners
        };
    } // namespace
} // namespace ply

mesh parse_ply(const std::string& file, std::string_view bytes, ply_rest* rest)
{
    return ply::reader(file, bytes, rest).read();
}

mesh read_ply(const std::string& path) { return parse_ply(path, whole_file(path)); }

} // namespace photongrid
